#include "cguide/numeric/proved_margins.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/wrench_polyhedra.h"
#include "tests/numeric/stability_cases.h"

namespace cguide::numeric {
namespace {

using testing::AddPatch;
using testing::Foot;
using testing::PointContact;
using testing::RandomStance;
using testing::Stance;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/** Contacts as a robot's kinematics hands them out: with errors, radii, and normals from x - y. */
void MakeRough(Rng& rng, Stance* stance) {
  for (Contact& contact : stance->contacts) {
    contact.error = std::pow(10, testing::Between(rng, -16, -11));
    contact.normal_error = Uniform(rng) < 0.5 ? -1 : 0x1p-51;
    if (Uniform(rng) < 0.5) {
      contact.radius = 0.01;
      contact.x_W += 0.01 * contact.n_W;
      contact.distance += 0.01;
    }
  }
}

TEST_CASE("The proved com margin encloses what floats find, tightly") {
  StabilityWorkspace workspace;
  Rng rng(601);
  int finite = 0, negative = 0, positive = 0, wide = 0, closure = 0, rough = 0;
  for (int i = 0; i < 1500; ++i) {
    Stance stance = RandomStance(1 + i % 4, rng);
    StabilityQuery query = stance.Query();
    if (i % 3 == 0) {
      MakeRough(rng, &stance);
      query = stance.Query();
      query.com_error = 1e-15;
      ++rough;
    }
    const ComMargin margin = FindComMargin(query, {}, &workspace);
    const ProvedComMargin proved = ProveComMargin(query, {}, &workspace);
    REQUIRE(proved.com_m.lo <= proved.com_m.hi);
    // FindComMargin is right to about 1e-12 m.
    CHECK(proved.com_m.lo <= margin.hi + 1e-11);
    CHECK(proved.com_m.hi >= margin.lo - 1e-11);
    // The evidence stands by itself.
    const auto& proof = proved.proof;
    const auto region = exact::CheckComRegion(proof.lifted.query, proof.region.up, proof.evidence);
    REQUIRE(region);
    CHECK(exact::MarginBounds(*region).lo == proved.com_m.lo);
    CHECK(exact::MarginBounds(*region).hi == proved.com_m.hi);
    if (std::isinf(margin.lo)) {
      closure += proved.com_m.lo == kInfinity;
      continue;
    }
    ++finite;
    ++(margin.lo > 0 ? positive : negative);
    // Where the float's own tolerance was not met, neither is the proof tighter; an error of 1e-11
    // m at a distance of 20 mm turns a normal by 1e-9.
    const double width = proved.com_m.hi - proved.com_m.lo - 2 * (margin.hi - margin.lo);
    wide += width > (i % 3 == 0 ? 1e-6 : 1e-9);
    // A verdict by another way agrees.
    const Verdict verdict = TryStability(query, &workspace).verdict;
    if (verdict == Verdict::kHolds) CHECK(proved.com_m.hi > 0);
    if (verdict == Verdict::kFails) CHECK(proved.com_m.lo < 0);
    if (proved.com_m.lo > 0) CHECK(verdict != Verdict::kFails);
    if (proved.com_m.hi < 0) CHECK(verdict != Verdict::kHolds);
  }
  CHECK(finite > 1300);
  CHECK(negative > 200);
  CHECK(positive > 100);
  CHECK(closure > 0);
  CHECK(rough > 200);
  CHECK(wide == 0);
}

TEST_CASE("The proved margin of a flat foot is its distance from the rectangle") {
  StabilityWorkspace workspace;
  Stance stance = Foot();
  Rng rng(603);
  for (int i = 0; i < 100; ++i) {
    stance.com = {0.2 * Normal(rng), 0.1 * Normal(rng), testing::Between(rng, -1, 1)};
    const double dx = std::abs(stance.com[0]) - 0.125, dy = std::abs(stance.com[1]) - 0.0625;
    const double expected =
        dx < 0 && dy < 0 ? -std::max(dx, dy) : -std::hypot(std::max(dx, 0.0), std::max(dy, 0.0));
    const exact::Enclosure m = ProveComMargin(stance.Query(), {}, &workspace).com_m;
    CHECK(m.lo <= expected + 1e-15);
    CHECK(m.hi >= expected - 1e-15);
    CHECK(m.hi - m.lo < 1e-10);
  }
}

TEST_CASE("The support region lies between two polygons that are proved, points tell the same") {
  StabilityWorkspace workspace;
  Rng rng(607);
  int regions = 0, balanced = 0, unbalanced = 0;
  for (int i = 0; i < 24; ++i) {
    Stance stance = RandomStance(1 + i % 4, rng);
    RegionOptions options;
    options.margins = {1e-4, 40};
    const ProvedSupportRegion region = ProveSupportRegion(stance.Query(), options, &workspace);
    if (region.inner_W.empty() || std::isinf(region.gap)) continue;
    ++regions;
    CHECK(region.gap < 0.05);
    if (i % 4 < 1) CHECK(region.gap < 1e-8);
    const Eigen::Vector3d com = stance.com;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : region.inner_W) centre += p / double(region.inner_W.size());
    for (const Eigen::Vector3d& p : region.inner_W) {
      CHECK(p[2] == com[2]);
      stance.com = centre + 0.999 * (p - centre);
      CHECK(TryStability(stance.Query(), &workspace).verdict != Verdict::kFails);
      const Eigen::Vector3d out = (p - centre).normalized();
      // Whoever is gap beyond a corner along the ray from the centre may be inside; twice the
      // region's size is not.
      stance.com = p + 2 * (p - centre) + region.gap * out;
      unbalanced += TryStability(stance.Query(), &workspace).verdict == Verdict::kFails;
      ++balanced;
    }
  }
  CHECK(regions > 15);
  CHECK(unbalanced == balanced);
}

TEST_CASE("Rank-deficient and empty contact sets are answered") {
  StabilityWorkspace workspace;
  Stance stance;
  stance.com = {0.25, 0, 1};
  CHECK(ProveComMargin(stance.Query(), {}, &workspace).com_m.hi == -kInfinity);
  CHECK(ProveSupportRegion(stance.Query(), {}, &workspace).is_empty);
  Contact point = PointContact({0, 0, 0}, {0, 0, 1}, 0.5);
  point.normal_error = 0;
  stance.contacts = {point};
  exact::Enclosure m = ProveComMargin(stance.Query(), {}, &workspace).com_m;
  CHECK(m.lo == -0.25);
  CHECK(m.hi == -0.25);
  point.x_W = {1, 0, 0};
  stance.contacts.push_back(point);
  m = ProveComMargin(stance.Query(), {}, &workspace).com_m;
  CHECK(m.lo == 0);
  CHECK(m.hi == 0);
  // With an error nothing balances for certain, but the upper side stands.
  stance.com = {0.25, 0.5, 1};
  for (Contact& c : stance.contacts) c.error = 1e-9;
  m = ProveComMargin(stance.Query(), {}, &workspace).com_m;
  CHECK(m.lo == -kInfinity);
  CHECK(m.hi == Approx(-0.5).margin(1e-6));
}

TEST_CASE("Altered evidence from floats is refused") {
  StabilityWorkspace workspace;
  Rng rng(609);
  int altered = 0, cutting = 0;
  for (int i = 0; i < 12; ++i) {
    const Stance stance = RandomStance(1 + i % 3, rng);
    const ProvedSupportRegion region =
        ProveSupportRegion(stance.Query(), {{1e-3, 12}, {}}, &workspace);
    if (region.inner_W.empty()) continue;
    const auto& query = region.proof.lifted.query;
    const Vector3q up = region.proof.region.up;
    const auto refused = [&](const exact::ComRegionEvidence& evidence) {
      ++altered;
      return !exact::CheckComRegion(query, up, evidence);
    };
    const exact::ComRegionEvidence& good = region.proof.evidence;
    REQUIRE(exact::CheckComRegion(query, up, good));
    Vector3q centre = Vector3q::Zero();
    for (const auto& c : good.corners) centre += c.displacement;
    centre = exact::Scaled(Rational(1, static_cast<long>(good.corners.size())), centre);
    for (std::size_t j = 0; j < good.corners.size(); ++j) {
      exact::ComRegionEvidence bad = good;
      Vector3q& d = bad.corners[j].displacement;
      d += exact::Scaled(Rational(1, 1000000), d - centre);  // a millionth of the size outwards
      CHECK(refused(bad));
      bad = good;
      bad.corners[j].base_weight[static_cast<std::size_t>(i % 6)] *= -1;
      CHECK(refused(bad));
      bad = good;
      bad.corners[j].base_weight.pop_back();
      CHECK(refused(bad));
      bad = good;
      bad.corners[j].forces.push_back({0, Vector3q(0, 0, -1)});  // a pull
      CHECK(refused(bad));
    }
    for (std::size_t j = 0; j < good.separators.size(); ++j) {
      exact::ComRegionEvidence bad = good;
      bad.separators[j] = -bad.separators[j];
      CHECK(refused(bad));
      bad = good;
      // Another moment makes another line: it cuts and is refused, or is a bound as good as any.
      for (int k = 3; k < 6; ++k) bad.separators[j][k] *= Rational(1001, 1000);
      const auto other = exact::CheckComRegion(query, up, bad);
      cutting += !other;
      if (!other) continue;
      CHECK(exact::MarginBounds(*other).hi >= exact::MarginBounds(region.proof.region).lo);
    }
    exact::ComRegionEvidence bad = good;
    bad.basis.inverse(0, 0) += 10;
    CHECK(refused(bad));
    bad = good;
    bad.basis.columns.pop_back();
    CHECK(refused(bad));
  }
  CHECK(altered > 200);
  CHECK(cutting > 50);
}

TEST_CASE("Mass and a shift of everything change no proved margin") {
  StabilityWorkspace workspace;
  Rng rng(611);
  for (int i = 0; i < 30; ++i) {
    Stance stance = RandomStance(1 + i % 3, rng);
    StabilityQuery query = stance.Query();
    const exact::Enclosure margin = ProveComMargin(query, {}, &workspace).com_m;
    query.mass = 1000;
    const exact::Enclosure heavy = ProveComMargin(query, {}, &workspace).com_m;
    CHECK(heavy.lo <= margin.hi);
    CHECK(heavy.hi >= margin.lo);
    const Eigen::Vector3d shift(3, -2, 1);
    for (Contact& c : stance.contacts) {
      c.x_W += shift;
      c.y_W += shift;
    }
    stance.com += shift;
    const exact::Enclosure shifted = ProveComMargin(stance.Query(), {}, &workspace).com_m;
    CHECK(shifted.lo <= margin.hi + 1e-12);  // the shift rounds
    CHECK(shifted.hi >= margin.lo - 1e-12);
  }
}

TEST_CASE("Options given as braces ask for no acceleration") {
  CHECK_FALSE(RegionOptions{{1e-4, 40}, {}}.acceleration_W);
}

TEST_CASE("An acceleration moves the region of a foot against it") {
  StabilityWorkspace workspace;
  Stance stance = Foot();
  stance.com = {0, 0, 2};
  RegionOptions options;
  options.acceleration_W = Eigen::Vector3d(0, 9.81 / 64, 0);  // the zero-moment point moves by 2/64
  const exact::Enclosure m = ProveComMargin(stance.Query(), options, &workspace).com_m;
  CHECK(m.lo == Approx(0.03125).margin(1e-10));
  CHECK(m.hi == Approx(0.03125).margin(1e-10));
  options.acceleration_W = Eigen::Vector3d(0, 0, -9.81);
  CHECK_THROWS_AS(ProveComMargin(stance.Query(), options, &workspace), Error);
}

TEST_CASE("Contacts that only may be active support nothing") {
  StabilityWorkspace workspace;
  Stance stance = Foot();
  const double com_m = ProveComMargin(stance.Query(), {}, &workspace).com_m.lo;
  AddPatch({0.5, 0, 0}, {0, 0, 1}, 0, 0.5, 0.125, 0.0625, &stance);
  for (std::size_t i = 4; i < 8; ++i) stance.contacts[i].certain = false;
  CHECK(ProveComMargin(stance.Query(), {}, &workspace).com_m.lo == Approx(com_m));
}

TEST_CASE("Numbers that are none are refused") {
  StabilityWorkspace workspace;
  Stance stance = Foot();
  stance.com[0] = NAN;
  CHECK_THROWS_AS(ProveComMargin(stance.Query(), {}, &workspace), Error);
  stance = Foot();
  stance.contacts[2].x_W[1] = kInfinity;
  CHECK_THROWS_AS(ProveComMargin(stance.Query(), {}, &workspace), Error);
  stance = Foot();
  stance.contacts[2].n_W.setZero();
  CHECK_THROWS_AS(ProveSupportRegion(stance.Query(), {}, &workspace), Error);
  stance = Foot();
  StabilityQuery query = stance.Query();
  query.gravity_W.setZero();
  CHECK_THROWS_AS(ProveComMargin(query, {}, &workspace), Error);
  query = stance.Query();
  query.mass = 0;
  CHECK_THROWS_AS(ProveComMargin(query, {}, &workspace), Error);
}

}  // namespace
TEST_CASE("The force margin by certified facets is that of the textbook's facets, bit for bit") {
  Rng rng(77);
  for (int i = 0; i < 12; ++i) {
    testing::Stance stance;
    const Eigen::Vector3d normals[] = {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}, {0.36, 0.48, 0.8}};
    // Three rounds of axis-aligned contacts, whose generators doubles hold, and one tilted.
    for (int k = 0; k < 2; ++k) {
      testing::AddPatch({Uniform(rng), Uniform(rng), k * 0.5}, normals[k == 0 ? 0 : i % 4], 0, 0.5,
                        0.11, 0.06, &stance);
    }
    for (Contact& c : stance.contacts) c.normal_error = 0;
    stance.com = {0.5, 0.5, 0.8};
    const StabilityQuery query = stance.Query();
    const auto proved = ProveForceMargin(query);
    const LiftedQuery lifted = LiftCertain(query);
    const auto reference = exact::ForceMargin(
        lifted.query, exact::WrenchFacets(exact::InscribedCone(lifted.query, query.generators)));
    REQUIRE(proved);
    CHECK(proved->lo == reference.lo);
    CHECK(proved->hi == reference.hi);
  }
}

}  // namespace cguide::numeric
