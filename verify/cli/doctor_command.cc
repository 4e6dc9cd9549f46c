#include <gmp.h>
#include <mpfr.h>

#include <algorithm>
#include <cfenv>
#include <iostream>
#include <set>
#include <sstream>
#include <thread>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/describe.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/membership.h"
#include "cguide/verify/cli/commands.h"
#include "cguide/verify/cli/console.h"
#include "cguide/verify/cli/version.h"

namespace cguide::cli {
namespace {

using numeric::Problem;
using numeric::World;

// Findings in three grades; a warning is something the user should look at before trusting an
// answer.
class Findings {
 public:
  void Good(const std::string& text) { std::cout << "ok       " << text << '\n'; }
  void Note(const std::string& text) { std::cout << "note     " << text << '\n'; }
  void Warn(const std::string& text) {
    std::cout << "warning  " << text << '\n';
    ++warnings_;
  }
  int warnings() const { return warnings_; }

 private:
  int warnings_ = 0;
};

// The rounding mode must reach the arithmetic: volatile operands keep the compiler from folding it.
bool DirectedRoundingWorks() {
  volatile double one = 1, three = 3;
  const int old_mode = std::fegetround();
  std::fesetround(FE_UPWARD);
  const volatile double up = one / three;
  std::fesetround(FE_DOWNWARD);
  const volatile double down = one / three;
  std::fesetround(old_mode);
  return up > down;
}

// 0.1 * 0.1 - fl(0.1 * 0.1) is 0 when each operation is rounded and not 0 when they are fused.
bool OperationsAreNotFused() {
  volatile double a = 0.1;
  const volatile double product = a * a;
  const double difference = a * a - product;
  return difference == 0;
}

void CheckMachine(Findings* findings) {
  std::ostringstream versions;
  versions << "cguide " << kVersion << ", GMP " << gmp_version << ", MPFR " << mpfr_get_version()
           << ", " << std::thread::hardware_concurrency() << " threads";
  findings->Good(versions.str());
  if (std::fegetround() == FE_TONEAREST && DirectedRoundingWorks()) {
    findings->Good("double arithmetic rounds to nearest, and directed rounding works");
  } else {
    findings->Warn(
        "directed rounding does not work on this machine or in this build; do not use it");
  }
  if (OperationsAreNotFused()) {
    findings->Good("products and sums are rounded one by one");
  } else {
    findings->Warn("the build fuses products and sums (-ffp-contract); error bounds do not hold");
  }
}

struct ShapeCount {
  int boxes = 0, round = 0, hulls = 0;
  std::size_t largest_hull = 0;
};

ShapeCount CountShapes(const Robot& robot) {
  ShapeCount count;
  for (const Link& link : robot.links) {
    for (const LinkShape& shape : link.shapes) {
      if (const auto* hull = std::get_if<Hull>(&shape.geometry)) {
        ++count.hulls;
        count.largest_hull = std::max(count.largest_hull, hull->vertices.size());
      } else if (std::holds_alternative<Box>(shape.geometry)) {
        ++count.boxes;
      } else {
        ++count.round;
      }
    }
  }
  return count;
}

void CheckRobot(const Problem& problem, const World& world, Findings* findings) {
  const Robot& robot = problem.model.robot;
  std::ostringstream text;
  text << "robot \"" << robot.name << "\": " << robot.links.size() << " links in "
       << robot.bodies.size() << " bodies, " << robot.num_columns << " joint values, "
       << Short(world.tree().mass) << " kg";
  findings->Good(text.str());
  const ShapeCount shapes = CountShapes(robot);
  text.str("");
  text << "collision shapes: " << shapes.boxes << " boxes, " << shapes.round << " round ones, "
       << shapes.hulls << " convex hulls";
  if (shapes.hulls > 0) text << " (the largest has " << shapes.largest_hull << " vertices)";
  findings->Good(text.str());
  for (const Body& body : robot.bodies) {
    double mass = 0;
    bool shaped = false;
    for (int link : body.links) {
      mass += robot.links[link].mass;
      shaped = shaped || !robot.links[link].shapes.empty();
    }
    if (!shaped && mass > 0.5) {
      findings->Warn("body \"" + body.name + "\" weighs " + Short(mass) +
                     " kg but has no collision shape; it cannot collide or be in contact");
    } else if (shaped && mass == 0) {
      findings->Note("body \"" + body.name + "\" has shapes but no mass");
    }
  }
  const auto names = ColumnNames(robot);
  for (int i = 0; i < robot.num_columns; ++i) {
    const numeric::ColumnLimits& limit = world.tree().limits[i];
    if (limit.bounded && limit.lower == limit.upper) {
      findings->Note("joint \"" + names[i] + "\" has no range and never moves");
    }
  }
}

void CheckScene(const Model& model, Findings* findings) {
  if (model.objects.empty()) {
    findings->Warn("the scene has no object, so no contact is possible");
  }
  for (const Object& object : model.objects) {
    std::size_t triangles = 0;
    int solids = 0, surfaces = 0;
    for (const Piece& piece : object.pieces) {
      if (const auto* solid = std::get_if<Solid>(&piece.geometry)) {
        ++solids;
        triangles += solid->triangles.size();
      } else if (const auto* surface = std::get_if<Surface>(&piece.geometry)) {
        ++surfaces;
        triangles += surface->triangles.size();
      }
    }
    std::ostringstream text;
    text << "object \"" << object.name << "\": " << object.pieces.size() << " pieces, mu "
         << Short(object.friction);
    if (triangles > 0) {
      text << ", " << triangles << " triangles in " << solids << " solid and " << surfaces
           << " surface parts";
    }
    findings->Good(text.str());
    if (surfaces > 0) {
      findings->Note("object \"" + object.name +
                     "\" has open parts: they are surfaces without an inside");
    }
  }
}

// Body pairs that overlap at the zero posture and at the start: usually neighbours that the SRDF
// forgot to disable.
void CheckSelfCollision(const Problem& problem, const World& world,
                        numeric::GuideWorkspace* workspace, Findings* findings) {
  Place(world, problem.start, &workspace->geometry);
  int overlaps = 0;
  for (const auto& [i, j] : problem.model.self_pairs) {
    const numeric::Pair pair{i, j, true};
    if (!PairClearance(world, pair, 0.01, &workspace->geometry).overlap) continue;
    ++overlaps;
    findings->Warn("at the start " + numeric::DescribePair(problem.model, pair) +
                   " overlap; disable the pair in the SRDF if they always do");
  }
  if (overlaps == 0) {
    findings->Good(std::to_string(problem.model.self_pairs.size()) +
                   " self-collision pairs, none overlaps at the start");
  }
}

void CheckEndpoint(const Problem& problem, const World& world, const Configuration& q,
                   const char* what, numeric::GuideWorkspace* workspace, Findings* findings) {
  const numeric::Membership membership =
      TestConfiguration(world, q, numeric::Space::kGuide, workspace);
  if (membership.verdict == Verdict::kHolds) {
    findings->Good(std::string(what) + " lies in C_guide with " +
                   std::to_string(workspace->contacts.size()) + " contact points");
    return;
  }
  findings->Warn(std::string(what) +
                 " is not in C_guide: " + numeric::DescribeMembership(problem.model, membership));
}

}  // namespace

int RunDoctor(const DoctorArguments& arguments) {
  Findings findings;
  CheckMachine(&findings);
  if (!arguments.problem.empty()) {
    const Problem problem = numeric::io::ReadProblem(arguments.problem);
    for (const std::string& warning : problem.warnings) findings.Warn(warning);
    for (const std::string& note : problem.notes) findings.Note(note);
    const World world(problem.model);
    numeric::GuideWorkspace workspace(world);
    CheckRobot(problem, world, &findings);
    CheckScene(problem.model, &findings);
    CheckSelfCollision(problem, world, &workspace, &findings);
    CheckEndpoint(problem, world, problem.start, "the start", &workspace, &findings);
    CheckEndpoint(problem, world, problem.goal, "the goal", &workspace, &findings);
  }
  std::cout << (findings.warnings() == 0 ? "nothing suspicious\n"
                                         : std::to_string(findings.warnings()) + " to look at\n");
  return kExitOk;
}

}  // namespace cguide::cli
