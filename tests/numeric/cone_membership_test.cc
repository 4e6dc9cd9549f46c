#include "cguide/numeric/cone_membership.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "cguide/exact/core/error.h"
#include "tests/cases/wrench_sets.h"

namespace cguide::numeric {
namespace {

using exact::Membership;
using testing::Storage;
using testing::WrenchSet;
using Vector6d = WrenchCone::Vector6d;

struct Tally {
  int fast = 0, exact = 0, interior = 0, boundary = 0, outside = 0;
  void Add(const ConeAnswer& answer) {
    ++(answer.stage == ConeStage::kFast ? fast : exact);
    ++(answer.where == Membership::kInterior   ? interior
       : answer.where == Membership::kBoundary ? boundary
                                               : outside);
  }
};

/** Every claim is checked over Q by arithmetic on its proof alone. */
ConeAnswer Checked(const WrenchCone& cone, const WrenchDemand& v, ConeWorkspace* workspace,
                   Tally* tally) {
  const ConeAnswer answer = ConeMembership(cone, v, workspace);
  tally->Add(answer);
  const exact::ConeMembership proof = ExactProof(cone, v, answer);
  REQUIRE(proof.where == answer.where);
  REQUIRE(exact::CheckConeMembership(cone.ExactColumns(), v.Exact(), proof));
  return answer;
}

/** The offset along the line through the demand at which it leaves the cone, by bisection. */
double BoundaryOffset(const WrenchCone& cone, const WrenchSet& set, const AppliedForce& demand,
                      ConeWorkspace* workspace) {
  double in = -(demand.p - set.centroid).head<2>().norm(), out = 2;
  const auto inside = [&](double offset) {
    return ConeMembership(cone, testing::Displaced(set, demand, offset), workspace).where !=
           Membership::kOutside;
  };
  if (!inside(in) || inside(out)) return std::nan("");
  while (true) {
    const double middle = 0.5 * (in + out);
    if (middle == in || middle == out) return in;
    (inside(middle) ? in : out) = middle;
  }
}

}  // namespace

TEST_CASE("Ordinary stances are decided in doubles, and every claim has a proof over Q") {
  Rng rng(1);
  ConeWorkspace workspace;
  Tally tally;
  for (int i = 0; i < 1500; ++i) {
    const Storage storage = i % 2 ? Storage::kRounded : Storage::kSnapped;
    const WrenchSet set = testing::RandomStanceSet(1 + i % 4, i % 3 ? 4 : 8, storage, rng);
    const WrenchCone cone = WrenchCone::OfForces(set.generators);
    Checked(cone, testing::RandomDemand(set, storage, rng), &workspace, &tally);
  }
  CAPTURE(tally.fast, tally.exact, tally.interior, tally.outside);
  CHECK(tally.exact <= 8);  // 99.5 %
  CHECK(tally.interior > 200);
  CHECK(tally.outside > 200);
}

TEST_CASE("Demands from 1e-3 m to 1e-16 m beside the boundary are decided, exactly where needed") {
  Rng rng(2);
  ConeWorkspace workspace;
  Tally tally;
  for (int i = 0; i < 60; ++i) {
    const Storage storage = i % 2 ? Storage::kRounded : Storage::kSnapped;
    const WrenchSet set = testing::RandomStanceSet(1 + i % 3, 4, storage, rng);
    const WrenchCone cone = WrenchCone::OfForces(set.generators);
    const AppliedForce demand = testing::RandomDemand(set, storage, rng);
    const double edge = BoundaryOffset(cone, set, demand, &workspace);
    if (std::isnan(edge)) continue;
    for (int decade = -16; decade <= -3; ++decade) {
      for (const double side : {-1.0, 1.0}) {
        const double offset = edge + side * std::pow(10, decade);
        const ConeAnswer answer =
            Checked(cone, testing::Displaced(set, demand, offset), &workspace, &tally);
        if (decade >= -10) {
          REQUIRE((answer.where == Membership::kOutside) == (side > 0));
        }
      }
    }
  }
  CAPTURE(tally.fast, tally.exact, tally.interior, tally.boundary, tally.outside);
  CHECK(tally.fast > 500);
  CHECK(tally.exact > 100);
}

TEST_CASE("Exact ties get the answer of the exact twin and of quadratic programming") {
  Rng rng(3);
  ConeWorkspace workspace;
  Tally tally;
  for (const testing::TieCase& tie : testing::TieCases(600, rng)) {
    CAPTURE(tie.name);
    const WrenchCone cone = WrenchCone::OfForces(tie.set.generators);
    const ConeAnswer answer = Checked(cone, tie.demand, &workspace, &tally);
    const auto twin =
        exact::DecideConeMembership(cone.ExactColumns(), WrenchDemand(tie.demand).Exact());
    REQUIRE(answer.where == twin.where);
  }
  CAPTURE(tally.fast, tally.exact, tally.interior, tally.boundary, tally.outside);
  CHECK(tally.boundary > 100);
  CHECK(tally.interior > 50);
  CHECK(tally.outside > 100);
}

TEST_CASE("Small integer cones of every rank agree with the exact twin") {
  Rng rng(4);
  ConeWorkspace workspace;
  Tally tally;
  const auto digit = [&](int range) { return std::floor(Uniform(rng) * (2 * range + 1)) - range; };
  for (int i = 0; i < 4000; ++i) {
    const int n = static_cast<int>(Uniform(rng) * 14), range = 1 + i % 2, rank = 1 + i % 6;
    std::vector<Vector6d> columns(n);
    for (Vector6d& a : columns) {
      for (int k = 0; k < 6; ++k) a[k] = k < rank ? digit(range) : 0;
    }
    Vector6d v = Vector6d::Zero();
    if (i % 3 == 0) {
      for (const Vector6d& a : columns) v += std::floor(Uniform(rng) * 2) * a;
    } else {
      for (int k = 0; k < 6; ++k) v[k] = k < rank || i % 5 == 0 ? digit(range) : 0;
    }
    const WrenchCone cone = WrenchCone::OfWrenches(columns);
    const ConeAnswer answer = Checked(cone, v, &workspace, &tally);
    if (i % 4 != 0) continue;
    REQUIRE(answer.where ==
            exact::DecideConeMembership(cone.ExactColumns(), WrenchDemand(v).Exact()).where);
  }
  CAPTURE(tally.fast, tally.exact, tally.interior, tally.boundary, tally.outside);
  CHECK(tally.boundary > 500);
  CHECK(tally.interior > 100);
  CHECK(tally.outside > 500);
}

TEST_CASE("A verdict does not depend on the scale and the order of generators") {
  Rng rng(5);
  ConeWorkspace workspace;
  Tally tally;
  for (int i = 0; i < 200; ++i) {
    WrenchSet set = testing::RandomStanceSet(1 + i % 3, 4, Storage::kSnapped, rng);
    const AppliedForce demand = testing::RandomDemand(set, Storage::kSnapped, rng);
    const Membership before =
        Checked(WrenchCone::OfForces(set.generators), demand, &workspace, &tally).where;
    for (std::size_t j = set.generators.size(); j > 1; --j) {
      std::swap(set.generators[j - 1],
                set.generators[static_cast<std::size_t>(Uniform(rng) * static_cast<double>(j))]);
    }
    for (AppliedForce& a : set.generators)
      a.u *= std::ldexp(1.0, static_cast<int>(Uniform(rng) * 60) - 30);
    AppliedForce scaled = demand;
    scaled.u *= 0x1p-40;
    REQUIRE(Checked(WrenchCone::OfForces(set.generators), scaled, &workspace, &tally).where ==
            before);
  }
}

TEST_CASE("Denormal, huge and mixed numbers are answered exactly") {
  ConeWorkspace workspace;
  Tally tally;
  const double tiny = std::numeric_limits<double>::denorm_min(), huge = 1e308;
  for (const double size : {tiny, 1e-300, 1e300, huge}) {
    std::vector<AppliedForce> forces;
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) {
        for (const double s : {-1.0, 1.0}) {
          for (const double t : {-1.0, 1.0}) {
            forces.push_back({{x, y, 0}, {s * size, t * size, 2 * (size < 1 ? size : size / 2)}});
          }
        }
      }
    }
    const WrenchCone cone = WrenchCone::OfForces(forces);
    REQUIRE(Checked(cone, AppliedForce{{0, 0, 5}, {0, 0, 1}}, &workspace, &tally).where ==
            Membership::kInterior);
    REQUIRE(Checked(cone, AppliedForce{{1, 0, 0}, {0, 0, 1}}, &workspace, &tally).where ==
            Membership::kBoundary);
    REQUIRE(
        Checked(cone, AppliedForce{{1.0000000000000002, 0, 0}, {0, 0, huge}}, &workspace, &tally)
            .where == Membership::kOutside);
    REQUIRE(Checked(cone, AppliedForce{{huge, 0, 0}, {0, 0, 1}}, &workspace, &tally).where ==
            Membership::kOutside);
  }
}

TEST_CASE("Nothing, zeros and lone generators are cones too") {
  ConeWorkspace workspace;
  Tally tally;
  const WrenchCone none;
  REQUIRE(Checked(none, Vector6d(Vector6d::Zero()), &workspace, &tally).where ==
          Membership::kBoundary);
  REQUIRE(Checked(none, Vector6d(Vector6d::Ones()), &workspace, &tally).where ==
          Membership::kOutside);
  const std::vector<Vector6d> zeros(3, Vector6d::Zero());
  const WrenchCone zero = WrenchCone::OfWrenches(zeros);
  REQUIRE(Checked(zero, Vector6d(Vector6d::Zero()), &workspace, &tally).where ==
          Membership::kBoundary);
  REQUIRE(Checked(zero, Vector6d(Vector6d::Unit(2)), &workspace, &tally).where ==
          Membership::kOutside);
  const std::vector<Vector6d> one{Vector6d::Ones()};
  const WrenchCone ray = WrenchCone::OfWrenches(one);
  REQUIRE(Checked(ray, Vector6d(3 * Vector6d::Ones()), &workspace, &tally).where ==
          Membership::kBoundary);
  REQUIRE(Checked(ray, Vector6d(-Vector6d::Ones()), &workspace, &tally).where ==
          Membership::kOutside);
  std::vector<Vector6d> all;
  for (int k = 0; k < 6; ++k) {
    all.push_back(Vector6d::Unit(k));
    all.push_back(-Vector6d::Unit(k));
  }
  const WrenchCone whole = WrenchCone::OfWrenches(all);
  REQUIRE(Checked(whole, Vector6d(Vector6d::Zero()), &workspace, &tally).where ==
          Membership::kInterior);
  REQUIRE(Checked(whole, Vector6d(-Vector6d::Ones()), &workspace, &tally).where ==
          Membership::kInterior);
}

TEST_CASE("NaN and infinity are declined by doubles and refused by the whole") {
  ConeWorkspace workspace;
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    std::vector<AppliedForce> forces(8, AppliedForce{{0, 0, 0}, {0, 0, 1}});
    const AppliedForce good{{0, 0, 1}, {0, 0, 1}};
    forces[3].p[1] = bad;
    REQUIRE_FALSE(TryConeMembership(WrenchCone::OfForces(forces), good, &workspace));
    REQUIRE_THROWS_AS(ConeMembership(WrenchCone::OfForces(forces), good, &workspace), Error);
    forces[3].p[1] = 0;
    const AppliedForce wrong{{0, bad, 1}, {0, 0, 1}};
    REQUIRE_FALSE(TryConeMembership(WrenchCone::OfForces(forces), wrong, &workspace));
    REQUIRE_THROWS_AS(ConeMembership(WrenchCone::OfForces(forces), wrong, &workspace), Error);
    std::vector<Vector6d> wrenches(2, Vector6d::Constant(bad));
    REQUIRE_THROWS_AS(ConeMembership(WrenchCone::OfWrenches(wrenches), good, &workspace), Error);
  }
}

TEST_CASE("A batch answers like single questions, mostly from memory") {
  Rng rng(7);
  ConeWorkspace workspace;
  long remembered = 0, asked = 0;
  for (int i = 0; i < 20; ++i) {
    const WrenchSet set = testing::RandomStanceSet(1 + i % 4, 4, Storage::kRounded, rng);
    const WrenchCone cone = WrenchCone::OfForces(set.generators);
    ConeBatch batch(cone);
    AppliedForce demand = testing::RandomDemand(set, Storage::kRounded, rng);
    for (int k = 0; k < 200; ++k) {
      demand.p += Eigen::Vector3d(Uniform(rng) - 0.5, Uniform(rng) - 0.5, 0) * 0.02;
      const ConeAnswer answer = batch.Membership(demand);
      REQUIRE(answer.where == ConeMembership(cone, demand, &workspace).where);
      if (k % 20 == 0) {
        REQUIRE(exact::CheckConeMembership(cone.ExactColumns(), WrenchDemand(demand).Exact(),
                                           ExactProof(cone, demand, answer)));
      }
    }
    remembered += batch.remembered();
    asked += 200;
  }
  CHECK(remembered > asked * 8 / 10);
}

}  // namespace cguide::numeric
