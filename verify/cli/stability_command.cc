#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/margins.h"
#include "cguide/numeric/membership.h"
#include "cguide/verify/cli/commands.h"
#include "cguide/verify/cli/console.h"
#include "cguide/verify/cli/subject.h"
#include "cguide/verify/sample_ladder.h"

namespace cguide::cli {
namespace {

using Json = nlohmann::ordered_json;
using numeric::Problem;

struct Question {
  Problem problem;
  Configuration q;
  std::string what;  ///< "posture sitting", "guide.json at 3.5"
};

Configuration PostureOf(const Problem& problem, const std::string& name) {
  if (name == "start") return problem.start;
  if (name == "goal") return problem.goal;
  const auto posture = problem.postures.find(name);
  if (posture == problem.postures.end()) {
    std::string known = "start, goal";
    for (const auto& [other, values] : problem.postures) known += ", " + other;
    throw Error(Error::Code::kBadInput,
                "--posture " + name + ": the problem has no such posture; it has " + known);
  }
  return {problem.start.X_WB, posture->second};
}

Configuration ConfigurationAt(const Path& path, double at) {
  const double edges = static_cast<double>(path.waypoints.size() - 1);
  if (!(at >= 0 && at <= edges)) {
    throw Error(Error::Code::kBadInput, "--at " + Short(at) + ": the path runs from 0 to " +
                                            Short(edges) + " (edge index plus s)");
  }
  const auto edge = static_cast<std::size_t>(std::floor(at));
  const double s = at - std::floor(at);
  if (s == 0) return path.waypoints[edge];
  return Interpolate({path.waypoints[edge], path.waypoints[edge + 1]}, s);
}

Question ReadQuestion(const StabilityArguments& arguments) {
  if (!arguments.guide.empty()) {
    Subject subject = ReadSubject(arguments.common, arguments.guide, arguments.problem);
    const double at = std::max(0.0, arguments.at);
    Configuration q = ConfigurationAt(subject.path, at);
    return {std::move(subject.problem), std::move(q), arguments.guide + " at " + Short(at)};
  }
  Problem problem = numeric::io::ReadProblem(arguments.problem);
  Warn(arguments.common, problem.warnings);
  const std::string name = arguments.posture.empty() ? "start" : arguments.posture;
  Configuration q = PostureOf(problem, name);
  return {std::move(problem), std::move(q), "posture " + name};
}

struct Answer {
  numeric::StabilityAnswer stability;
  std::string reason;  ///< where undecided
  numeric::StabilityRung rung = numeric::StabilityRung::kUndecided;
  std::vector<numeric::Contact> contacts;
  std::vector<numeric::WitnessForce> forces;
  double com_margin = 0;
  double force_margin = 0;
  std::vector<Eigen::Vector3d> region;
  Eigen::Vector3d com_W = Eigen::Vector3d::Zero();
};

Answer Ask(const Question& question) {
  const numeric::World world(question.problem.model);
  const verify::PreparedTwins twins(world);
  verify::SampleLadder ladder(world, twins);
  ladder.Place(question.q);
  Answer answer;
  verify::StageCounts counts;
  numeric::LadderedStability settled = ladder.TestStability(&counts);
  answer.stability = settled.answer;
  answer.reason = settled.reason;
  answer.rung = settled.rung;
  answer.contacts = std::move(settled.contacts);
  answer.forces = std::move(settled.forces);
  answer.com_margin = ladder.ComMargin();
  answer.force_margin = ladder.ForceMargin();
  answer.region = ladder.SupportRegion();
  answer.com_W = ladder.com_W();
  return answer;
}

const char* StageText(numeric::StabilityRung rung) {
  switch (rung) {
    case numeric::StabilityRung::kFast:
      return " (decided in doubles with a bound)";
    case numeric::StabilityRung::kStored:
      return " (decided by the exact twin)";
    case numeric::StabilityRung::kBits106:
      return " (decided by the exact twin, kinematics of 106 bits)";
    case numeric::StabilityRung::kBits256:
      return " (decided by the exact twin, kinematics of 256 bits)";
    case numeric::StabilityRung::kUndecided:
      break;
  }
  return "";
}

const char* StageName(numeric::StabilityRung rung) {
  switch (rung) {
    case numeric::StabilityRung::kFast:
      return "fast";
    case numeric::StabilityRung::kStored:
      return "exact";
    case numeric::StabilityRung::kBits106:
      return "exact_106_bits";
    case numeric::StabilityRung::kBits256:
      return "exact_256_bits";
    case numeric::StabilityRung::kUndecided:
      break;
  }
  return "none";
}

std::string VerdictText(const Answer& answer) {
  const char* stage = StageText(answer.rung);
  switch (answer.stability.verdict) {
    case Verdict::kHolds:
      return std::string("statically stable") + stage;
    case Verdict::kFails:
      return std::string("not statically stable") + stage;
    case Verdict::kUndecided:
      break;
  }
  return "undecided: " + answer.reason;
}

std::string Vector(const Eigen::Vector3d& v) {
  return "[" + Short(v.x()) + " " + Short(v.y()) + " " + Short(v.z()) + "]";
}

std::string ContactName(const Model& model, const numeric::Contact& contact) {
  return "\"" + model.robot.bodies[contact.body].name + "\" on \"" +
         model.objects[contact.object].name + "\"";
}

void PrintText(const Question& question, const Answer& answer) {
  const Model& model = question.problem.model;
  std::cout << question.what << ": " << VerdictText(answer) << '\n'
            << "  centre of mass " << Vector(answer.com_W) << " m, com margin "
            << Millimetres(answer.com_margin) << ", force margin " << Short(answer.force_margin)
            << '\n'
            << answer.contacts.size() << " contact points\n";
  for (const numeric::Contact& contact : answer.contacts) {
    std::cout << "  " << ContactName(model, contact) << " at " << Vector(contact.force_point_W())
              << " m, normal " << Vector(contact.n_W) << ", gap "
              << Millimetres(contact.distance - contact.radius) << ", mu "
              << Short(contact.friction) << (contact.certain ? "" : ", perhaps not active") << '\n';
  }
  if (answer.stability.verdict == Verdict::kHolds) {
    std::cout << "forces that balance it (N)\n";
    for (const numeric::WitnessForce& f : answer.forces) {
      const auto at = static_cast<std::size_t>(f.contact);
      std::cout << "  " << Vector(f.weight * f.u_W) << " at "
                << Vector(answer.contacts[at].force_point_W()) << '\n';
    }
  } else if (answer.stability.verdict == Verdict::kFails) {
    std::cout << "separating wrench about the centre of mass\n  [";
    for (int i = 0; i < 6; ++i)
      std::cout << (i ? " " : "") << Short(answer.stability.separator.y[i]);
    std::cout << "]\n";
  }
  if (!answer.region.empty()) {
    std::cout << "support region of the centre of mass (m)\n";
    for (const Eigen::Vector3d& p : answer.region) {
      std::cout << "  " << Short(p.x()) << ' ' << Short(p.y()) << '\n';
    }
  }
}

Json ToJson(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json Number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

void PrintJson(const Question& question, const Answer& answer) {
  const Model& model = question.problem.model;
  Json json;
  json["schema"] = "cguide-stability/1";
  json["configuration"] = question.what;
  json["verdict"] = answer.stability.verdict == Verdict::kHolds   ? "stable"
                    : answer.stability.verdict == Verdict::kFails ? "unstable"
                                                                  : "undecided";
  json["stage"] = StageName(answer.rung);
  json["com_m"] = ToJson(answer.com_W);
  json["com_margin_m"] = Number(answer.com_margin);
  json["force_margin"] = Number(answer.force_margin);
  json["contacts"] = Json::array();
  for (const numeric::Contact& c : answer.contacts) {
    Json contact;
    contact["body"] = model.robot.bodies[c.body].name;
    contact["object"] = model.objects[c.object].name;
    contact["point_m"] = ToJson(c.force_point_W());
    contact["normal"] = ToJson(c.n_W);
    contact["gap_m"] = c.distance - c.radius;
    contact["friction"] = c.friction;
    contact["certain"] = c.certain;
    json["contacts"].push_back(contact);
  }
  json["forces"] = Json::array();
  if (answer.stability.verdict == Verdict::kHolds) {
    for (const numeric::WitnessForce& f : answer.forces) {
      Json force;
      force["contact"] = f.contact;
      force["force_n"] = ToJson(f.weight * f.u_W);
      json["forces"].push_back(force);
    }
  }
  json["separating_wrench"] = nullptr;
  if (answer.stability.verdict == Verdict::kFails) {
    json["separating_wrench"] = Json::array();
    for (double y : answer.stability.separator.y) json["separating_wrench"].push_back(y);
  }
  json["support_region_m"] = Json::array();
  for (const Eigen::Vector3d& p : answer.region) json["support_region_m"].push_back(ToJson(p));
  std::cout << json.dump(1) << '\n';
}

}  // namespace

int RunStability(const StabilityArguments& arguments) {
  if (arguments.problem.empty() && arguments.guide.empty()) {
    std::cerr << "cguide stability: name a problem file or --guide\n";
    return kExitUsage;
  }
  const Question question = ReadQuestion(arguments);
  const Answer answer = Ask(question);
  arguments.format == "json" ? PrintJson(question, answer) : PrintText(question, answer);
  switch (answer.stability.verdict) {
    case Verdict::kHolds:
      return kExitOk;
    case Verdict::kFails:
      return kExitRefuted;
    case Verdict::kUndecided:
      break;
  }
  return kExitUndecided;
}

}  // namespace cguide::cli
