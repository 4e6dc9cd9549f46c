#include "cguide/verify/cli/com_positions.h"

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/membership.h"
#include "cguide/numeric/stability_memory.h"
#include "cguide/verify/cli/console.h"

namespace cguide::cli {
namespace {

using Json = nlohmann::ordered_json;
using numeric::StabilityStage;

constexpr std::size_t kMaxBytes = 256u << 20;

/** Reads one line; says what is wrong with it. */
std::string ReadCom(std::string_view line, Eigen::Vector3d* com) {
  constexpr const char* kNames[] = {"x", "y", "z"};
  const auto fields = numeric::io::CutAtCommas(line);
  if (fields.size() != 3) {
    return std::to_string(fields.size()) + (fields.size() == 1 ? " value" : " values") +
           " where a centre of mass has three; write x,y,z in metres, one a line";
  }
  for (int i = 0; i < 3; ++i) {
    const std::string_view field = fields[static_cast<std::size_t>(i)];
    std::string why;
    const double value = numeric::io::ParseDouble(field, &why);
    if (why.empty() && !(std::abs(value) <= 1e6)) why = "exceeds 1e6";
    if (!why.empty()) {
      return std::string(kNames[i]) + ": " + numeric::io::Quote(field) + " " + why +
             "; write x,y,z in metres, one a line";
    }
    (*com)[i] = value;
  }
  return {};
}

bool IsHeader(std::string_view line) {
  const auto fields = numeric::io::CutAtCommas(line);
  return fields.size() == 3 && fields[0] == "x" && fields[1] == "y" && fields[2] == "z";
}

const char* VerdictWord(Verdict verdict) {
  return verdict == Verdict::kHolds   ? "stable"
         : verdict == Verdict::kFails ? "unstable"
                                      : "undecided";
}

const char* StageWord(StabilityStage stage) {
  return stage == StabilityStage::kFast    ? "fast"
         : stage == StabilityStage::kExact ? "exact"
                                           : "none";
}

void Count(const ComAnswer& answer, ComReport* report) {
  ++(answer.verdict == Verdict::kHolds   ? report->stable
     : answer.verdict == Verdict::kFails ? report->unstable
                                         : report->undecided);
}

}  // namespace

std::vector<Eigen::Vector3d> ReadComs(const std::filesystem::path& file) {
  const std::string bytes = numeric::io::ReadTextFile(file, kMaxBytes);
  std::string_view text = bytes;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<Eigen::Vector3d> coms;
  for (long number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    if (number == 1 && IsHeader(line)) continue;
    const std::string wrong = ReadCom(line, &coms.emplace_back());
    if (wrong.empty()) continue;
    throw Error(Error::Code::kBadInput,
                file.string() + ":" + std::to_string(number) + ": " + wrong);
  }
  if (coms.empty()) {
    throw Error(
        Error::Code::kBadInput,
        file.string() + ":1: there is no centre of mass; write x,y,z in metres, one a line");
  }
  return coms;
}

ComReport AskComs(const numeric::Problem& problem, const Configuration& q,
                  const std::vector<Eigen::Vector3d>& coms) {
  const numeric::World world(problem.model);
  numeric::GuideWorkspace workspace(world);
  Place(world, q, &workspace.geometry);
  FindContacts(world, &workspace.geometry, &workspace.contacts);
  numeric::StabilityQuery query = PlacedQuery(world, workspace);
  query.com_error = 0;
  ComReport report;
  report.contacts = static_cast<int>(query.contacts.size());
  for (const Eigen::Vector3d& com : coms) {
    if (InterruptFlag()) {
      report.interrupted = true;
      break;
    }
    query.com_W = com;
    ComAnswer& answer = report.answers.emplace_back();
    answer.com_W = com;
    answer.verdict = TryStability(query, &workspace.memory, &workspace.stability).verdict;
    answer.stage = StabilityStage::kFast;
    if (answer.verdict == Verdict::kUndecided) {
      numeric::SettledStability settled = Stability(query, &workspace.stability);
      answer.verdict = settled.answer.verdict;
      answer.stage = settled.stage;
      answer.reason = std::move(settled.reason);
    }
    Count(answer, &report);
  }
  return report;
}

void PrintText(const std::string& what, const ComReport& report) {
  std::cout << what << ", " << report.contacts << " contact points: " << report.answers.size()
            << " centres of mass, " << report.stable << " statically stable, " << report.unstable
            << " not, " << report.undecided << " undecided\n";
  for (const ComAnswer& answer : report.answers) {
    const Eigen::Vector3d& c = answer.com_W;
    std::cout << "  [" << Short(c.x()) << ' ' << Short(c.y()) << ' ' << Short(c.z()) << "] "
              << VerdictWord(answer.verdict);
    if (answer.verdict == Verdict::kUndecided) std::cout << ": " << answer.reason;
    std::cout << '\n';
  }
}

void PrintJson(const std::string& what, const ComReport& report) {
  Json json;
  json["schema"] = "cguide-stability-coms/1";
  json["configuration"] = what;
  json["contact_points"] = report.contacts;
  json["stable"] = report.stable;
  json["unstable"] = report.unstable;
  json["undecided"] = report.undecided;
  json["answers"] = Json::array();
  for (const ComAnswer& answer : report.answers) {
    const Eigen::Vector3d& c = answer.com_W;
    json["answers"].push_back(
        {{"com_m", {c.x(), c.y(), c.z()}},
         {"verdict", VerdictWord(answer.verdict)},
         {"stage", StageWord(answer.stage)},
         {"reason", answer.reason.empty() ? Json(nullptr) : Json(answer.reason)}});
  }
  // A file name may be any bytes.
  std::cout << json.dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
}

int ExitCodeOf(const ComReport& report) {
  if (report.unstable > 0) return kExitRefuted;
  if (report.interrupted) return kExitInterrupted;
  return report.undecided > 0 ? kExitUndecided : kExitOk;
}

}  // namespace cguide::cli
