#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "cguide/numeric/round_simplex_internal.h"
#include "tests/numeric/stability_cases.h"
#include "tests/numeric/stored_equilibrium.h"

namespace cguide::numeric {
namespace {

using testing::AsIntegers;
using testing::PointContact;
using testing::RandomStance;
using testing::Stance;

const IntegerCone& ConeOf(const IntegerEquilibrium& e, int contact) {
  return e.cones[static_cast<std::size_t>(e.contacts[static_cast<std::size_t>(contact)].cone)];
}

void CheckWrench(const IntegerEquilibrium& e, const Column& c) {
  const Integer3 moment = Cross(e.contacts[static_cast<std::size_t>(c.contact)].arm, c.u);
  for (int k = 0; k < 3; ++k) {
    CHECK(c.wrench.a[k] == c.u[k]);
    CHECK(c.wrench.a[k + 3] == moment[k]);
  }
}

Eigen::Vector3d Direction(const Integer3& u) {
  return Eigen::Vector3d(u[0].get_d(), u[1].get_d(), u[2].get_d()).normalized();
}

TEST_CASE("Columns of any generator are admissible, near it where it is") {
  Rng rng(41);
  for (int i = 0; i < 200; ++i) {
    const Stance stance = RandomStance(1 + i % 3, rng);
    const auto e = AsIntegers(stance.Query());
    REQUIRE(e);
    for (int contact = 0; contact < static_cast<int>(e->contacts.size()); ++contact) {
      const IntegerCone& cone = ConeOf(*e, contact);
      Eigen::Vector3d t(Normal(rng), Normal(rng), Normal(rng));
      t = (t - t.dot(cone.n) * cone.n).normalized();
      // Inside, at the edge, outside by rounding and by far.
      for (const double share : {0.5, 1 - 0x1p-46, 1.0, 1 + 0x1p-50, 3.0}) {
        Generator generator;
        generator.contact = contact;
        generator.u = cone.n + share * cone.mu * t;
        Column column;
        REQUIRE(SetColumn(*e, generator, &column));
        CHECK(column.contact == contact);
        CHECK(SignInCone(cone, column.u) >= 0);
        CheckWrench(*e, column);
        const Eigen::Vector3d wanted = (cone.n + std::min(share, 1.0) * cone.mu * t).normalized();
        CHECK((Direction(column.u) - wanted).norm() < 1e-12);
      }
    }
  }
}

TEST_CASE("Extreme columns are within 2^-70 of the boundary") {
  Rng rng(43);
  for (int i = 0; i < 200; ++i) {
    const Stance stance = RandomStance(1, rng);
    const auto e = AsIntegers(stance.Query());
    REQUIRE(e);
    const IntegerCone& cone = ConeOf(*e, 0);
    Column column;
    SetExtremeColumn(*e, 0, {Normal(rng), Normal(rng), Normal(rng)}, &column);
    CHECK(SignInCone(cone, column.u) >= 0);
    CheckWrench(*e, column);
    // s^2 (1 + mu^2) - |u|^2 ww over |u|^2 ww
    const mpz_class s = Dot(column.u, cone.w),
                    needed = Dot(column.u, column.u) * cone.ww * cone.den;
    CHECK(((s * s * cone.sum - needed) << 70) < needed);
  }
}

TEST_CASE("Without friction, and across nothing, the normal is left") {
  Stance stance;
  stance.contacts = {PointContact({0, 0, 0}, {0, 0, 1}, 0),
                     PointContact({1, 0, 0}, {0, 0, 1}, 0.5)};
  stance.com = {0, 0, 1};
  const auto e = AsIntegers(stance.Query());
  REQUIRE(e);
  Generator generator;
  Column column;
  CHECK_FALSE(SetColumn(*e, generator, &column));  // an artificial one
  generator.contact = 0;
  generator.u = {1, 0, 1};
  REQUIRE(SetColumn(*e, generator, &column));
  CHECK(column.u == ConeOf(*e, 0).w);
  SetExtremeColumn(*e, 1, Eigen::Vector3d::Zero(), &column);
  CHECK(column.u == ConeOf(*e, 1).w);
}

TEST_CASE("Doubles are cut towards zero, and dropped where they are too large") {
  CHECK(CutToInteger(0.75, 1) == 1);
  CHECK(CutToInteger(-0.75, 1) == -1);
  CHECK(CutToInteger(1, 60) == mpz_class(1) << 60);
  CHECK(CutToInteger(-5, 60) == -(mpz_class(5) << 60));
  CHECK(CutToInteger(0x1.8p50, 60) == mpz_class(3) << 109);
  CHECK(CutToInteger(0x1p61, 60) == 0);
  CHECK(CutToInteger(std::numeric_limits<double>::infinity(), 60) == 0);
  CHECK(CutToInteger(std::nan(""), 60) == 0);
}

}  // namespace
}  // namespace cguide::numeric
