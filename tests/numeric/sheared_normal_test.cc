#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/exact/core/rational.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/certified_sides_internal.h"
#include "cguide/numeric/minors_internal.h"
#include "cguide/numeric/sampling.h"
#include "cguide/numeric/sheared_normal_internal.h"

namespace cguide::numeric {
namespace {

template <typename T>
using Vectors = std::array<std::array<T, 3>, 6>;

mpz_class Integer(Int128 v) {
  mpz_class result = static_cast<long>(v >> 64);
  result <<= 64;
  return result + static_cast<unsigned long>(v);
}

/** Of six rows (u, d x u), by the general formula. */
template <typename T>
T Determinant(const Vectors<T>& u, const Vectors<T>& d) {
  T rows[6][6], y[6];
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      rows[i][k] = u[i][k];
      rows[i][3 + k] = d[i][a] * u[i][b] - d[i][b] * u[i][a];
    }
  }
  NormalOfRows<T, T, T>(rows[0], rows[1], rows[2], rows[3], rows[4], y);
  T sum = 0;
  for (int k = 0; k < 6; ++k) sum += y[k] * rows[5][k];
  return sum;
}

Int128 RandomSize(int bits, int kind, Rng& rng) {
  const UInt128 word = UInt128{rng()} << 64 | rng();
  const Int128 x = static_cast<Int128>(word >> (128 - bits));
  if (kind == 0) return rng() % 2 == 0 ? (Int128{1} << bits) - 1 : 1 - (Int128{1} << bits);
  return rng() % 2 == 0 ? x : -x;
}

Fixed Value(const Vectors<Fixed>& u, const Vectors<Fixed>& d, bool three) {
  Triple<Fixed> M[4];
  for (int k = 0; k < 4; ++k) M[k] = CrossOf(d[2 + k], u[2 + k]);
  ShearedNormal<Fixed> normal;
  normal.Set({&u[0], &u[1], &u[2], &u[3], &u[4]}, {&M[0], &M[1], &M[2]}, three);
  return normal.Determinant(u[5], M[3]);
}

}  // namespace

TEST_CASE("the determinant about a shared point, numbers one unit off, is within its bound") {
  Rng rng(1966);
  const mpz_class unit = mpz_class(1) << 1024;
  mpz_class largest = 0;
  for (int round = 0; round < 20000; ++round) {
    const bool three = round % 3 == 0;
    const int kind = round % 2;
    Vectors<Fixed> u{}, d{};
    Vectors<mpz_class> exact_u, exact_d;
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < 3; ++k) {
        const Int128 x = RandomSize(125, kind, rng), a = RandomSize(126, kind, rng);
        u[i][k] = {x};
        exact_u[i][k] = Integer(x) + static_cast<int>(rng() % 3) - 1;
        if (i >= (three ? 3 : 2)) {
          d[i][k] = {a};
          exact_d[i][k] = Integer(a) + static_cast<int>(rng() % 3) - 1;
        }
      }
    }
    const mpz_class error =
        abs(Determinant(exact_u, exact_d) - Integer(Value(u, d, three).v) * unit);
    REQUIRE(error < kShearedError * unit);
    largest = std::max(largest, error);
  }
  CHECK(largest > 3 * unit);  // the bound is not idle
}

namespace {

struct Drawn {
  std::vector<Eigen::Vector3d> u, p;
  std::vector<int> exponent;
  std::vector<std::array<std::int32_t, 2>> group;
};

// Seven forces: three at one point, two at another, one each at two more. Few small numbers, so
// that ties abound; `last` is added to some as a last bit.
Drawn RandomForces(double last, Rng& rng) {
  const auto small = [&] { return std::floor(Uniform(rng) * 5) - 2; };
  const auto value = [&] { return small() / 4 + (rng() % 3 == 0 ? small() * last : 0); };
  Drawn result;
  for (const int size : {3, 2, 1, 1}) {
    const Eigen::Vector3d p(value(), value(), value());
    const int begin = static_cast<int>(result.u.size());
    for (int k = 0; k < size; ++k) {
      result.p.push_back(p);
      Eigen::Vector3d u(value(), value(), value());
      if (u.isZero(0)) u[2] = 1;
      result.u.push_back(u);
      result.exponent.push_back(std::ilogb(u.cwiseAbs().maxCoeff()) + 1);
      result.group.push_back({begin, begin + size});
    }
  }
  return result;
}

int ExactSign(const Drawn& drawn, const std::array<std::int32_t, 5>& rows, int x) {
  Vectors<Rational> u, p;
  for (int i = 0; i < 6; ++i) {
    const int row = i < 5 ? rows[i] : x;
    for (int k = 0; k < 3; ++k) {
      u[i][k] = Lift(drawn.u[row][k]);
      p[i][k] = Lift(drawn.p[row][k]);
    }
  }
  return sgn(Determinant(u, p));
}

/** That the integer normal h of the rows has h.(u, 2^t p x u) of the sign `expected` for force x,
 as it says, and 0 for the rows. */
template <int N>
void RequireNormal(const Drawn& drawn, const FixedForces& all, const ShearedRows& rows, int x,
                   int expected) {
  Wide<8 * N> wide[6];
  REQUIRE(all.ExactNormal<N>(rows, x, wide) == expected);
  Vector3q f, m;
  for (int k = 0; k < 3; ++k) {
    f[k] = ToInteger(wide[k]);
    m[k] = ToInteger(wide[3 + k]);
  }
  const Rational scale = Lift(std::ldexp(1.0, all.MomentShift()));
  const auto side = [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    const Vector3q u = Lift(drawn.u[k]), moment = exact::Cross(Lift(drawn.p[k]), u);
    return sgn(Rational(exact::Dot(f, u) + scale * exact::Dot(m, moment)));
  };
  REQUIRE(side(x) == expected);
  for (const int row : rows.row) REQUIRE(side(row) == 0);
}

}  // namespace

TEST_CASE("signs in integers about a shared point are those of the exact wrenches, ties too") {
  Rng rng(1967);
  int words[3] = {}, zero = 0, certain = 0;
  const std::array<std::array<std::int32_t, 6>, 4> kSets{
      {{0, 1, 2, 3, 5, 6}, {3, 4, 0, 1, 5, 6}, {0, 2, 3, 4, 6, 5}, {1, 2, 5, 6, 3, 4}}};
  for (int round = 0; round < 6000; ++round) {
    const double last = std::ldexp(1.0, std::array<int, 4>{-20, -52, -70, -130}[round % 4]);
    const Drawn drawn = RandomForces(last, rng);
    FixedForces all;
    all.Fill(drawn.u, drawn.exponent, drawn.p, drawn.group);
    ++words[all.Words()];
    for (const auto& set : kSets) {
      const std::array<std::int32_t, 5> rows{set[0], set[1], set[2], set[3], set[4]};
      const int expected = ExactSign(drawn, rows, set[5]);
      const ShearedRows arranged{rows, rows[0] == 0 && rows[2] == 2 ? 3 : 2, false};
      if (all.Words() == 1) REQUIRE(all.ExactSign<1>(arranged, set[5]) == expected);
      if (all.Words() >= 1) REQUIRE(all.ExactSign<2>(arranged, set[5]) == expected);
      if (all.Words() == 1) RequireNormal<1>(drawn, all, arranged, set[5], expected);
      if (all.Words() >= 1) RequireNormal<2>(drawn, all, arranged, set[5], expected);
      zero += expected == 0;
      ShearedNormal<Fixed> normal;
      const auto moment = [&](int i) { return &all.Moment(rows[0], i); };
      normal.Set({&all.force(rows[0]), &all.force(rows[1]), &all.force(rows[2]),
                  &all.force(rows[3]), &all.force(rows[4])},
                 {moment(rows[2]), moment(rows[3]), moment(rows[4])}, rows[2] == 2 && rows[0] == 0);
      const Int128 value = normal.Determinant(all.force(set[5]), *moment(set[5])).v;
      if (value <= kShearedError && value >= -kShearedError) continue;
      ++certain;
      REQUIRE((value > 0 ? 1 : -1) == expected);
    }
  }
  CHECK(words[0] > 100);
  CHECK(words[1] > 1000);
  CHECK(words[2] > 1000);
  CHECK(zero > 1000);
  CHECK(certain > 10000);
}

TEST_CASE("parallelograms are told exactly from those that miss by a last bit") {
  Rng rng(1968);
  for (int round = 0; round < 20000; ++round) {
    // Corners that are exact in doubles, with many sums that are not.
    const auto draw = [&] {
      const auto whole = [&] { return std::floor((Uniform(rng) - 0.5) * 0x1p51); };
      return Eigen::Vector3d(whole(), whole(), whole());
    };
    const Eigen::Vector3d a = draw(), s = draw(), t = draw();
    const Eigen::Vector3d b = a + s, c = a + t, p = a + s + t;
    REQUIRE(MakeParallelogram(p, a, b, c));
    REQUIRE(MakeParallelogram(b, c, p, a));
    Eigen::Vector3d off = p;
    off[rng() % 3] += 1;
    REQUIRE_FALSE(MakeParallelogram(off, a, b, c));
    Eigen::Vector3d fine = a;
    fine[rng() % 3] += std::ldexp(1.0, -1 - static_cast<int>(rng() % 2));
    REQUIRE_FALSE((fine != a && MakeParallelogram(p, fine, b, c)));
  }
}

TEST_CASE("affine combinations of three points are told from points off their plane or line") {
  Rng rng(1974);
  const auto small = [&] { return std::floor(Uniform(rng) * 3) - 1; };
  const auto point = [&] {
    Eigen::Vector3d p(small(), small(), small());
    if (rng() % 4 == 0) p[rng() % 3] += std::ldexp(small(), -50);
    return p;
  };
  int told = 0, trapezoids = 0;
  for (int round = 0; round < 200000; ++round) {
    const Eigen::Vector3d p = point(), a = point(), b = point(), c = point();
    if (!IsAffineCombination(p, a, b, c)) continue;
    ++told;
    trapezoids += AreAlongAnAxis(p, a, b, c) && !MakeParallelogram(p, a, b, c);
    // p - c is in the span of a - c and b - c.
    std::vector<VectorXq> span;
    for (const Eigen::Vector3d& q : {a, b, p}) {
      VectorXq v(3);
      for (int k = 0; k < 3; ++k) v[k] = Lift(q[k]) - Lift(c[k]);
      span.push_back(v);
    }
    const int with = exact::Rank(span);
    span.pop_back();
    REQUIRE(with == exact::Rank(span));
  }
  CHECK(told > 10000);
  CHECK(trapezoids > 1000);
}

}  // namespace cguide::numeric
