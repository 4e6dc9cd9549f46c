#include "cguide/numeric/margins.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "cguide/exact/cone_membership.h"
#include "cguide/numeric/double_description.h"
#include "tests/numeric/stability_cases.h"

namespace cguide::numeric {
namespace {

using testing::AddPatch;
using testing::Foot;
using testing::PointContact;
using testing::RandomStance;
using testing::Stance;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST_CASE("com_m of a flat foot is the signed distance from its rectangle") {
  StabilityWorkspace workspace;
  Stance stance = Foot();
  Rng rng(401);
  for (int i = 0; i < 200; ++i) {
    stance.com = {0.2 * Normal(rng), 0.1 * Normal(rng), testing::Between(rng, -1, 1)};
    const double dx = std::abs(stance.com[0]) - 0.125, dy = std::abs(stance.com[1]) - 0.0625;
    const double expected =
        dx < 0 && dy < 0 ? -std::max(dx, dy) : -std::hypot(std::max(dx, 0.0), std::max(dy, 0.0));
    const ComMargin margin = FindComMargin(stance.Query(), {}, &workspace);
    CHECK(margin.lo <= margin.hi);
    CHECK(margin.lo == Approx(expected).margin(2e-9));
    CHECK(margin.hi == Approx(expected).margin(2e-9));
  }
}

// The convex hull of contact points on a floor, by gift wrapping: distance of p inside, negative
// outside.
double DistanceInHull(const std::vector<Contact>& contacts, const Eigen::Vector3d& p) {
  double least = kInfinity;
  for (const Contact& a : contacts) {
    for (const Contact& b : contacts) {
      const Eigen::Vector3d edge = b.x_W - a.x_W;
      if (edge.norm() < 1e-9) continue;
      const Eigen::Vector3d in = Eigen::Vector3d(-edge[1], edge[0], 0) / edge.norm();
      bool side = true;
      for (const Contact& c : contacts) side = side && in.dot(c.x_W - a.x_W) >= -1e-12;
      if (side) least = std::min(least, in.dot(p - a.x_W));
    }
  }
  return least;
}

TEST_CASE("on a flat floor the region is the convex hull of the contacts, whatever the friction") {
  StabilityWorkspace workspace;
  Rng rng(409);
  for (int i = 0; i < 60; ++i) {
    Stance stance;
    for (int j = 0; j < 3 + i % 10; ++j) {
      stance.contacts.push_back(
          PointContact({Normal(rng), Normal(rng), 0}, {0, 0, 1}, 0.1 + Uniform(rng)));
    }
    for (const Contact& c : stance.contacts) stance.com += c.x_W / double(stance.contacts.size());
    stance.com[2] = 0.8;
    const double expected = DistanceInHull(stance.contacts, stance.com);
    const ComMargin margin = FindComMargin(stance.Query(), {}, &workspace);
    CHECK(margin.lo == Approx(expected).margin(2e-9));
    CHECK(margin.hi == Approx(expected).margin(2e-9));
    const SupportRegion region = FindSupportRegion(stance.Query(), {}, &workspace);
    CHECK(region.gap <= 1e-9);
    for (const Eigen::Vector3d& v : region.vertices_W) {
      const bool is_contact =
          std::any_of(stance.contacts.begin(), stance.contacts.end(),
                      [&](const Contact& c) { return (c.x_W - v).head<2>().norm() < 1e-8; });
      CHECK(is_contact);
      CHECK(v[2] == 0.8);
    }
  }
}

TEST_CASE("inside the margin displacements hold, beyond it one fails") {
  StabilityWorkspace workspace;
  Rng rng(419);
  int tested = 0, negative = 0, widest = 0;
  for (int i = 0; i < 200; ++i) {
    Stance stance = RandomStance(1 + i % 5, rng);
    const Eigen::Vector3d com = stance.com;
    const Verdict verdict = TryStability(stance.Query(), &workspace).verdict;
    const ComMargin margin = FindComMargin(stance.Query(), {}, &workspace);
    CHECK(margin.lo <= margin.hi);
    if (verdict == Verdict::kHolds) CHECK(margin.hi > 0);
    if (verdict == Verdict::kFails) CHECK(margin.lo < 0);
    if (std::isinf(margin.lo)) continue;
    ++tested;
    if (margin.hi - margin.lo > 1e-6) ++widest;
    const double step = 1e-7 * (1 + std::abs(margin.lo));
    if (margin.lo > 0) {
      for (int j = 0; j < 8; ++j) {
        const Eigen::Vector3d d(std::cos(j), std::sin(j), 0);
        stance.com = com + (margin.lo - step) * d;
        CHECK(TryStability(stance.Query(), &workspace).verdict != Verdict::kFails);
      }
      stance.com = com + (margin.hi + step) * margin.direction_W;
      CHECK(TryStability(stance.Query(), &workspace).verdict == Verdict::kFails);
    } else if (margin.hi < 0) {
      ++negative;
      for (int j = 0; j < 8; ++j) {  // no displacement shorter than -hi helps
        const Eigen::Vector3d d(std::cos(j), std::sin(j), 0);
        stance.com = com + std::max(0.0, -margin.hi - step) * d;
        CHECK(TryStability(stance.Query(), &workspace).verdict != Verdict::kHolds);
      }
    }
  }
  CHECK(tested > 120);
  CHECK(negative > 40);
  CHECK(widest <= 6);
}

TEST_CASE("com_m is continuous through zero") {
  StabilityWorkspace workspace;
  Stance stance = RandomStance(1, *std::make_unique<Rng>(421));
  AddPatch({0.4, 0.4, 0.5}, Eigen::Vector3d(1, 0.5, 2).normalized(), 1, 0.4, 0.1, 0.05, &stance);
  const Eigen::Vector3d inside(stance.centroid[0], stance.centroid[1], 0.8);
  double last = 0;
  int changes = 0;
  for (int i = 0; i <= 400; ++i) {
    stance.com = inside + Eigen::Vector3d(0.8, -0.5, 0) * (i / 400.0);
    const double margin = FindComMargin(stance.Query(), {}, &workspace).lo;
    if (i > 0) {
      CHECK(std::abs(margin - last) <=
            std::hypot(0.8, 0.5) / 400 + 1e-6);  // distances are 1-Lipschitz
      changes += (margin > 0) != (last > 0);
    }
    last = margin;
  }
  CHECK(changes == 1);
}

TEST_CASE("no region: minus infinity; force closure: infinity") {
  StabilityWorkspace workspace;
  Stance stance;
  stance.com = {0, 0, 1};
  CHECK(FindComMargin(stance.Query(), {}, &workspace).hi == -kInfinity);
  stance.contacts = {PointContact({0, 0, 0}, {0, 0, 1}, 0.5),
                     PointContact({1, 0, 0}, {0, 0, 1}, 0.5)};
  CHECK(FindComMargin(stance.Query(), {}, &workspace).hi == -kInfinity);
  CHECK(FindSupportRegion(stance.Query(), {}, &workspace).vertices_W.empty());
  CHECK(ForceMargin(stance.Query()) <= 0);
  Stance walls;
  AddPatch({-0.5, 0, 0.25}, {1, 0, 0}, 0, 0.5, 0.0625, 0.125, &walls);
  AddPatch({0.5, 0, 0.25}, {-1, 0, 0}, 0, 0.5, 0.0625, 0.125, &walls);
  walls.com = {0, 0, 0.5};
  CHECK(FindComMargin(walls.Query(), {}, &workspace).lo == kInfinity);
  CHECK(ForceMargin(walls.Query()) == kInfinity);
}

TEST_CASE("the force margin is the radius of a ball of wrenches, by the exact cone") {
  Rng rng(431);
  int tested = 0;
  for (int i = 0; i < 40 && tested < 6; ++i) {
    const Stance stance = RandomStance(2, rng);
    const StabilityQuery query = stance.Query();
    const double margin = ForceMargin(query);
    if (!(margin > 0.001) || std::isinf(margin)) continue;
    ++tested;
    std::vector<VectorXq> generators;
    const auto lift = [](const Vector6d& a) {
      VectorXq lifted(6);
      for (int j = 0; j < 6; ++j) lifted[j] = Lift(a[j]);
      return lifted;
    };
    const auto wrenches = WrenchGenerators(query, Pyramid::kInscribed);
    for (const Vector6d& a : wrenches) generators.push_back(lift(a));
    const double weight = query.mass * 9.81;
    const auto is_inside = [&](double radius, const Vector6d& d) {
      const Vector6d v = RequiredWrench(query) + radius * weight * d;
      return exact::DecideConeMembership(generators, lift(v)).where == exact::Membership::kInterior;
    };
    for (int j = 0; j < 10; ++j) {
      Vector6d d;
      for (double& x : d) x = Normal(rng);
      CHECK(is_inside((1 - 1e-6) * margin, d.normalized()));
    }
    const ConeFacets cone = DualDescription(wrenches);
    Vector6d worst = cone.facets[0];
    for (const Vector6d& h : cone.facets) {
      if (h.dot(RequiredWrench(query)) > worst.dot(RequiredWrench(query))) worst = h;
    }
    CHECK_FALSE(is_inside((1 + 1e-6) * margin, worst));
  }
  CHECK(tested == 6);
}

}  // namespace
}  // namespace cguide::numeric
