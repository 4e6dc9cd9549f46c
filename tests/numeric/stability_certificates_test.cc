#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <new>

#include "cguide/numeric/stability_contacts_internal.h"
#include "cguide/numeric/stability_memory.h"
#include "tests/numeric/stability_cases.h"

namespace {
std::atomic<long> allocations = 0;
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}
// Without it the sanitizers' own version would hand out what the operators below free.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size ? size : 1);
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace cguide::numeric {
namespace {

using testing::AddPatch;
using testing::PointContact;
using testing::RandomStance;
using testing::Stance;

Stance Foot(double normal_error) {
  Stance stance;
  AddPatch({0, 0, 0}, {0, 0, 1}, 0, 0.5, 0.125, 0.0625, &stance);
  for (Contact& c : stance.contacts) c.normal_error = normal_error;
  stance.com = {0, 0, 0.5};
  return stance;
}

// The simplex's own balance of the foot, its forces moved to the friction mu: refinement makes up
// for that.
Balance FootBalance(const ScaledContacts& c, double mu) {
  Balance balance;
  Vector6d y;
  int pivots = 0;
  REQUIRE(SolveStability(c, c.count, &balance, &y, &pivots) == Proposal::kInterior);
  const auto move = [&](Generator* generator) {
    const Eigen::Vector3d n = c.normal(generator->contact), t = generator->u - n;
    if (t.norm() > 0) generator->u = n + mu / t.norm() * t;
    generator->wrench << generator->u, c.arm(generator->contact).cross(generator->u);
  };
  Matrix6d B;
  for (int k = 0; k < 6; ++k) {
    move(&balance.base[k]);
    B.col(k) = balance.base[k].wrench;
  }
  for (int k = 0; k < balance.num_extra; ++k) move(&balance.extra[k]);
  balance.base_inverse = B.inverse();
  return balance;
}

ScaledContacts Scale(const Stance& stance) {
  ScaledContacts scaled;
  REQUIRE(ScaleContacts(stance.Query(), &scaled));
  return scaled;
}

TEST_CASE("a force at the very edge of the friction cone needs a normal without error") {
  for (const double eta : {0.0, 1e-9, 1e-3}) {
    const ScaledContacts c = Scale(Foot(eta));
    const double inner = 0.5 - 2.8 * (eta + 0x1p-46);  // (1 + mu^2)^(3/2)/mu = 2.795
    const double outer = 0.5 - 2.7 * eta + 0x1p-46;
    Balance balance = FootBalance(c, inner);
    CHECK(ProveInterior(c, &balance));
    balance = FootBalance(c, outer);
    CHECK_FALSE(ProveInterior(c, &balance));
  }
}

TEST_CASE("a poor inverse is noticed") {
  const ScaledContacts c = Scale(Foot(0));
  for (const auto& [factor, expected] : {std::pair(1.0, true),
                                         {0.3, true},
                                         {1.9, true},
                                         {2.1, false},
                                         {-1.0, false},
                                         {0.0, false}}) {
    Balance balance = FootBalance(c, 0.49);
    REQUIRE(ProveInterior(c, &balance));  // now refined: the residual is rounding
    balance.base_inverse *= factor;
    CAPTURE(factor);
    CHECK(ProveInterior(c, &balance) == expected);
  }
}

TEST_CASE("the residual may not exceed what the inverse's quality leaves of the least weight") {
  const ScaledContacts c = Scale(Foot(0));
  for (const auto& [share, expected] : {std::pair(0.2, true), {2.0, false}}) {
    Balance balance = FootBalance(c, 0.49);
    REQUIRE(ProveInterior(c, &balance));
    const double least = *std::min_element(balance.weight, balance.weight + 6);
    // With R = 0.25 B^-1 kappa is 0.75. An error d in the weights leaves 0.75 d after refinement,
    // of which R sees 0.19 d: d = 2 least moves by 0.375 least, which is more than (1 - kappa)
    // least.
    balance.base_inverse *= 0.25;
    balance.weight[0] += share * least;
    CAPTURE(share);
    CHECK(ProveInterior(c, &balance) == expected);
  }
}

TEST_CASE("a separating wrench must clear the cone by the error of the normal") {
  for (const double eta : {1e-9, 1e-3, 0.1}) {
    Stance stance;
    stance.contacts = {PointContact({0.25, 0, 0}, {0, 0, 1}, 0.75)};
    stance.contacts[0].normal_error = eta;
    StabilityQuery query = stance.Query();
    query.gravity_W = {0, 0, 9.81};  // nothing pulls up
    ScaledContacts c;
    REQUIRE(ScaleContacts(query, &c));
    for (const double share : {0.5, 0.99, 1.01, 2.0}) {
      // sin(atan 0.75) = 0.6.
      const double along = 0.6 + share * eta;
      Vector6d y;
      y << std::sqrt(1 - along * along), 0, -along, 0, 0, 0;
      CAPTURE(eta, share);
      CHECK(ProveOutside(c, y) == (share > 1));
    }
  }
}

TEST_CASE("a separating wrench must clear the cone by the error of the arm") {
  for (const double error : {1e-9, 1e-3}) {
    Stance stance;
    stance.contacts = {PointContact({0.25, 0, 0}, {0, 0, 1}, 0)};
    stance.contacts[0].error = error;
    stance.contacts[0].normal_error = 0;
    StabilityQuery query = stance.Query();
    ScaledContacts c;
    REQUIRE(ScaleContacts(query, &c));
    for (const double share : {0.5, 0.9, 3.0}) {
      // g = y_f + y_m x r = (0, 0, -share error) at the stored arm, y_m = (0, 1, 0): tilting about
      // y.
      Vector6d y;
      y << 0, 0, 0.25 / c.length - share * error / c.length, 0, 1, 0;
      CAPTURE(error, share);
      CHECK(ProveOutside(c, y) == (share > 1));
    }
  }
}

TEST_CASE("a warm workspace allocates nothing") {
  Rng rng(149);
  std::vector<Stance> stances;
  for (int i = 0; i < 100; ++i) stances.push_back(RandomStance(1 + i % 8, rng));
  StabilityWorkspace workspace;
  TryStability(stances[7].Query(), &workspace);
  const long before = allocations;
  int holds = 0;
  for (const Stance& stance : stances) {
    holds += TryStability(stance.Query(), &workspace).verdict == Verdict::kHolds;
  }
  CHECK(allocations == before);
  CHECK(holds > 10);
}

TEST_CASE("a warm memory allocates nothing") {
  Rng rng(151);
  Stance stance = RandomStance(3, rng);
  StabilityWorkspace workspace;
  StabilityMemory memory;
  TryStability(stance.Query(), &memory, &workspace);
  TryStability(stance.Query(), &memory, &workspace);
  const long before = allocations;
  for (int i = 0; i < 100; ++i) {
    stance.com[0] += 0.01;
    TryStability(stance.Query(), &memory, &workspace);
  }
  CHECK(allocations == before);
  CHECK(memory.answered() > 80);
}

}  // namespace
}  // namespace cguide::numeric
