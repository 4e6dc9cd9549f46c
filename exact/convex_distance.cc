#include "cguide/exact/convex_distance.h"

#include <algorithm>
#include <array>
#include <optional>

#include "cguide/exact/core/error.h"
#include "cguide/exact/distance_internal.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace internal {

IntegerSets ToIntegers(std::span<const Vector3q> a, std::span<const Vector3q> b) {
  IntegerSets sets;
  sets.scale = 1;
  for (const auto& set : {a, b}) {
    for (const Vector3q& p : set) {
      for (const Rational& x : p) {
        mpz_lcm(sets.scale.get_mpz_t(), sets.scale.get_mpz_t(), x.get_den_mpz_t());
      }
    }
  }
  const auto scaled = [&](const Vector3q& p) {
    IntegerPoint result;
    for (int k = 0; k < 3; ++k) {
      mpz_divexact(result[k].get_mpz_t(), sets.scale.get_mpz_t(), p[k].get_den_mpz_t());
      result[k] *= p[k].get_num();
    }
    return result;
  };
  for (const Vector3q& p : a) sets.a.push_back(scaled(p));
  for (const Vector3q& p : b) sets.b.push_back(scaled(p));
  return sets;
}

ConvexDistance Assemble(std::span<const Vector3q> a, std::span<const Vector3q> b,
                        ConvexCombination weights_a, ConvexCombination weights_b) {
  ConvexDistance result;
  result.a = result.b = Vector3q::Zero();
  for (const auto& [i, weight] : weights_a) result.a += Scaled(weight, a[i]);
  for (const auto& [i, weight] : weights_b) result.b += Scaled(weight, b[i]);
  result.squared = SquaredNorm(result.a - result.b);
  result.weights_a = std::move(weights_a);
  result.weights_b = std::move(weights_b);
  return result;
}

}  // namespace internal

namespace {

using internal::IntegerPoint;

mpz_class Dot(const IntegerPoint& p, const IntegerPoint& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

/** A vertex a_i - b_j of the difference body. */
struct Corner {
  int i = 0;
  int j = 0;
  IntegerPoint w;
};

/** weights / denominator, and the point v / denominator they give; denominator > 0. */
struct Nearest {
  std::vector<mpz_class> weights;
  mpz_class denominator;
  IntegerPoint v;
};

/** Determinant of the leading n x n part, n <= 3. */
mpz_class Determinant(const std::array<std::array<mpz_class, 3>, 3>& m, int n) {
  if (n == 0) return 1;
  if (n == 1) return m[0][0];
  if (n == 2) return m[0][0] * m[1][1] - m[0][1] * m[1][0];
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/** The point of the affine hull of `corners` nearest to the origin, where its weights are positive.
 With e_k = w_k - w_0 the weights of k >= 1 solve G x = -(e_k . w_0), G_kl = e_k . e_l, here by
 Cramer's rule: det G > 0 because the corners are affinely independent. */
std::optional<Nearest> NearestInside(const std::vector<const Corner*>& corners) {
  const int n = static_cast<int>(corners.size()) - 1;
  std::array<IntegerPoint, 3> e;
  std::array<std::array<mpz_class, 3>, 3> gram;
  std::array<mpz_class, 3> rhs;
  for (int k = 0; k < n; ++k) {
    for (int c = 0; c < 3; ++c) e[k][c] = corners[k + 1]->w[c] - corners[0]->w[c];
    for (int l = 0; l <= k; ++l) gram[k][l] = gram[l][k] = Dot(e[k], e[l]);
    rhs[k] = -Dot(e[k], corners[0]->w);
  }
  Nearest result;
  result.denominator = Determinant(gram, n);
  result.weights.resize(n + 1);
  result.weights[0] = result.denominator;
  for (int k = 0; k < n; ++k) {
    auto replaced = gram;
    for (int l = 0; l < n; ++l) replaced[l][k] = rhs[l];
    result.weights[k + 1] = Determinant(replaced, n);
    if (result.weights[k + 1] <= 0) return std::nullopt;
    result.weights[0] -= result.weights[k + 1];
  }
  if (result.weights[0] <= 0) return std::nullopt;
  for (int k = 0; k <= n; ++k) {
    for (int c = 0; c < 3; ++c) result.v[c] += result.weights[k] * corners[k]->w[c];
  }
  return result;
}

/** Replaces `simplex` (affinely independent, at most 4 corners) by its face whose relative interior
 holds the point nearest to the origin, and returns that point. A face is right iff its nearest
 point v has positive weights and every corner satisfies v.w >= v.v (Kuhn-Tucker). */
Nearest Reduce(std::vector<Corner>* simplex) {
  const unsigned all = 1u << simplex->size();
  for (unsigned subset = all - 1; subset > 0; --subset) {
    std::vector<const Corner*> face;
    for (std::size_t k = 0; k < simplex->size(); ++k) {
      if (subset >> k & 1) face.push_back(&(*simplex)[k]);
    }
    const std::optional<Nearest> nearest = NearestInside(face);
    if (!nearest) continue;
    const mpz_class vv = Dot(nearest->v, nearest->v);
    const bool optimal = std::all_of(simplex->begin(), simplex->end(), [&](const Corner& c) {
      return Dot(nearest->v, c.w) * nearest->denominator >= vv;
    });
    if (!optimal) continue;
    std::vector<Corner> kept;
    for (const Corner* c : face) kept.push_back(*c);
    *simplex = std::move(kept);
    return *nearest;
  }
  throw Error(Error::Code::kInternal, "a simplex has no point nearest to the origin");
}

/** Index of the point farthest along `sign` v. */
int Support(const std::vector<IntegerPoint>& points, const IntegerPoint& v, int sign) {
  int best = 0;
  mpz_class value = Dot(points[0], v), candidate;
  for (std::size_t i = 1; i < points.size(); ++i) {
    candidate = Dot(points[i], v);
    if (sign * cmp(candidate, value) > 0) {
      best = static_cast<int>(i);
      std::swap(value, candidate);
    }
  }
  return best;
}

Corner Difference(const internal::IntegerSets& sets, int i, int j) {
  Corner corner{i, j, {}};
  for (int k = 0; k < 3; ++k) corner.w[k] = sets.a[i][k] - sets.b[j][k];
  return corner;
}

/** Divides out the common factor of v: only its direction matters to the next support. */
IntegerPoint Direction(IntegerPoint v) {
  mpz_class divisor = gcd(gcd(v[0], v[1]), v[2]);
  for (mpz_class& x : v) mpz_divexact(x.get_mpz_t(), x.get_mpz_t(), divisor.get_mpz_t());
  return v;
}

ConvexCombination Weights(const std::vector<Corner>& simplex, const Nearest& nearest,
                          int Corner::*side) {
  ConvexCombination result;
  for (std::size_t k = 0; k < simplex.size(); ++k) {
    Rational weight(nearest.weights[k], nearest.denominator);
    weight.canonicalize();
    const int index = simplex[k].*side;
    const auto known = std::find_if(result.begin(), result.end(),
                                    [&](const auto& entry) { return entry.first == index; });
    if (known == result.end()) {
      result.emplace_back(index, weight);
    } else {
      known->second += weight;
    }
  }
  return result;
}

}  // namespace

ConvexDistance SquaredConvexDistance(std::span<const Vector3q> a, std::span<const Vector3q> b) {
  Require(!a.empty() && !b.empty(), "the distance of an empty hull is not defined");
  const internal::IntegerSets sets = internal::ToIntegers(a, b);
  std::vector<Corner> simplex{Difference(sets, 0, 0)};
  while (true) {
    const Nearest nearest = Reduce(&simplex);
    const IntegerPoint& v = nearest.v;
    const bool meet = v[0] == 0 && v[1] == 0 && v[2] == 0;
    if (!meet) {
      const IntegerPoint direction = Direction(v);
      const Corner next =
          Difference(sets, Support(sets.a, direction, -1), Support(sets.b, direction, 1));
      // v/D is nearest of all iff v.w D >= v.v for the least v.w. Otherwise w lies strictly on the
      // origin's side of the plane through the face, so the larger simplex is not degenerate.
      if (Dot(v, next.w) * nearest.denominator < Dot(v, v)) {
        simplex.push_back(next);
        continue;
      }
    }
    return internal::Assemble(a, b, Weights(simplex, nearest, &Corner::i),
                              Weights(simplex, nearest, &Corner::j));
  }
}

namespace {

bool IsCombination(std::span<const Vector3q> points, const ConvexCombination& weights,
                   const Vector3q& value) {
  Rational total = 0;
  Vector3q sum = Vector3q::Zero();
  for (const auto& [i, weight] : weights) {
    if (i < 0 || i >= static_cast<int>(points.size()) || weight <= 0) return false;
    total += weight;
    sum += Scaled(weight, points[i]);
  }
  return total == 1 && sum == value;
}

}  // namespace

bool CheckConvexDistance(std::span<const Vector3q> a, std::span<const Vector3q> b,
                         const ConvexDistance& result) {
  if (!IsCombination(a, result.weights_a, result.a)) return false;
  if (!IsCombination(b, result.weights_b, result.b)) return false;
  const Vector3q v = result.a - result.b;
  if (SquaredNorm(v) != result.squared) return false;
  // min v.a_i = v.a and max v.b_j = v.b give the separation v.(a - b) = v.v; and conversely.
  const Rational low = Dot(v, result.a), high = Dot(v, result.b);
  return std::all_of(a.begin(), a.end(), [&](const Vector3q& p) { return Dot(v, p) >= low; }) &&
         std::all_of(b.begin(), b.end(), [&](const Vector3q& p) { return Dot(v, p) <= high; });
}

Sign CompareDistance(const RoundedHull& a, const RoundedHull& b, const Rational& threshold) {
  const Rational reach = a.radius + b.radius + threshold;
  if (reach < 0) return Sign::kPositive;
  return SignOf(Rational(SquaredConvexDistance(a.points, b.points).squared - reach * reach));
}

}  // namespace cguide::exact
