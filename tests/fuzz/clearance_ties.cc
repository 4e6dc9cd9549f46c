// Near ties of the clearance of placed shapes: balls, capsules and boxes that touch in a face, an
// edge or a corner, moved by a tiny step.
//
// Both shapes are stated in the frame of one pose X, the robot's and the object's, with their axes
// along its axes. There cores are boxes (points, segments) and their difference body is one too, so
// that the distance is a matter of clamping coordinates, whatever the rotation of X. In some cases
// the robot's placement has an error and the truth is displaced by as much.
#include <algorithm>
#include <array>

#include "cguide/exact/body_distance.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/rational_kinematics.h"
#include "tests/fuzz/near_ties.h"
#include "tests/fuzz/twins.h"
#include "tests/numeric/geometry_models.h"

namespace cguide::fuzz {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 15.0 / 512;  ///< a multiple of 3 and of 5: see kFeatures

/** A ball about a box along the axes of X. */
struct AxisShape {
  ConvexShape shape;
  Quaternion q;  ///< turns the shape's z to its axis
  Vector3d half = Vector3d::Zero();
  double radius = 0;
};

/** A capsule's axis is the given one. */
AxisShape RandomShape(TieRng& rng, int axis) {
  AxisShape s;
  const double size = (1 + Below(rng, 8)) / 16.0;
  switch (Below(rng, 3)) {
    case 0:
      s.radius = kRadius * (1 + Below(rng, 4));
      s.shape = Sphere{s.radius};
      break;
    case 1: {
      // (x, y, z) -> (y, z, x) and back.
      static const Quaternion kTurns[] = {{0.5, 0.5, 0.5, 0.5}, {0.5, 0.5, 0.5, -0.5}, {}};
      s.radius = kRadius * (1 + Below(rng, 4));
      s.shape = Capsule{s.radius, 2 * size};
      s.q = kTurns[axis];
      s.half[axis] = size;
      break;
    }
    default:
      s.half = Vector3d(size, (1 + Below(rng, 8)) / 16.0, (1 + Below(rng, 8)) / 16.0);
      s.shape = Box{2 * s.half};
  }
  return s;
}

/** Directions out of a face, an edge or a corner, with their lengths. */
struct Feature {
  std::array<int, 3> out;
  int length;
};
constexpr Feature kFeatures[] = {{{1, 0, 0}, 1}, {{3, 4, 0}, 5}, {{4, 3, 0}, 5},
                                 {{1, 2, 2}, 3}, {{2, 1, 2}, 3}, {{2, 2, 1}, 3}};

struct Touch {
  AxisShape a, b;
  Pose X;
  Vector3d at;                               ///< of a's centre from that of b, along the axes of X
  double error = 0;                          ///< of the robot's placement
  Vector3d displacement = Vector3d::Zero();  ///< of the truth from it, no longer than `error`

  Rational Radii() const { return Lift(a.radius) + Lift(b.radius); }

  /** Squared distance of the cores in truth. */
  Rational Squared() const {
    const Vector3q c = Lift(at) + Lift(displacement);
    Rational sum = 0;
    for (int i = 0; i < 3; ++i) {
      const Rational out = abs(c[i]) - Lift(a.half[i]) - Lift(b.half[i]);
      if (out > 0) sum += out * out;
    }
    return sum;
  }
};

Touch RandomTouch(TieRng& rng) {
  Touch touch{RandomShape(rng, Below(rng, 3)), RandomShape(rng, 2), {}, {}};  // b is not turned
  touch.X.p = AnyPoint(rng);
  const int turn = Below(rng, 4);
  if (turn == 1) touch.X.q = {0.5, 0.5, -0.5, 0.5};
  if (turn > 1) touch.X.q = test::RandomQuaternion(rng);
  const Feature& feature = kFeatures[Below(rng, 6)];
  const double radii = touch.a.radius + touch.b.radius;
  const int first = Below(rng, 3);
  for (int i = 0; i < 3; ++i) {
    const int axis = (first + i) % 3;
    const double room = touch.a.half[axis] + touch.b.half[axis];
    touch.at[axis] = (Below(rng, 5) / 4.0) * room;
    if (feature.out[i] != 0) touch.at[axis] = room + radii / feature.length * feature.out[i];
    if (Below(rng, 2) == 0) touch.at[axis] = -touch.at[axis];
  }
  touch.at += TinyStep(rng) * GridPoint(rng, 2, 4);
  if (Below(rng, 3) == 0) {
    touch.error = std::ldexp(1.0, -34 - Below(rng, 16));
    touch.displacement = touch.error / 2 * GridPoint(rng, 1, 1);  // of length at most sqrt(3)/2
  }
  return touch;
}

Model ModelOf(const Touch& touch) {
  const PieceShape piece = std::visit([](const auto& s) -> PieceShape { return s; }, touch.b.shape);
  return test::OneBodyModel({{{touch.at, touch.a.q}, touch.a.shape}},
                            {test::OneObject("piece", piece, touch.X)});
}

std::string CheckEnclosure(const Touch& touch, const numeric::Clearance& clearance) {
  const Rational squared = touch.Squared(), radii = touch.Radii();
  const auto sum_squared = [&](double x) {
    return Rational((Lift(x) + radii) * (Lift(x) + radii));
  };
  const bool apart = squared > radii * radii;
  if (clearance.overlap) return apart ? "an overlap is claimed where there is none" : "";
  if (clearance.lo > 0 && sum_squared(clearance.lo) > squared) {
    return "the distance is below its lower bound";
  }
  return apart && std::isfinite(clearance.hi) && sum_squared(clearance.hi) < squared
             ? "the distance is above its upper bound"
             : "";
}

std::string CheckVerdict(const Touch& touch, const Model& model, Verdict fast, Tally* tally) {
  const Sign apart = SignOf(Rational(touch.Squared() - touch.Radii() * touch.Radii()));
  const Verdict truth = apart == Sign::kPositive ? Verdict::kHolds : Verdict::kFails;
  ++tally->cases;
  tally->tied += apart == Sign::kZero;
  if (fast != Verdict::kUndecided) {
    ++tally->fast;
    return fast == truth ? "" : "a verdict in doubles is not the truth";
  }
  exact::RobotPlacement placement =
      exact::PlaceRobot(model.robot, exact::RationalConfiguration{touch.X, {}});
  for (exact::LinkPlacement& link : placement.links) link.error_p += Lift(touch.error);
  const exact::Separation twin =
      exact::BodyObjectSeparation(exact::PrepareModel(model), placement, 0, 0, 0);
  ++tally->checked;
  if (twin.verdict == Verdict::kUndecided) {
    --tally->cases;
    tally->tied -= apart == Sign::kZero;
    ++tally->open;
  } else {
    ++tally->exact;
  }
  if (touch.error == 0 && twin.verdict == Verdict::kUndecided) {
    return "the exact twin leaves a tie open";
  }
  return twin.verdict == Verdict::kUndecided || twin.verdict == truth
             ? ""
             : "the exact twin's verdict is not the truth";
}

}  // namespace

std::string TiesOfPlacedClearance(TieRng& rng, Tally* tally) {
  for (int k = 0; k < 16; ++k) {
    const Touch touch = RandomTouch(rng);
    const Model model = ModelOf(touch);
    const numeric::World world(model);
    numeric::Workspace workspace(world);
    Place(world, test::At(touch.X), &workspace);
    for (double& error : workspace.state.error_p) error += touch.error;
    PlaceFromState(world, &workspace);
    std::string wrong =
        CheckEnclosure(touch, PairClearance(world, {0, 0, false}, INFINITY, &workspace));
    if (wrong.empty()) {
      wrong = CheckVerdict(touch, model, TestFree(world, &workspace).verdict, tally);
    }
    if (!wrong.empty()) return wrong;
  }
  return "";
}

}  // namespace cguide::fuzz
