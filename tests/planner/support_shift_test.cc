#include "cguide/planner/support_shift.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>

#include "cguide/numeric/sampling.h"

namespace cguide::planner {
namespace {

using Eigen::Vector3d;
using numeric::Contact;

const Vector3d kGravity(0, 0, -9.81);

Contact At(const Vector3d& x, const Vector3d& n = Vector3d::UnitZ()) {
  Contact contact;
  contact.x_W = contact.y_W = x;
  contact.n_W = n;
  contact.friction = 0.6;
  return contact;
}

std::optional<Support> Ask(const std::vector<Contact>& contacts, const Vector3d& com) {
  numeric::StabilityQuery query;
  query.mass = 50;
  query.gravity_W = kGravity;
  query.com_W = com;
  query.contacts = contacts;
  return NearestSupport(numeric::WrenchGenerators(query, numeric::Pyramid::kInscribed), kGravity);
}

std::vector<Contact> Sole() {
  return {At({-0.1, -0.05, 0}), At({-0.1, 0.05, 0}), At({0.1, -0.05, 0}), At({0.1, 0.05, 0})};
}

TEST_CASE("over the sole nothing has to move") {
  for (const Vector3d& com : {Vector3d(0, 0, 0.8), Vector3d(0.09, -0.04, 0.8)}) {
    const auto support = Ask(Sole(), com);
    REQUIRE(support);
    CHECK(support->shift.norm() < 1e-9);
  }
}

TEST_CASE("from anywhere else the way is the shortest to the sole") {
  numeric::Rng rng(5);
  for (int i = 0; i < 500; ++i) {
    const Vector3d com(numeric::Uniform(rng) - 0.5, numeric::Uniform(rng) - 0.5, 0.8);
    const Vector3d nearest(std::clamp(com.x(), -0.1, 0.1), std::clamp(com.y(), -0.05, 0.05), 0.8);
    const auto support = Ask(Sole(), com);
    REQUIRE(support);
    // The weight of the hard rows, 30, lets them miss by some thousandths of the shift.
    CHECK((com + support->shift - nearest).norm() < 0.01 * (nearest - com).norm() + 1e-9);
  }
}

TEST_CASE("beside an edge of the sole its ends bear the load") {
  const auto support = Ask(Sole(), {0.02, 0.2, 0.8});
  REQUIRE(support);
  REQUIRE(support->loads.size() == 16);
  const auto load = [&](int contact) {
    return std::accumulate(support->loads.begin() + 4 * contact,
                           support->loads.begin() + 4 * contact + 4, 0.0);
  };
  CHECK(load(0) + load(2) < 0.01);
  CHECK(load(1) == Approx(0.4).epsilon(0.02));
  CHECK(load(3) == Approx(0.6).epsilon(0.02));
}

TEST_CASE("no contact, a wall alone, or a ceiling are no support") {
  CHECK_FALSE(Ask({}, {0, 0, 0.8}));
  CHECK_FALSE(Ask({At({0.3, 0, 0.8}, -Vector3d::UnitX())}, {0, 0, 0.8}));
  CHECK_FALSE(Ask({At({0, 0, 1.5}, -Vector3d::UnitZ())}, {0, 0, 0.8}));
}

TEST_CASE("two walls that face each other carry what stands between them") {
  // Friction 0.6 on both sides: pressed at the same height they bear the weight in the middle.
  const auto support =
      Ask({At({-0.3, 0, 0.8}, Vector3d::UnitX()), At({0.3, 0, 0.8}, -Vector3d::UnitX())},
          {0.05, 0.1, 0.8});
  REQUIRE(support);
  CHECK(std::abs(support->shift.x()) < 0.005);
  CHECK(support->shift.y() == Approx(-0.1).epsilon(0.02));
}

}  // namespace
}  // namespace cguide::planner
