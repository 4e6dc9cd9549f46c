#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/numeric/round_cones_internal.h"
#include "tests/numeric/stability_cases.h"
#include "tests/numeric/stored_equilibrium.h"

namespace cguide::numeric {
namespace {

using testing::AsIntegers;
using testing::AsRationals;
using testing::PointContact;
using testing::RandomStance;
using testing::Stance;

Vector3q Rationals(const Integer3& x) {
  Vector3q result;
  for (int k = 0; k < 3; ++k) result[k] = x[k];
  return result;
}

TEST_CASE("Cones and their polars over integers are those over rationals") {
  Rng rng(31);
  int inside = 0, on = 0, outside = 0, polar = 0;
  for (int i = 0; i < 200; ++i) {
    Stance stance = RandomStance(1 + i % 4, rng);
    if (i % 2 == 0) stance.contacts.assign(1, PointContact({0, 0, 0}, {0, 0, 1}, 0.25 * (i % 5)));
    const StabilityQuery query = stance.Query();
    const auto e = AsIntegers(query);
    REQUIRE(e);
    const exact::EquilibriumQuery twin = AsRationals(query);
    for (std::size_t c = 0; c < e->contacts.size(); ++c) {
      const IntegerCone& cone = e->cones[static_cast<std::size_t>(e->contacts[c].cone)];
      Integer3 u;
      for (mpz_class& x : u) x = static_cast<long>(rng() % 9) - 4;
      if (i % 4 == 0) u = {i % 5, 0, 4};  // of slope mu
      const int sign = SignInCone(cone, u);
      const exact::FrictionCone& same = twin.contacts[c].cone;
      CHECK((sign >= 0) == (exact::IsAdmissible(same, Rationals(u)) && u != Integer3{}));
      CHECK(IsNeverDriven(cone, u) == exact::IsNeverDrivenBy(same, Rationals(u)));
      ++(sign > 0 ? inside : sign == 0 ? on : outside);
      polar += IsNeverDriven(cone, u);
    }
  }
  CHECK(inside > 20);
  CHECK(on > 5);
  CHECK(outside > 100);
  CHECK(polar > 20);
}

TEST_CASE("Wrenches in metres see what those over integers see") {
  Rng rng(37);
  int polar = 0;
  for (int i = 0; i < 200; ++i) {
    const Stance kept = RandomStance(1 + i % 2, rng);
    const auto e = AsIntegers(kept.Query());
    REQUIRE(e);
    Integer3 y_f, y_m;
    for (int k = 0; k < 3; ++k) {
      y_f[k] = (static_cast<long>(rng() % 2001) - 1000) * (mpz_class(1) << 55);
      y_m[k] = static_cast<long>(rng() % 2001) - 1000;
    }
    y_f[2] -= 1000 * (mpz_class(1) << 55);
    const bool is_polar = IsPolar(*e, y_f, y_m);
    CHECK(is_polar == exact::ArePolar(AsRationals(kept.Query()), {ToMetres(*e, y_f, y_m)}));
    polar += is_polar;
  }
  CHECK(polar > 10);
  CHECK(polar < 190);
}

TEST_CASE("The rank is the twin's, where contacts have friction") {
  const auto rank = [](std::vector<Contact> contacts) {
    Stance stance;
    stance.contacts = std::move(contacts);
    const auto e = AsIntegers(stance.Query());
    REQUIRE(e);
    const auto found = RankOf(*e);
    if (found) CHECK(*found == exact::WrenchRank(AsRationals(stance.Query())));
    return found;
  };
  const auto at = [](double x, double y, double mu) {
    return PointContact({x, y, 0.1}, {0, 0, 1}, mu);
  };
  CHECK(rank({}) == 0);
  CHECK(rank({at(1, 2, 0.5)}) == 3);
  CHECK(rank({at(1, 2, 0.5), at(1, 2, 0.25)}) == 3);
  CHECK(rank({at(1, 2, 0.5), at(0.1, 0.3, 0.5)}) == 5);
  CHECK(rank({at(1, 1, 0.5), at(2, 2, 0.5), at(2, 2, 0.5), at(0.5, 0.5, 0.5)}) == 5);
  CHECK(rank({at(1, 1, 0.5), at(2, 2, 0.5), at(0.5, 0.5, 0.5), at(0.5, 0.5 + 0x1p-53, 1)}) == 6);
  CHECK(rank({at(1, 1, 0.5), at(2, 2, 0), at(0.5, 0.25, 0.5)}) == std::nullopt);
}

TEST_CASE("What integers cannot hold together is left alone") {
  Stance stance;
  stance.contacts = {PointContact({0, 0, 0}, {0, 0, 1}, 0.5)};
  CHECK(AsIntegers(stance.Query()));
  stance.contacts[0].x_W = {1, 1e-300, 0};
  CHECK_FALSE(AsIntegers(stance.Query()));
  stance.contacts[0].x_W = {1, 0, 0};
  stance.contacts[0].friction = 1e-200;
  CHECK_FALSE(AsIntegers(stance.Query()));
  stance.contacts[0].friction = 0.5;
  stance.contacts[0].n_W = {5e-324, 0, 1};
  CHECK_FALSE(AsIntegers(stance.Query()));
  stance.contacts[0].n_W.setZero();
  CHECK_FALSE(AsIntegers(stance.Query()));
}

TEST_CASE("Doubles of integers are within two units of rounding") {
  long exponent = 0;
  CHECK(ToDoubles({0, 0, 0}, &exponent).isZero(0));
  const Eigen::Vector3d x = ToDoubles({mpz_class(3) << 200, -1, mpz_class(1) << 199}, &exponent);
  CHECK(exponent == 202);
  CHECK(x == Eigen::Vector3d(0.75, -std::ldexp(1.0, -202), 0.125));
}

}  // namespace
}  // namespace cguide::numeric
