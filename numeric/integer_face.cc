#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/difference_face_internal.h"

namespace cguide::numeric {
using Eigen::Vector3d;

namespace {

IntegerPoint Minus(const IntegerPoint& p, const IntegerPoint& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}

// Every finite double is an integer times 2^(e - 53) with e from frexp.
int LowestExponent(const Vector3d& x, int lowest) {
  for (const double c : {x[0], x[1], x[2]}) {
    if (c == 0) continue;
    int e = 0;
    std::frexp(c, &e);
    lowest = std::min(lowest, e - 53);
  }
  return lowest;
}

IntegerPoint Shifted(const Vector3d& x, int exponent) {
  IntegerPoint result;
  for (int k = 0; k < 3; ++k) {
    if (x[k] == 0) continue;
    int e = 0;
    const double mantissa = std::frexp(x[k], &e);
    result[k] = static_cast<long>(std::ldexp(mantissa, 53));
    mpz_mul_2exp(result[k].get_mpz_t(), result[k].get_mpz_t(),
                 static_cast<mp_bitcnt_t>(e - 53 - exponent));
  }
  return result;
}

}  // namespace

IntegerPoint IntegerDifference(const HullPair& hulls, bool of_b, int p, int q) {
  if (hulls.rational) {
    const Vector3q d = hulls.rational->Get(of_b, p) - hulls.rational->Get(of_b, q);
    const mpz_class scale = lcm(lcm(d[0].get_den(), d[1].get_den()), d[2].get_den());
    IntegerPoint result;
    for (int k = 0; k < 3; ++k) result[k] = d[k].get_num() * (scale / d[k].get_den());
    return result;
  }
  const auto& points = of_b ? hulls.b.points : hulls.a.points;
  const int lowest = LowestExponent(points[p], LowestExponent(points[q], 1024));
  return Minus(Shifted(points[p], lowest), Shifted(points[q], lowest));
}

namespace {

void SetCornersFromDoubles(const HullPair& hulls, const Simplex& simplex, IntegerFace* face) {
  int lowest = 1024;
  for (int k = 0; k < simplex.size; ++k) {
    lowest = LowestExponent(hulls.a.points[simplex.corners[k].i], lowest);
    lowest = LowestExponent(hulls.b.points[simplex.corners[k].j], lowest);
  }
  face->exponent = lowest;
  for (int k = 0; k < simplex.size; ++k) {
    const auto& [i, j] = simplex.corners[k];
    face->w[k] = Minus(Shifted(hulls.a.points[i], lowest), Shifted(hulls.b.points[j], lowest));
  }
}

void SetCornersFromRationals(const RationalPoints& points, const Simplex& simplex,
                             IntegerFace* face) {
  std::vector<Vector3q> a, b;
  for (int k = 0; k < simplex.size; ++k) {
    a.push_back(points.Get(false, simplex.corners[k].i));
    b.push_back(points.Get(true, simplex.corners[k].j));
  }
  exact::internal::IntegerSets integers = exact::internal::ToIntegers(a, b);
  face->scale = integers.scale;
  for (int k = 0; k < simplex.size; ++k) face->w[k] = Minus(integers.a[k], integers.b[k]);
}

}  // namespace

IntegerFace MakeIntegerFace(const HullPair& hulls, const Simplex& simplex) {
  IntegerFace face;
  face.size = simplex.size;
  if (hulls.rational) {
    SetCornersFromRationals(*hulls.rational, simplex, &face);
  } else {
    SetCornersFromDoubles(hulls, simplex, &face);
  }
  if (face.size == 4) return face;
  if (face.size == 1) {
    face.n = face.w[0];
    face.height = Dot(face.n, face.n);
    face.divisor = 1;
    return face;
  }
  const IntegerPoint e = Minus(face.w[1], face.w[0]);
  if (face.size == 2) {
    face.n = Cross(e, Cross(face.w[0], e));
    face.height = Dot(face.n, face.w[0]);
    face.divisor = Dot(e, e);
    return face;
  }
  face.n = Cross(e, Minus(face.w[2], face.w[0]));
  face.height = Dot(face.n, face.w[0]);
  face.flipped = face.height < 0;
  if (face.flipped) {
    for (mpz_class& x : face.n) mpz_neg(x.get_mpz_t(), x.get_mpz_t());
  }
  face.height *= face.height;
  face.divisor = Dot(face.n, face.n);
  return face;
}

std::array<mpz_class, 4> IntegerWeights(const IntegerFace& face) {
  const auto& w = face.w;
  if (face.size == 1) return {1, 0, 0, 0};
  if (face.size == 2) {
    const IntegerPoint e = Minus(w[1], w[0]);
    return {Dot(e, w[1]), -Dot(e, w[0]), 0, 0};
  }
  std::array<mpz_class, 4> weights;
  bool negate = face.flipped;
  if (face.size == 3) {
    const IntegerPoint& n = face.n;
    weights = {Dot(n, Cross(w[1], w[2])), Dot(n, Cross(w[2], w[0])), Dot(n, Cross(w[0], w[1])), 0};
  } else {
    const IntegerPoint low = Cross(w[2], w[3]), high = Cross(w[0], w[1]);
    weights = {Dot(w[1], low), -Dot(w[0], low), Dot(w[3], high), -Dot(w[2], high)};
    const mpz_class sum = weights[0] + weights[1] + weights[2] + weights[3];
    if (sum == 0) return {0, 0, 0, 0};
    negate = sum < 0;
  }
  if (negate) {
    for (mpz_class& x : weights) mpz_neg(x.get_mpz_t(), x.get_mpz_t());
  }
  return weights;
}

Rational SquaredDistance(const HullPair& hulls, const Simplex& simplex) {
  return simplex.size == 4 ? Rational(0) : SquaredHeight(MakeIntegerFace(hulls, simplex));
}

// The powers of two go first: gcd and division are then about fewer bits.
Rational SquaredHeight(const IntegerFace& face) {
  if (face.size == 4 || face.height == 0) return 0;
  mpz_class numerator = face.height, denominator = face.divisor;
  long twos = 2 * face.exponent;
  if (face.scale != 1) denominator *= face.scale * face.scale;
  for (const auto& [x, sign] : {std::pair{&numerator, 1L}, std::pair{&denominator, -1L}}) {
    const mp_bitcnt_t low = mpz_scan1(x->get_mpz_t(), 0);
    mpz_tdiv_q_2exp(x->get_mpz_t(), x->get_mpz_t(), low);
    twos += sign * static_cast<long>(low);
  }
  const mpz_class divisor = gcd(numerator, denominator);
  Rational result;
  mpz_divexact(result.get_num_mpz_t(), numerator.get_mpz_t(), divisor.get_mpz_t());
  mpz_divexact(result.get_den_mpz_t(), denominator.get_mpz_t(), divisor.get_mpz_t());
  mpz_class& shifted = twos > 0 ? result.get_num() : result.get_den();
  mpz_mul_2exp(shifted.get_mpz_t(), shifted.get_mpz_t(),
               static_cast<mp_bitcnt_t>(twos > 0 ? twos : -twos));
  return result;
}

namespace {

// Whether the corners of `face` are those wanted: independent, weights > 0, and no corner of the
// simplex on the origin's side (Kuhn-Tucker). `first` is the face's first corner in the simplex;
// the two may be in different units, which changes no sign.
bool IsNearestFace(const IntegerFace& face, const IntegerFace& all, int first) {
  if (face.size < 4 && face.divisor == 0) return false;
  const std::array<mpz_class, 4> weights = IntegerWeights(face);
  for (int k = 0; k < face.size; ++k) {
    if (weights[k] <= 0) return false;
  }
  if (face.size == 4 || face.height == 0) return true;
  const mpz_class level = Dot(face.n, all.w[first]);
  return std::all_of(all.w.begin(), all.w.begin() + all.size,
                     [&](const IntegerPoint& w) { return Dot(face.n, w) >= level; });
}

}  // namespace

Simplex ReduceExactly(const HullPair& hulls, const Simplex& simplex) {
  const IntegerFace all = MakeIntegerFace(hulls, simplex);
  // Faces that hold the last corner come first: the iteration has just added it.
  for (unsigned subset = (1u << simplex.size) - 1; subset > 0; --subset) {
    Simplex part;
    for (int k = 0; k < simplex.size; ++k) {
      if (subset >> k & 1) part.Push(simplex.corners[k]);
    }
    if (IsNearestFace(MakeIntegerFace(hulls, part), all, std::countr_zero(subset))) return part;
  }
  throw Error(Error::Code::kInternal, "a simplex has no point nearest to the origin");
}

}  // namespace cguide::numeric
