#include "cguide/numeric/convex_distance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/difference_face_internal.h"
#include "cguide/numeric/fp_guard.h"
#include "cguide/numeric/gjk_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using Points = std::span<const Vector3d>;

double LargestCoordinate(Points points) {
  double largest = 0;
  bool finite = true;
  for (const Vector3d& p : points) {
    for (const double x : {p[0], p[1], p[2]}) {
      finite &= std::abs(x) <= std::numeric_limits<double>::max();
      largest = std::max(largest, std::abs(x));
    }
  }
  Require(finite, "a coordinate is not finite");
  return largest;
}

// Checks the input; the largest magnitude of its coordinates.
double Checked(Points a, Points b) {
  RequireRoundToNearest();
  Require(!a.empty() && !b.empty(), "the distance of an empty hull is not defined");
  return std::max(LargestCoordinate(a), LargestCoordinate(b));
}

Simplex Propose(const HullPair& hulls) {
  Simplex simplex;
  if (hulls.filter) {
    GjkResult gjk;
    Gjk(hulls.a, hulls.b, hulls.a[0] - hulls.b[0], INFINITY, &gjk);
    for (int k = 0; k < gjk.size; ++k) simplex.Push({gjk.simplex[k].i, gjk.simplex[k].j});
  }
  if (simplex.size == 0) simplex.Push({0, 0});
  return simplex;
}

HullDistance Answer(const HullPair& hulls, const Simplex& simplex, Face* face, int rounds) {
  HullDistance result;
  result.squared = face->MeetsOrigin() ? Rational(0) : face->Squared();
  result.size = simplex.size;
  for (int k = 0; k < simplex.size; ++k) {
    result.corners[k] = {simplex.corners[k].i, simplex.corners[k].j};
  }
  result.exact_signs = hulls.exact_signs;
  result.rounds = rounds;
  return result;
}

// Confirms the simplex, or reports what to go on with: itself where it does not hold its nearest
// point, else itself with a corner nearer to the origin.
std::optional<HullDistance> Confirm(HullPair* hulls, int rounds, Simplex* simplex) {
  Face face(hulls, *simplex);
  if (!face.HoldsNearest()) return std::nullopt;
  if (!face.MeetsOrigin()) {
    if (const std::optional<Corner> corner = face.Violator()) {
      simplex->Push(*corner);
      return std::nullopt;
    }
  }
  return Answer(*hulls, *simplex, &face, rounds);
}

// Each round ends with the point of a simplex nearest to the origin, strictly nearer than that of
// the round before (after the first round): there are finitely many simplices, so it ends.
HullDistance Decide(HullPair* hulls) {
  Simplex simplex = Propose(*hulls);
  for (int rounds = 0;; ++rounds) {
    if (std::optional<HullDistance> result = Confirm(hulls, rounds, &simplex)) return *result;
    simplex = ReduceExactly(*hulls, simplex);
  }
}

HullPair MakePair(Points a, Points b) {
  HullPair hulls;
  hulls.filter = Checked(a, b) <= kLargest;
  hulls.a = a;
  hulls.b = b;
  return hulls;
}

std::vector<Vector3d> NearestDoubles(std::span<const Vector3q> points) {
  std::vector<Vector3d> result;
  result.reserve(points.size());
  for (const Vector3q& p : points) {
    result.emplace_back(NearestDouble(p[0]), NearestDouble(p[1]), NearestDouble(p[2]));
  }
  return result;
}

bool WithinFilter(Points points) {
  return std::all_of(points.begin(), points.end(),
                     [](const Vector3d& p) { return p.cwiseAbs().maxCoeff() <= kLargest; });
}

}  // namespace

HullDistance SquaredConvexDistance(Points a, Points b) {
  HullPair hulls = MakePair(a, b);
  return Decide(&hulls);
}

std::optional<HullDistance> TrySquaredConvexDistance(Points a, Points b) {
  HullPair hulls = MakePair(a, b);
  if (!hulls.filter) return std::nullopt;
  Simplex simplex = Propose(hulls);
  return Confirm(&hulls, 0, &simplex);
}

HullDistance SquaredConvexDistance(std::span<const Vector3q> a, std::span<const Vector3q> b) {
  RequireRoundToNearest();
  Require(!a.empty() && !b.empty(), "the distance of an empty hull is not defined");
  const exact::internal::IntegerSets integers = exact::internal::ToIntegers(a, b);
  const std::vector<Vector3d> near_a = NearestDoubles(a), near_b = NearestDoubles(b);
  HullPair hulls;
  hulls.a = near_a;
  hulls.b = near_b;
  hulls.integers = &integers;
  hulls.filter = WithinFilter(near_a) && WithinFilter(near_b);
  if (hulls.filter) {
    // Two points within u M (1 + u) (or 2^-1075) of the real ones and a rounded difference: within
    // u (|d| + 2 M (1 + 3 u)), so that 3 M, or 2^-900 if that is more, covers it.
    hulls.blur = std::max(0x1p-900, 3 * Checked(near_a, near_b));
  }
  return Decide(&hulls);
}

exact::ConvexDistance ClosestPoints(std::span<const Vector3q> a, std::span<const Vector3q> b,
                                    const HullDistance& distance) {
  Require(distance.size >= 1 && distance.size <= 4, "no answer of SquaredConvexDistance");
  std::vector<Vector3q> corners_a, corners_b;
  Simplex simplex;
  for (int k = 0; k < distance.size; ++k) {
    corners_a.push_back(a[distance.corners[k][0]]);
    corners_b.push_back(b[distance.corners[k][1]]);
    simplex.Push({k, k});
  }
  const exact::internal::IntegerSets integers = exact::internal::ToIntegers(corners_a, corners_b);
  HullPair hulls;
  hulls.integers = &integers;
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
