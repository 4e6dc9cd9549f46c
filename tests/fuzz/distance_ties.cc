// Near ties of convex distance. Pairs of hulls on a grid that touch exactly, in a corner, an edge
// or a face, by making: then one of them is moved by a tiny step e. Before the step they share a
// point and a plane separates them, so afterwards they are at most |e| apart or at most |e| deep in
// one another, and the truth is what exact arithmetic says, with a proof that is checked. Near ties
// of a threshold: any pair, and a threshold next to the distance.
#include <algorithm>
#include <optional>

#include "cguide/exact/convex_distance.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/clearance_internal.h"
#include "cguide/numeric/convex_distance.h"
#include "tests/fuzz/near_ties.h"
#include "tests/fuzz/twins.h"

namespace cguide::fuzz {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

struct Pair {
  Points a;
  Points b;
};

std::vector<Vector3q> Lifted(const Points& points) {
  std::vector<Vector3q> lifted;
  for (const Vector3d& p : points) lifted.push_back(Lift(p));
  return lifted;
}

// Multiples of 1/16 in the unit box.
Points GridHull(TieRng& rng, int count) {
  Points points;
  for (int i = 0; i < count; ++i) points.push_back(GridPoint(rng, 16, 16));
  return points;
}

// The part of the hull's points farthest along n: a corner, the corners of an edge or of a face.
double Farthest(const Points& points, const Vector3d& n) {
  double best = -INFINITY;
  for (const Vector3d& p : points) best = std::max(best, n.dot(p));
  return best;
}

Vector3d FarthestPoint(TieRng& rng, const Points& points, const Vector3d& n) {
  const double best = Farthest(points, n);
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (const Vector3d& p : points) {
    if (n.dot(p) != best) continue;  // exact: few bits
    if (count == 0 || Below(rng, 2) == 0) sum = p;
    ++count;
  }
  return sum;
}

/** Normals with small integers, so that whole edges and faces of grid hulls are extreme. */
Vector3d GridNormal(TieRng& rng) {
  while (true) {
    const Vector3d n = GridPoint(rng, Below(rng, 2) == 0 ? 1 : 4, 1);
    if (!n.isZero(0)) return n;
  }
}

// Puts points of `points` on the plane n.x = best, so that a face or an edge lies in it.
void Flatten(TieRng& rng, const Vector3d& n, Points* points) {
  int axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  if (std::abs(n[axis]) != 1) return;  // others do not stay on the grid
  const double best = Farthest(*points, n);
  for (Vector3d& p : *points) {
    if (Below(rng, 2) == 0) p[axis] += (best - n.dot(p)) * n[axis];
  }
}

/** Hulls that touch: a plane with normal n separates them and they share a point of it. */
Pair TouchingPair(TieRng& rng) {
  Pair pair{GridHull(rng, 4 + Below(rng, 7)), GridHull(rng, 4 + Below(rng, 7))};
  const Vector3d n = GridNormal(rng);
  if (Below(rng, 2) == 0) Flatten(rng, n, &pair.a);
  if (Below(rng, 2) == 0) Flatten(rng, -n, &pair.b);
  const Vector3d shift = FarthestPoint(rng, pair.a, n) - FarthestPoint(rng, pair.b, -n);
  for (Vector3d& p : pair.b) p += shift;
  return pair;
}

/** Moves b along a grid direction or a coordinate by a tiny step, which is returned; nothing where
 the case is no near tie. */
std::optional<double> Step(TieRng& rng, Pair* pair) {
  const double step = TinyStep(rng);
  const Vector3d d =
      Below(rng, 2) == 0 ? Vector3d(Vector3d::Unit(Below(rng, 3))) : Vector3d(GridPoint(rng, 2, 4));
  // One corner alone sometimes: a face that is not quite parallel, an edge not quite crossing.
  const int only = Below(rng, 4) == 0 ? Below(rng, static_cast<int>(pair->b.size())) : -1;
  for (int i = 0; i < static_cast<int>(pair->b.size()); ++i) {
    if (only >= 0 && i != only) continue;
    Vector3d& p = pair->b[static_cast<std::size_t>(i)];
    const Vector3d moved = p + step * d;
    if ((moved - p).norm() > kNearTie) return std::nullopt;
    p = moved;
  }
  return step;
}

std::string CheckThreshold(const Pair& pair, double threshold, const Rational& squared,
                           Tally* tally) {
  const Rational t = Lift(threshold);
  const Sign truth = SignOf(Rational(squared - t * t));
  ++tally->cases;
  tally->tied += truth == Sign::kZero;
  const auto fast = numeric::TryCompareDistance({pair.a}, {pair.b}, threshold);
  ++(fast ? tally->fast : tally->exact);
  if (fast && *fast != truth) return "a comparison in doubles has the wrong sign";
  return numeric::CompareDistance({pair.a}, {pair.b}, threshold) == truth
             ? ""
             : "a comparison has the wrong sign";
}

// The whole answer, its proof, and the bounds.
std::string CheckAnswer(const Pair& pair, bool thorough, Rational* squared, Tally* tally) {
  const std::vector<Vector3q> p = Lifted(pair.a), q = Lifted(pair.b);
  const auto fast = numeric::TrySquaredConvexDistance(pair.a, pair.b);
  const numeric::HullDistance ours = numeric::SquaredConvexDistance(pair.a, pair.b);
  if (fast && fast->squared != ours.squared) return "the fast stage disagrees with the whole";
  const exact::ConvexDistance closest = numeric::ClosestPoints(p, q, ours);
  if (closest.squared != ours.squared || !exact::CheckConvexDistance(p, q, closest)) {
    return "the closest points prove another distance";
  }
  const numeric::DistanceBounds bounds = numeric::BoundConvexDistance(pair.a, pair.b);
  if (Lift(bounds.lo) * Lift(bounds.lo) > ours.squared ||
      Lift(bounds.hi) * Lift(bounds.hi) < ours.squared) {
    return "the bounds do not hold the distance";
  }
  *squared = ours.squared;
  if (!thorough) return "";
  ++tally->checked;
  return exact::SquaredConvexDistanceByQp(p, q).squared == ours.squared
             ? ""
             : "quadratic programming finds another distance";
}

numeric::Convex View(const Points& points) {
  numeric::Convex s;
  s.kind = numeric::CoreKind::kPoints;
  s.points = points.data();
  s.num_points = static_cast<int>(points.size());
  for (const Vector3d& p : points) {
    s.half = s.half.cwiseMax(p.cwiseAbs());
    s.reach = std::max(s.reach, p.norm() * (1 + 1e-15));
  }
  s.error = numeric::PlacementError(0, 0, s.reach, 0);
  return s;
}

// Doubles prove the hulls apart or overlapping, or leave the pair to the exact comparison.
std::string CheckEnclosure(const Pair& pair, const Rational& squared, Tally* tally) {
  const numeric::DirectedClearance clearance =
      numeric::ConvexClearance(View(pair.a), View(pair.b), 100);
  const bool apart = !clearance.overlap && clearance.lo > 0;
  ++tally->cases;
  ++(apart || clearance.overlap ? tally->fast : tally->exact);
  if (clearance.overlap && squared != 0) return "an overlap is claimed where there is none";
  if (clearance.overlap) return "";
  const double lo = std::max(0.0, clearance.lo);
  if (Lift(lo) * Lift(lo) > squared) return "the distance is below its lower bound";
  if (std::isfinite(clearance.hi) && Lift(clearance.hi) * Lift(clearance.hi) < squared) {
    return "the distance is above its upper bound";
  }
  if (apart) return "";
  return numeric::CompareDistance({pair.a}, {pair.b}, 0) == SignOf(squared)
             ? ""
             : "the exact stage has the wrong sign";
}

}  // namespace

std::string TiesOfDistance(TieRng& rng, long every, Tally* tally) {
  for (int k = 0; k < 8; ++k) {
    Pair pair = TouchingPair(rng);
    if (!Step(rng, &pair)) continue;
    Rational squared;
    std::string wrong = CheckAnswer(pair, SlowCheckIsDue(*tally, every), &squared, tally);
    if (wrong.empty()) wrong = CheckThreshold(pair, 0, squared, tally);
    if (!wrong.empty()) return wrong;
    // Apart by a distance that is a double or is not; thresholds around it.
    const Vector3d away = 4 * GridNormal(rng);
    for (Vector3d& p : pair.b) p += away;
    wrong = CheckAnswer(pair, false, &squared, tally);
    if (!wrong.empty()) return wrong;
    const double d = NearestDouble(exact::SqrtDown(squared));
    for (int j = 0; j < 4 && d > 0; ++j) {
      wrong = CheckThreshold(pair, d * (1 + TinyStep(rng)), squared, tally);
      if (!wrong.empty()) return wrong;
    }
  }
  return "";
}

std::string TiesOfClearance(TieRng& rng, long every, Tally* tally) {
  if (Below(rng, 2) == 0) return TiesOfPlacedClearance(rng, tally);
  for (int k = 0; k < 16; ++k) {
    Pair pair = TouchingPair(rng);
    const std::optional<double> step = Step(rng, &pair);
    if (!step) continue;
    tally->tied += *step == 0;
    const auto exact = numeric::SquaredConvexDistance(pair.a, pair.b).squared;
    const std::string wrong = CheckEnclosure(pair, exact, tally);
    if (!wrong.empty()) return wrong;
    if (!SlowCheckIsDue(*tally, every)) continue;
    ++tally->checked;
    if (exact::SquaredConvexDistanceByQp(Lifted(pair.a), Lifted(pair.b)).squared != exact) {
      return "quadratic programming finds another distance";
    }
  }
  return "";
}

}  // namespace cguide::fuzz
