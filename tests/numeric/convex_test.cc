#include <catch2/catch.hpp>

#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/convex_internal.h"
#include "cguide/numeric/gjk_internal.h"
#include "cguide/numeric/separation_internal.h"
#include "tests/random_robot.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using test::Between;
using test::RandomPoint;
using test::RandomQuaternion;

struct Owned {
  Convex s;
  std::vector<Vector3d> points;
};

Owned RandomConvex(std::mt19937_64& rng, int kind) {
  Owned owned;
  Convex& s = owned.s;
  const Quaternion q = RandomQuaternion(rng);
  s.R = Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
  s.c = RandomPoint(rng, 1);
  if (kind == 0) s.half = RandomPoint(rng, 0.5).cwiseAbs();
  if (kind == 1) s.radius = Between(rng, 0.1, 0.5);
  if (kind == 2) {
    s.half = {0, 0, Between(rng, 0.1, 0.5)};
    s.radius = Between(rng, 0.1, 0.5);
  }
  if (kind == 3) {
    s.kind = CoreKind::kCylinder;
    const double r = Between(rng, 0.1, 0.5);
    s.half = {r, r, Between(rng, 0.1, 0.5)};
  }
  if (kind == 4) {
    s.kind = CoreKind::kPoints;
    for (int i = 0; i < 12; ++i) owned.points.push_back(RandomPoint(rng, 0.4));
    s.points = owned.points.data();
    s.num_points = 12;
    for (const Vector3d& v : owned.points) s.half = s.half.cwiseMax(v.cwiseAbs());
  }
  s.reach = s.half.norm() + s.radius;
  s.error = PlacementError(0, 0, s.reach, s.c.norm());
  return owned;
}

// A point of the set: a support point pulled towards the middle.
Vector3d RandomMember(std::mt19937_64& rng, const Convex& s) {
  const Vector3d n = RandomPoint(rng, 1).normalized(), m = RandomPoint(rng, 1).normalized();
  const double t = Between(rng, 0, 1);
  return s.c + t * (CoreSupport(s, n) + s.radius * n) +
         (1 - t) * (CoreSupport(s, m) + s.radius * m);
}

TEST_CASE("support points attain the extent, and the box around the core is no smaller") {
  std::mt19937_64 rng(1);
  for (int i = 0; i < 2000; ++i) {
    const Owned owned = RandomConvex(rng, i % 5);
    const Convex& s = owned.s;
    const Vector3d n = RandomPoint(rng, 1).normalized();
    CAPTURE(i);
    REQUIRE(n.dot(CoreSupport(s, n)) == Approx(CoreExtent(s, n)).margin(1e-12));
    REQUIRE(BoxExtent(s, n) >= CoreExtent(s, n) - 1e-12);
    REQUIRE(n.dot(RandomMember(rng, s) - s.c) <= CoreExtent(s, n) + s.radius + 1e-12);
    REQUIRE((RandomMember(rng, s) - s.c).norm() <= s.reach + 1e-12);
  }
}

TEST_CASE("projections lie on the set and no member is nearer") {
  std::mt19937_64 rng(2);
  int outside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Owned owned = RandomConvex(rng, i % 5);
    const Convex& s = owned.s;
    const Vector3d x = s.c + RandomPoint(rng, 1.2);
    const PointProjection p = ProjectPoint(s, x);
    CAPTURE(i, p.distance, p.distance_error, p.y_error);
    if (p.distance <= 0) continue;
    ++outside;
    REQUIRE(p.distance_error < 1e-12);
    REQUIRE(p.y_error < 1e-6);
    REQUIRE((x - p.y - p.distance * p.n).norm() < 1e-12);
    REQUIRE(p.n.norm() == Approx(1).epsilon(1e-12));
    // The supporting plane at y: all of the set is behind it.
    REQUIRE(p.n.dot(s.c - p.y) + CoreExtent(s, p.n) + s.radius < 2e-12);
    for (int k = 0; k < 5; ++k) {
      REQUIRE((x - RandomMember(rng, s)).norm() > p.distance - p.distance_error - 1e-13);
    }
  }
  CHECK(outside > 1000);
}

/** x - y for the closest point y of an axis-parallel set's core, up to a relative 2^-200. */
Vector3q ExactNormal(const Convex& s, const Vector3d& x) {
  const Vector3q l = Lift(x) - Lift(s.c);
  Vector3q w;
  for (int k = 0; k < 3; ++k) {
    const Rational half = Lift(s.half[k]);
    w[k] = l[k] > half ? Rational(l[k] - half) : l[k] < -half ? Rational(l[k] + half) : Rational(0);
  }
  if (s.kind != CoreKind::kCylinder) return w;
  const Rational rho = exact::SqrtUp(Rational(l[0] * l[0] + l[1] * l[1]), 300);
  const Rational out = rho - Lift(s.half[0]);
  for (int k = 0; k < 2; ++k) w[k] = out > 0 ? Rational(l[k] * out / rho) : Rational(0);
  return w;
}

TEST_CASE("the stated error of a normal holds as near to the set as one likes") {
  std::mt19937_64 rng(21);
  int near = 0, mantles = 0, stated = 0;
  for (int i = 0; i < 4000; ++i) {
    Owned owned = RandomConvex(rng, i % 4);
    Convex& s = owned.s;
    s.R.setIdentity();
    const Vector3d n = RandomPoint(rng, 1).normalized();
    const double gap = std::pow(10, Between(rng, -14, 0));
    Vector3d x = s.c + CoreSupport(s, n) + gap * n;
    // Beside the mantle and the faces, not only the corners that supports are.
    if (i % 8 > 3) {
      x[2] = s.c[2] + 0.9 * s.half[2] * Between(rng, -1, 1);
      if (s.kind == CoreKind::kCylinder) {
        x.head<2>() = s.c.head<2>() + (s.half[0] + gap) * n.head<2>().normalized();
      }
    }
    const Vector3q w = ExactNormal(s, x);
    const Rational squared = exact::SquaredNorm(w);
    if (squared == 0) continue;
    const PointProjection p = ProjectPoint(s, x);
    const double bound = NormalBound(p, p.distance_error);
    if (bound < 0) continue;
    ++stated;
    near += gap < 1e-6;
    mantles += s.kind == CoreKind::kCylinder && w[2] == 0;
    const Vector3q unit = exact::Scaled(1 / exact::SqrtUp(squared, 200), w);
    CAPTURE(i, gap, bound);
    REQUIRE(exact::SquaredNorm(Lift(p.n) - unit) <= Lift(bound) * Lift(bound));
  }
  CHECK(stated > 3000);
  CHECK(near > 1000);
  CHECK(mantles > 300);
}

TEST_CASE("what is said to be beyond a reach is, and of boxes it is said but for rounding") {
  std::mt19937_64 rng(12);
  int beyond = 0, within = 0;
  for (int i = 0; i < 20000; ++i) {
    const Owned owned = RandomConvex(rng, i % 5);
    const Vector3d x = RandomPoint(rng, 2);
    const PointProjection p = ProjectPoint(owned.s, x);
    const double offset = std::ldexp(Between(rng, -1, 1), -static_cast<int>(rng() % 60));
    const double reach = p.distance + offset;
    const bool is_beyond = IsBeyond(owned.s, x, reach);
    if (is_beyond) CHECK(p.distance - p.distance_error >= reach);
    if (owned.s.kind == CoreKind::kBox && p.distance > 0 && reach + owned.s.radius > 0 &&
        offset < -4 * p.distance_error) {
      CHECK(is_beyond);
    }
    ++(is_beyond ? beyond : within);
  }
  CHECK(beyond > 1000);
  CHECK(within > 1000);
}

TEST_CASE("inside, the signed distance leads to the boundary and agrees with the depth") {
  std::mt19937_64 rng(3);
  for (int i = 0; i < 2000; ++i) {
    const Owned owned = RandomConvex(rng, i % 4);
    const Convex& s = owned.s;
    const Vector3d x = RandomMember(rng, s);
    const PointProjection p = ProjectPoint(s, x);
    CAPTURE(i, p.distance);
    REQUIRE(p.distance < 1e-12);
    REQUIRE(DepthInside(s, x) == Approx(-p.distance).margin(1e-12));
    REQUIRE(std::abs(DepthInside(s, p.y)) < 1e-12);
    Vector3d y = s.c + RandomPoint(rng, 2);
    const double margin = Between(rng, 0, 0.05);
    if (ClampInto(s, margin, &y)) REQUIRE(DepthInside(s, y) >= margin - 1e-12);
  }
}

TEST_CASE("triangles, slivers among them, are projected on with honest bounds") {
  std::mt19937_64 rng(4);
  for (int i = 0; i < 3000; ++i) {
    Vector3d a = RandomPoint(rng, 1), b = RandomPoint(rng, 1), c = RandomPoint(rng, 1);
    if (i % 3 == 0) c = a + Between(rng, -0.2, 1.2) * (b - a) + RandomPoint(rng, 1e-9);
    if (i % 7 == 0) b = a;
    if (i % 11 == 0) c = a;
    const Vector3d x = i % 5 == 0 ? Vector3d(0.3 * a + 0.3 * b + 0.4 * c) : RandomPoint(rng, 2);
    const PointProjection p = ProjectPoint(a, b, c, 0, x);
    CAPTURE(i);
    REQUIRE(p.distance >= 0);
    REQUIRE(std::abs((x - p.y).norm() - p.distance) < 1e-14);
    for (int k = 0; k < 10; ++k) {
      double u = Between(rng, 0, 1), v = Between(rng, 0, 1);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vector3d z = a + u * (b - a) + v * (c - a);
      REQUIRE((x - z).norm() >= p.distance - p.distance_error);
    }
  }
}

TEST_CASE("directions that separate are certified only where every point is apart") {
  std::mt19937_64 rng(5);
  StageCounts counts;
  int holds = 0, fails = 0;
  for (int i = 0; i < 4000; ++i) {
    const Owned a = RandomConvex(rng, static_cast<int>(rng() % 5));
    Owned b = RandomConvex(rng, static_cast<int>(rng() % 5));
    SeparationHint hint;
    const Verdict verdict = DecideConvex(a.s, b.s, 0, &hint, &counts);
    holds += verdict == Verdict::kHolds;
    fails += verdict == Verdict::kFails;
    CAPTURE(i);
    GjkResult gjk;
    Gjk(a.s, b.s, a.s.c - b.s.c, INFINITY, &gjk);
    const double core = gjk.overlap ? 0 : gjk.v.norm();
    if (verdict == Verdict::kHolds) REQUIRE(core > a.s.radius + b.s.radius);
    if (verdict == Verdict::kFails) REQUIRE(core < a.s.radius + b.s.radius + 1e-9);
    if (verdict != Verdict::kHolds) continue;
    // The hint must still be right for the pair as it stands.
    REQUIRE(hint.code >= 0);
    const Vector3d n = HintDirection(a.s, b.s, hint);
    REQUIRE(Gap(a.s, b.s, n) > 0);
    REQUIRE(n.dot(RandomMember(rng, a.s) - RandomMember(rng, b.s)) > 0);
  }
  CHECK(holds > 500);
  CHECK(fails > 400);
  CHECK(holds + fails == 4000);
  CHECK(counts.boxes > 0);
  CHECK(counts.gjk > 0);
}

TEST_CASE("a translation shorter than the skin decides with a skin") {
  std::mt19937_64 rng(6);
  StageCounts counts;
  for (int i = 0; i < 1000; ++i) {
    // A box on a plate, sunk by `sink`: the way out is up.
    Convex a, b;
    a.half = {0.1, 0.07, 0.05};
    b.half = {1, 1, 0.2};
    const Quaternion q = RandomQuaternion(rng);
    b.R = Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
    const double angle = Between(rng, 0, 3), sink = Between(rng, 1e-6, 0.01), skin = 0.004;
    a.R = b.R * Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
    a.c = b.R * Vector3d(Between(rng, -0.5, 0.5), Between(rng, -0.5, 0.5), 0.25 - sink);
    for (Convex* s : {&a, &b}) {
      s->reach = s->half.norm();
      s->error = PlacementError(0, 0, s->reach, s->c.norm());
    }
    SeparationHint hint;
    CAPTURE(i, sink);
    if (std::abs(sink - skin) < 1e-12) continue;
    REQUIRE(DecideConvex(a, b, skin, &hint, &counts) ==
            (sink < skin ? Verdict::kHolds : Verdict::kFails));
    REQUIRE(DecideConvex(a, b, 0, &hint, &counts) == Verdict::kFails);
  }
}

}  // namespace
}  // namespace cguide::numeric
