#pragma once

#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <utility>

#include "cguide/exact/core/error.h"
#include "cguide/exact/core/rational.h"

// The lines of files in fixtures/gold, whose README.md specifies them.
namespace cguide::testing {

/** One line inside a case: a key and what follows it. */
class Line {
 public:
  Line(std::string where, std::string text) : where_(std::move(where)), in_(std::move(text)) {
    in_ >> key_;
  }
  const std::string& key() const { return key_; }

  std::string Word() {
    std::string word;
    if (!(in_ >> word)) Refuse("a word is missing");
    return word;
  }
  std::string Rest() {
    std::string rest;
    std::getline(in_, rest);
    return rest;
  }
  VectorXq Numbers(int count) {
    VectorXq v(count);
    for (Rational& x : v) x = Number();
    return v;
  }
  Rational Number() { return NumberIn(Word()); }
  Rational NumberIn(const std::string& word) const {
    try {
      return ParseRational(word);
    } catch (const Error& e) {
      Refuse(e.what());
    }
  }
  int Integer() {
    const Rational x = Number();
    if (x.get_den() != 1 || abs(x) > 1000000) Refuse("a small integer is needed");
    return static_cast<int>(x.get_num().get_si());
  }
  void End() {
    std::string word;
    if (in_ >> word) Refuse("\"" + word + "\" is too much");
  }
  [[noreturn]] void Refuse(const std::string& why) const {
    throw Error(Error::Code::kBadInput, where_ + ": " + why);
  }

 private:
  std::string where_, key_;
  std::istringstream in_;
};

/** Walks a file: `begin(name)` at "<kind> <name>", `line(line)` inside, `end()` at "end". */
inline void Walk(const std::string& file, const std::string& kind,
                 const std::function<void(const std::string&)>& begin,
                 const std::function<void(Line&)>& line, const std::function<void(Line&)>& end) {
  std::ifstream in(file);
  if (!in) throw Error(Error::Code::kBadInput, file + ": cannot be read");
  bool open = false;
  int number = 0;
  for (std::string text; std::getline(in, text);) {
    Line current(file + ":" + std::to_string(++number), text);
    if (current.key().empty() || current.key()[0] == '#') continue;
    if (!open) {
      if (current.key() != kind) current.Refuse("\"" + kind + "\" is expected");
      begin(current.Word());
      open = true;
    } else if (current.key() == "end") {
      end(current);
      open = false;
    } else if (current.key() == "origin") {
      current.Rest();
    } else {
      line(current);
    }
    current.End();
  }
  if (open) throw Error(Error::Code::kBadInput, file + ": the last case has no end");
}

template <typename Value>
Value Choose(Line& line, const std::map<std::string, Value>& values) {
  const std::string word = line.Word();
  const auto found = values.find(word);
  if (found == values.end()) line.Refuse("\"" + word + "\" is not among the expected words");
  return found->second;
}

}  // namespace cguide::testing
