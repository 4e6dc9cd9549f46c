#include "cguide/verify/cli/robust_option.h"

#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>

#include "cguide/exact/core/error.h"

namespace cguide::cli {
namespace {

constexpr const char* kForm = "; a box is mu=M,pose_mm=P,com_mm=C";

/** Reads one `key=value`; says what is wrong with it. */
std::string ReadWidth(const std::string& word, std::set<std::string>* seen,
                      check::Robustness* box) {
  const std::size_t equals = word.find('=');
  const std::string key = word.substr(0, equals);
  if (equals == std::string::npos) return "\"" + word + "\" has no value" + kForm;
  const char* begin = word.c_str() + equals + 1;
  char* end = nullptr;
  const double value = std::strtod(begin, &end);
  if (end == begin || *end != '\0' || !std::isfinite(value) || value < 0 || value > 1e6) {
    return "\"" + word + "\": a width is a number from 0 to 1e6";
  }
  if (!seen->insert(key).second) return "\"" + key + "\" is there twice";
  if (key == "mu") {
    box->friction = value;
  } else if (key == "pose_mm") {
    box->pose = value / 1000;
  } else if (key == "com_mm") {
    box->com = value / 1000;
  } else {
    return "\"" + key + "\" is not known" + kForm;
  }
  return {};
}

std::string Read(const std::string& text, check::Robustness* box) {
  std::set<std::string> seen;
  std::stringstream words(text);
  std::string word;
  while (std::getline(words, word, ',')) {
    const std::string problem = ReadWidth(word, &seen, box);
    if (!problem.empty()) return problem;
  }
  return {};
}

}  // namespace

std::string RobustnessProblem(const std::string& text) {
  check::Robustness box;
  return text.empty() ? std::string("the box is empty") + kForm : Read(text, &box);
}

check::Robustness ParseRobustness(const std::string& text) {
  check::Robustness box;
  const std::string problem = Read(text, &box);
  if (!problem.empty()) throw Error(Error::Code::kBadInput, "--robust: " + problem);
  return box;
}

}  // namespace cguide::cli
