// Which contacts a wrench drives, by doubles first, against the integers alone.
#include <catch2/catch.hpp>

#include "cguide/numeric/round_simplex_internal.h"
#include "tests/numeric/stability_cases.h"
#include "tests/numeric/stored_equilibrium.h"

namespace cguide::numeric {
namespace {

using testing::AsIntegers;
using testing::RandomStance;
using testing::Stance;

bool Drives(const IntegerEquilibrium& e, int contact, const Integer3& y_f, const Integer3& y_m) {
  const IntegerEquilibrium::Contact& c = e.contacts[static_cast<std::size_t>(contact)];
  Integer3 g = Cross(y_m, c.arm);
  for (int k = 0; k < 3; ++k) g[k] += y_f[k];
  return !IsNeverDriven(e.cones[static_cast<std::size_t>(c.cone)], g);
}

/** A wrench of integers that has g = w_0 - mu t at contact 0 up to 2^-bits: at the edge of being
 driven; with a moment about the contact, so that others see something else. */
void SetNearEdge(const IntegerEquilibrium& e, int bits, Rng& rng, Integer3* y_f, Integer3* y_m) {
  const IntegerCone& cone = e.cones[0];
  Eigen::Vector3d t(Normal(rng), Normal(rng), Normal(rng));
  t = (t - t.dot(cone.n) * cone.n).normalized();
  const Eigen::Vector3d g = t - cone.mu * cone.n;
  const unsigned more = static_cast<unsigned>(std::max(-e.unit, 0));
  for (int k = 0; k < 3; ++k) {
    (*y_m)[k] = CutToInteger(3 * Normal(rng), bits);
    (*y_f)[k] = CutToInteger(g[k], bits);
    (*y_f)[k] <<= more;
  }
  const Integer3 seen = Cross(*y_m, e.contacts[0].arm);
  for (int k = 0; k < 3; ++k) (*y_f)[k] -= seen[k];
}

TEST_CASE("What doubles call far from driven is not driven; the worst contact is, or none is") {
  Rng rng(47);
  int far = 0, driven = 0, polar = 0;
  for (int i = 0; i < 2000; ++i) {
    const Stance stance = RandomStance(1 + i % 3, rng);
    const auto e = AsIntegers(stance.Query());
    REQUIRE(e);
    Integer3 y_f, y_m;
    SetNearEdge(*e, 10 + i % 100, rng, &y_f, &y_m);
    if (i % 13 == 0) y_m = {};
    if (i % 17 == 0) {
      for (int k = 0; k < 3; ++k) y_f[k] = -e->f[k], y_m[k] = 0;
    }
    const DrivenFilter filter(*e, y_f, y_m);
    bool any = false;
    for (int c = 0; c < static_cast<int>(e->contacts.size()); ++c) {
      const bool drives = Drives(*e, c, y_f, y_m);
      any |= drives;
      if (filter.IsFarFromDriven(c)) {
        ++far;
        CHECK_FALSE(drives);
      }
    }
    CHECK(IsPolar(*e, y_f, y_m) == !any);
    const DrivenContact worst = FindDriven(*e, y_f, y_m);
    CHECK((worst.contact >= 0) == any);
    if (worst.contact >= 0) CHECK(Drives(*e, worst.contact, y_f, y_m));
    driven += any;
    polar += !any;
  }
  CHECK(far > 1000);
  CHECK(driven > 500);
  CHECK(polar > 50);
}

TEST_CASE("Zero drives nothing and is far from nothing") {
  Rng rng(53);
  const auto e = AsIntegers(RandomStance(2, rng).Query());
  REQUIRE(e);
  const Integer3 zero{};
  CHECK_FALSE(DrivenFilter(*e, zero, zero).IsFarFromDriven(0));
  CHECK(FindDriven(*e, zero, zero).contact < 0);
}

TEST_CASE("A shift into room separates, and leaves y alone where there is none") {
  Stance stance = testing::Foot();
  stance.com = {0.125 + 0x1p-40, 0, 0.5};  // beyond the edge x = 0.125
  const auto e = AsIntegers(stance.Query());
  REQUIRE(e);
  SimplexEnd end;
  end.length = 1;
  // About the edge: the force is seen at arm x <= 0, so y = (0, 0, a x0) + torque about y.
  Integer3 y_f{}, y_m{};
  y_m[1] = mpz_class(1) << 60;
  const Integer3& r = e->contacts.back().arm;
  const Integer3 seen = Cross(y_m, r);
  for (int k = 0; k < 3; ++k) y_f[k] = -seen[k];
  if (Dot(y_f, e->f) < 0) {
    for (int k = 0; k < 3; ++k) y_f[k] = -y_f[k], y_m[k] = -y_m[k];
  }
  REQUIRE(Dot(y_f, e->f) > 0);
  REQUIRE(IsPolar(*e, y_f, y_m));
  y_f[1] = 1;  // driven by the least bit
  REQUIRE_FALSE(IsPolar(*e, y_f, y_m));
  const Integer3 f = y_f, m = y_m;
  CHECK_FALSE(ShiftIntoRoom(*e, end, &y_f, &y_m));
  end.has_room = true;
  end.room = Vector6d::Zero();
  end.room[2] = 1;  // up: drives every contact
  CHECK_FALSE(ShiftIntoRoom(*e, end, &y_f, &y_m));
  CHECK(y_f == f);
  CHECK(y_m == m);
  end.room[2] = -1;  // down: no contact can push so
  REQUIRE(ShiftIntoRoom(*e, end, &y_f, &y_m));
  CHECK(Dot(y_f, e->f) > 0);
  CHECK(IsPolar(*e, y_f, y_m));
}

}  // namespace
}  // namespace cguide::numeric
