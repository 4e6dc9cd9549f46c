#include "cguide/numeric/convex_distance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/convex_distance_internal.h"
#include "cguide/numeric/fp_guard.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using Points = std::span<const Vector3d>;

HullPair PairOf(const PointSet& a, const PointSet& b) {
  HullPair hulls;
  hulls.a = a;
  hulls.b = b;
  hulls.filter = std::max(LargestCoordinate(*a.lanes), LargestCoordinate(*b.lanes)) <= kLargest;
  return hulls;
}

Simplex Propose(const HullPair& hulls) {
  GjkResult gjk;
  if (hulls.filter) Gjk(hulls.a, hulls.b, hulls.a.points[0] - hulls.b.points[0], INFINITY, &gjk);
  return SimplexOf(gjk);
}

// Whether the simplex attains the distance; else it becomes what to go on with: itself where it
// does not hold its nearest point, else with a corner nearer to the origin.
bool Confirms(HullPair* hulls, Simplex* simplex) {
  Face face(hulls, *simplex);
  if (!face.HoldsNearest()) return false;
  if (face.MeetsOrigin()) return true;
  const std::optional<Corner> corner = face.Violator();
  if (corner) simplex->Push(*corner);
  return !corner;
}

HullDistance Answer(const HullPair& hulls, const Simplex& simplex, int rounds) {
  HullDistance result;
  result.squared = SquaredDistance(hulls, simplex);
  result.size = simplex.size;
  for (int k = 0; k < simplex.size; ++k) {
    result.corners[k] = {simplex.corners[k].i, simplex.corners[k].j};
  }
  result.exact_signs = hulls.exact_signs;
  result.rounds = rounds;
  return result;
}

HullDistance Decide(HullPair* hulls) {
  int rounds = 0;
  const Simplex simplex = DecideSimplex(hulls, Propose(*hulls), &rounds);
  return Answer(*hulls, simplex, rounds);
}

class RationalSpans : public RationalPoints {
 public:
  RationalSpans(std::span<const Vector3q> a, std::span<const Vector3q> b) : a_(a), b_(b) {}
  Vector3q Get(bool of_b, int index) const override { return of_b ? b_[index] : a_[index]; }

 private:
  std::span<const Vector3q> a_, b_;
};

// Doubles below the points in magnitude by less than an ulp, 2 u of themselves (or 2^-1074).
std::vector<Vector3d> TruncatedDoubles(std::span<const Vector3q> points) {
  std::vector<Vector3d> result;
  result.reserve(points.size());
  for (const Vector3q& p : points) {
    result.emplace_back(p[0].get_d(), p[1].get_d(), p[2].get_d());
  }
  return result;
}

}  // namespace

Simplex SimplexOf(const GjkResult& gjk) {
  Simplex simplex;
  for (int k = 0; k < gjk.size; ++k) simplex.Push({gjk.simplex[k].i, gjk.simplex[k].j});
  if (simplex.size == 0) simplex.Push({0, 0});
  return simplex;
}

// Each round ends with the point of a simplex nearest to the origin, strictly nearer than that of
// the round before (after the first round): there are finitely many simplices, so it ends.
Simplex DecideSimplex(HullPair* hulls, Simplex simplex, int* rounds) {
  while (!Confirms(hulls, &simplex)) {
    simplex = ReduceExactly(*hulls, simplex);
    if (rounds) ++*rounds;
  }
  return simplex;
}

CheckedLanes::CheckedLanes(Points points) {
  RequireRoundToNearest();
  Require(!points.empty(), "the distance of an empty hull is not defined");
  lanes_ = PointLanes(points);
  Require(lanes_.is_finite(), "a coordinate is not finite");
  set_ = {points, &lanes_};
}

ConvexPoints::ConvexPoints(std::vector<Vector3d> points) {
  Require(!points.empty(), "the distance of an empty hull is not defined");
  auto data = std::make_shared<Data>();
  data->lanes = PointLanes(points);
  Require(data->lanes.is_finite(), "a coordinate is not finite");
  data->points = std::move(points);
  data_ = std::move(data);
}

HullDistance SquaredConvexDistance(Points a, Points b) {
  const CheckedLanes p(a), q(b);
  HullPair hulls = PairOf(p.set(), q.set());
  return Decide(&hulls);
}

HullDistance SquaredConvexDistance(const ConvexPoints& a, const ConvexPoints& b) {
  RequireRoundToNearest();
  HullPair hulls = PairOf(a.data().set(), b.data().set());
  return Decide(&hulls);
}

std::optional<HullDistance> TrySquaredConvexDistance(Points a, Points b) {
  const CheckedLanes p(a), q(b);
  HullPair hulls = PairOf(p.set(), q.set());
  if (!hulls.filter) return std::nullopt;
  Simplex simplex = Propose(hulls);
  if (!Confirms(&hulls, &simplex)) return std::nullopt;
  return Answer(hulls, simplex, 0);
}

HullDistance SquaredConvexDistance(std::span<const Vector3q> a, std::span<const Vector3q> b) {
  RequireRoundToNearest();
  Require(!a.empty() && !b.empty(), "the distance of an empty hull is not defined");
  const RationalSpans rational(a, b);
  const std::vector<Vector3d> near_a = TruncatedDoubles(a), near_b = TruncatedDoubles(b);
  const PointLanes lanes_a(near_a), lanes_b(near_b);
  HullPair hulls = PairOf({near_a, &lanes_a}, {near_b, &lanes_b});
  hulls.rational = &rational;
  // Two points within 2 u M (1 + 4 u) (or 2^-1074) of the real ones and a rounded difference:
  // within u (|d| + 4 M (1 + 6 u)), so that 6 M, or 2^-900 if that is more, covers it.
  const double largest = std::max(LargestCoordinate(lanes_a), LargestCoordinate(lanes_b));
  if (hulls.filter) hulls.blur = std::max(0x1p-900, 6 * largest);
  return Decide(&hulls);
}

exact::ConvexDistance ClosestPoints(std::span<const Vector3q> a, std::span<const Vector3q> b,
                                    const HullDistance& distance) {
  Require(distance.size >= 1 && distance.size <= 4, "no answer of SquaredConvexDistance");
  Simplex simplex;
  for (int k = 0; k < distance.size; ++k) {
    simplex.Push({distance.corners[k][0], distance.corners[k][1]});
  }
  const RationalSpans rational(a, b);
  HullPair hulls;
  hulls.rational = &rational;
  const std::array<mpz_class, 4> weights = IntegerWeights(MakeIntegerFace(hulls, simplex));
  mpz_class sum = 0;
  for (const mpz_class& x : weights) sum += x;
  exact::ConvexCombination weights_a, weights_b;
  const auto add = [](exact::ConvexCombination* to, int index, const Rational& weight) {
    const auto known = std::find_if(to->begin(), to->end(),
                                    [index](const auto& entry) { return entry.first == index; });
    if (known == to->end()) {
      to->emplace_back(index, weight);
    } else {
      known->second += weight;
    }
  };
  for (int k = 0; k < distance.size; ++k) {
    if (weights[k] == 0) continue;
    Rational weight(weights[k], sum);
    weight.canonicalize();
    add(&weights_a, distance.corners[k][0], weight);
    add(&weights_b, distance.corners[k][1], weight);
  }
  return exact::internal::Assemble(a, b, std::move(weights_a), std::move(weights_b));
}

}  // namespace cguide::numeric
