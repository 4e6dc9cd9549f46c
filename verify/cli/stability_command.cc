#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/force_distribution.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/margins.h"
#include "cguide/numeric/membership.h"
#include "cguide/numeric/proved_margins.h"
#include "cguide/verify/cli/com_positions.h"
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
  std::vector<numeric::WitnessForce> forces;  ///< a balance; indices into `contacts`
  std::optional<int> rank;  ///< of the contacts' wrenches, where an exact stage ran
  Eigen::Vector3d com_W = Eigen::Vector3d::Zero();

  exact::Enclosure com_margin;
  std::optional<numeric::ProvedMarginGradient> gradient;  ///< of com_margin; one box a contact
  exact::Enclosure force_margin;
  bool force_checked = false;  ///< else a float
  int sides = 4;               ///< of the pyramids of the force margin
  numeric::ProvedSupportRegion region;
  std::optional<numeric::ForceDistribution> distribution;
};

constexpr numeric::MarginOptions kRegionOptions{1e-4, 40};  // a tenth of a millimetre is for people

/** Margins, region and forces, with proofs where there can be any: a contact without a normal
 allows none. */
void AskMargins(const numeric::StabilityQuery& query, Answer* answer) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  numeric::StabilityWorkspace workspace;
  answer->sides = query.generators;
  answer->com_margin = {-kInfinity, kInfinity};
  answer->region.gap = kInfinity;
  const auto force_margin = numeric::ProveForceMargin(query);
  answer->force_checked = force_margin.has_value();
  const double force = force_margin ? 0 : numeric::ForceMargin(query);
  answer->force_margin = force_margin.value_or(exact::Enclosure{force, force});
  for (const numeric::Contact& contact : query.contacts) {
    if (contact.n_W.isZero(0)) return;
  }
  answer->com_margin = numeric::ProveComMargin(query, {}, &workspace).com_m;
  answer->gradient = numeric::ProveComMarginGradient(query, {}, &workspace);
  answer->region = numeric::ProveSupportRegion(query, {kRegionOptions, {}}, &workspace);
  answer->distribution = numeric::DistributeForces(query, &workspace);
}

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
  if (settled.exact) answer.rank = settled.exact->rank;
  answer.com_W = ladder.com_W();
  AskMargins(ladder.Query(), &answer);
  // The distribution is over the contacts in doubles; a later rung may have found others.
  if (answer.contacts.size() != ladder.contacts().size()) {
    answer.distribution.reset();
    answer.gradient.reset();
  }
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

/** A proved tie: forces balance, and any small push may end that. */
bool IsBoundary(const Answer& answer) {
  return answer.stability.verdict == Verdict::kUndecided && !answer.forces.empty();
}

/** A separating wrench, or one that supports the cone at a boundary of rank 6. */
bool HasWrench(const Answer& answer) { return !answer.stability.separator.y.isZero(0); }

std::string Vector(const Eigen::Vector3d& v) {
  return "[" + Short(v.x()) + " " + Short(v.y()) + " " + Short(v.z()) + "]";
}

/** The value in the unit with so many digits, rounded up or down. */
std::string Rounded(double value, double unit, int digits, bool up) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  if (value == 0) return "0";
  const double scaled = value / unit;
  const double step = std::pow(10.0, std::floor(std::log10(std::abs(scaled))) + 1 - digits);
  // Quotient and power may be off by an ulp or so: a hundredth of a step more.
  const double steps = up ? std::ceil(scaled / step + 0.01) : std::floor(scaled / step - 0.01);
  std::ostringstream out;
  out.precision(digits);
  out << steps * step;
  return out.str();
}

std::string Enclosed(const exact::Enclosure& x, double unit) {
  return "[" + Rounded(x.lo, unit, 8, false) + ", " + Rounded(x.hi, unit, 8, true) + "]";
}

/** The middle of a box in metres per metre, and how far it may be off. */
std::string Enclosed(const exact::EnclosedVector& box) {
  Eigen::Vector3d middle;
  double off = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    // Shown to 1e-4; the rest counts as error.
    const double x = std::round((box[k].lo + box[k].hi) * 5e3) * 1e-4 + 0.0;  // no -0
    middle[static_cast<int>(k)] = x;
    off = std::max({off, box[k].hi - x, x - box[k].lo});
  }
  return Vector(middle) + " within " + Rounded(off, 1, 2, true);
}

std::string ContactName(const Model& model, const numeric::Contact& contact) {
  return "\"" + model.robot.bodies[contact.body].name + "\" on \"" +
         model.objects[contact.object].name + "\"";
}

std::string ForceMarginText(const Answer& answer) {
  if (!answer.force_checked) return Short(answer.force_margin.lo) + " (a float, not checked)";
  return Enclosed(answer.force_margin, 1) + ", checked exactly for pyramids of " +
         std::to_string(answer.sides) + " sides";
}

void PrintForces(const Answer& answer) {
  if (answer.distribution) {
    std::cout << "forces that balance it, checked exactly (N)\n";
    for (std::size_t i = 0; i < answer.contacts.size(); ++i) {
      // Shown to a tenth of a millinewton.
      const Eigen::Vector3d f =
          (answer.distribution->force_W[i] * 1e4).array().round() * 1e-4 + 0.0;  // no -0
      if (f.isZero(0)) continue;
      std::cout << "  " << Vector(f) << " at " << Vector(answer.contacts[i].force_point_W())
                << '\n';
    }
    return;
  }
  std::cout << "forces that balance it (N)\n";
  for (const numeric::WitnessForce& f : answer.forces) {
    const auto at = static_cast<std::size_t>(f.contact);
    std::cout << "  " << Vector(f.weight * f.u_W) << " at "
              << Vector(answer.contacts[at].force_point_W()) << '\n';
  }
}

/** How the com margin changes with each point that it depends on by more than is shown. */
void PrintGradient(const Answer& answer) {
  if (!answer.gradient) return;
  std::cout << "gradient of the com margin, checked exactly (mm per mm)\n  "
            << Enclosed(answer.gradient->com_W) << " as the centre of mass moves\n";
  for (std::size_t i = 0; i < answer.contacts.size(); ++i) {
    const exact::EnclosedVector& box = answer.gradient->contact_W[i];
    const bool idle = std::all_of(box.begin(), box.end(), [](const exact::Enclosure& e) {
      return e.lo > -1e-4 && e.hi < 1e-4;
    });
    if (idle) continue;
    std::cout << "  " << Enclosed(box) << " as the contact at "
              << Vector(answer.contacts[i].force_point_W()) << " moves\n";
  }
}

void PrintRegion(const numeric::ProvedSupportRegion& region) {
  const char* what = "support region of the centre of mass";
  if (region.is_empty) std::cout << what << ": empty, checked exactly\n";
  if (region.whole_plane) std::cout << what << ": the whole plane, checked exactly\n";
  if (region.inner_W.empty()) return;
  std::cout << what << ", complete "
            << (std::isinf(region.gap) ? "on no side"
                                       : "within " + Rounded(region.gap, 1e-3, 2, true) + " mm")
            << ", checked exactly (m)\n";
  for (const Eigen::Vector3d& p : region.inner_W) {
    std::cout << "  " << Short(p.x()) << ' ' << Short(p.y()) << '\n';
  }
}

void PrintText(const Question& question, const Answer& answer) {
  const Model& model = question.problem.model;
  std::cout << question.what << ": " << VerdictText(answer) << '\n'
            << "  centre of mass " << Vector(answer.com_W) << " m\n"
            << "  com margin   " << Enclosed(answer.com_margin, 1e-3) << " mm, checked exactly\n"
            << "  force margin " << ForceMarginText(answer) << '\n'
            << answer.contacts.size() << " contact points\n";
  for (const numeric::Contact& contact : answer.contacts) {
    std::cout << "  " << ContactName(model, contact) << " at " << Vector(contact.force_point_W())
              << " m, normal " << Vector(contact.n_W) << ", gap "
              << Millimetres(contact.distance - contact.radius) << ", mu "
              << Short(contact.friction) << (contact.certain ? "" : ", perhaps not active") << '\n';
  }
  if (answer.stability.verdict == Verdict::kHolds || IsBoundary(answer)) PrintForces(answer);
  if (answer.stability.verdict != Verdict::kHolds && HasWrench(answer)) {
    std::cout << (IsBoundary(answer) ? "supporting" : "separating")
              << " wrench about the centre of mass\n  [";
    for (int i = 0; i < 6; ++i)
      std::cout << (i ? " " : "") << Short(answer.stability.separator.y[i]);
    std::cout << "]\n";
  }
  PrintGradient(answer);
  PrintRegion(answer.region);
}

Json ToJson(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json Number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

/** The ends; infinite ones as null. */
Json ToJson(const exact::Enclosure& x) { return Json::array({Number(x.lo), Number(x.hi)}); }

Json ToJson(const exact::EnclosedVector& box) {
  return Json::array({ToJson(box[0]), ToJson(box[1]), ToJson(box[2])});
}

/** Enclosures by component; null where nothing is proved. */
Json GradientJson(const std::optional<numeric::ProvedMarginGradient>& gradient) {
  if (!gradient) return nullptr;
  Json json;
  json["com"] = ToJson(gradient->com_W);
  json["contacts"] = Json::array();
  for (const exact::EnclosedVector& box : gradient->contact_W) {
    json["contacts"].push_back(ToJson(box));
  }
  return json;
}

Json ForcesJson(const Answer& answer) {
  Json forces = Json::array();
  const auto add = [&forces](int contact, const Eigen::Vector3d& f) {
    forces.push_back({{"contact", contact}, {"force_n", ToJson(f)}});
  };
  if (answer.distribution) {
    for (std::size_t i = 0; i < answer.contacts.size(); ++i) {
      const Eigen::Vector3d& f = answer.distribution->force_W[i];
      if (!f.isZero(0)) add(static_cast<int>(i), f);
    }
  } else if (answer.stability.verdict != Verdict::kFails) {
    for (const numeric::WitnessForce& f : answer.forces) add(f.contact, f.weight * f.u_W);
  }
  return forces;
}

void PrintJson(const Question& question, const Answer& answer) {
  const Model& model = question.problem.model;
  Json json;
  json["schema"] = "cguide-stability/1";
  json["configuration"] = question.what;
  json["verdict"] = answer.stability.verdict == Verdict::kHolds   ? "stable"
                    : answer.stability.verdict == Verdict::kFails ? "unstable"
                                                                  : "undecided";
  json["stage"] = StageName(answer.rung);
  json["reason"] = answer.reason.empty() ? Json(nullptr) : Json(answer.reason);
  json["rank"] = answer.rank ? Json(*answer.rank) : Json(nullptr);
  json["com_m"] = ToJson(answer.com_W);
  json["com_margin_m"] = Number(answer.com_margin.lo);
  json["com_margin_enclosure_m"] = ToJson(answer.com_margin);
  json["com_margin_gradient"] = GradientJson(answer.gradient);
  json["force_margin"] = Number(answer.force_margin.lo);
  json["force_margin_enclosure"] = nullptr;
  if (answer.force_checked) json["force_margin_enclosure"] = ToJson(answer.force_margin);
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
  json["forces"] = ForcesJson(answer);
  json["separating_wrench"] = nullptr;
  json["supporting_wrench"] = nullptr;
  if (answer.stability.verdict != Verdict::kHolds && HasWrench(answer)) {
    Json& wrench = json[IsBoundary(answer) ? "supporting_wrench" : "separating_wrench"];
    wrench = Json::array();
    for (double y : answer.stability.separator.y) wrench.push_back(y);
  }
  json["support_region_m"] = Json::array();
  json["support_region_gap_m"] = Number(answer.region.gap);
  for (const Eigen::Vector3d& p : answer.region.inner_W)
    json["support_region_m"].push_back(ToJson(p));
  // A file name may be any bytes.
  std::cout << json.dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
}

}  // namespace

int RunStability(const StabilityArguments& arguments) {
  if (arguments.problem.empty() && arguments.guide.empty()) {
    std::cerr << "cguide stability: name a problem file or --guide\n";
    return kExitUsage;
  }
  const Question question = ReadQuestion(arguments);
  if (!arguments.coms.empty()) {
    const ComReport report = AskComs(question.problem, question.q, ReadComs(arguments.coms));
    arguments.format == "json" ? PrintJson(question.what, report)
                               : PrintText(question.what, report);
    return ExitCodeOf(report);
  }
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
