#include "cguide/numeric/double_description.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <ppl.hh>

#include "cguide/exact/cone.h"
#include "cguide/numeric/friction.h"
#include "tests/numeric/stability_cases.h"

namespace cguide::numeric {
namespace {

// Loading PPL turns the rounding mode upwards, where no bound of ours holds and none is computed.
const bool kRoundingRestored = (Parma_Polyhedra_Library::restore_pre_PPL_rounding(), true);

using testing::PointContact;
using testing::RandomStance;
using testing::Stance;

double Snap(double x) { return std::ldexp(std::round(std::ldexp(x, 10)), -10); }

// Generators whose entries are multiples of 2^-20, so that moments are exact and coplanar ones stay
// so.
std::vector<Vector6d> DyadicGenerators(int patches, int sides, Rng& rng) {
  const Stance stance = RandomStance(patches, rng);
  std::vector<Vector6d> generators;
  std::vector<Eigen::Vector3d> edges;
  for (const Contact& c : stance.contacts) {
    edges.clear();
    AppendPyramid(c, sides, Pyramid::kInscribed, &edges);
    const Eigen::Vector3d r = (c.force_point_W() - stance.com).unaryExpr(&Snap);
    for (const Eigen::Vector3d& edge : edges) {
      const Eigen::Vector3d u = edge.unaryExpr(&Snap);
      Vector6d a;
      a << u, r.cross(u);
      generators.push_back(a);
    }
  }
  return generators;
}

VectorXq LiftVector(const Vector6d& a) {
  VectorXq lifted(6);
  for (int i = 0; i < 6; ++i) lifted[i] = Lift(a[i]);
  return lifted;
}

exact::HalfspaceCone ExactFacets(const std::vector<Vector6d>& generators) {
  exact::GeneratorCone cone;
  cone.dimension = 6;
  for (const Vector6d& a : generators) cone.rays.push_back(LiftVector(a));
  return exact::FacetsOf(cone);
}

// Every vector of a is within 1e-7 of one of b.
bool IsCovered(const std::vector<Vector6d>& a, const std::vector<Vector6d>& b) {
  return std::all_of(a.begin(), a.end(), [&](const Vector6d& x) {
    return std::any_of(b.begin(), b.end(),
                       [&](const Vector6d& y) { return (x - y).norm() < 1e-7; });
  });
}

void CheckSameFacets(const ConeFacets& cone, const std::vector<Vector6d>& expected) {
  CHECK(cone.facets.size() == expected.size());
  CHECK(IsCovered(cone.facets, expected));
  CHECK(IsCovered(expected, cone.facets));
}

TEST_CASE("facets of dyadic stances are those of the exact double description") {
  Rng rng(307);
  for (const auto& [patches, sides, count] :
       {std::tuple(1, 4, 12), {2, 4, 6}, {3, 4, 2}, {1, 8, 3}}) {
    for (int i = 0; i < count; ++i) {
      const auto generators = DyadicGenerators(patches, sides, rng);
      CAPTURE(patches, sides, i);
      const exact::HalfspaceCone reference = ExactFacets(generators);
      REQUIRE(reference.equations.empty());
      std::vector<Vector6d> expected;
      for (const VectorXq& h : reference.facets) {
        Vector6d x;
        for (int j = 0; j < 6; ++j) x[j] = NearestDouble(h[j]);
        expected.push_back(x.normalized());
      }
      CheckSameFacets(DualDescription(generators), expected);
    }
  }
}

TEST_CASE("facets of dyadic stances are those of the Parma Polyhedra Library") {
  using namespace Parma_Polyhedra_Library;
  Rng rng(311);
  for (const int patches : {1, 2, 3, 4}) {
    const auto generators = DyadicGenerators(patches, 4, rng);
    Generator_System system;
    system.insert(point(0 * Variable(5)));
    for (const Vector6d& a : generators) {
      Linear_Expression e;
      for (int j = 0; j < 6; ++j) {
        e += Coefficient(mpz_class(std::ldexp(a[j], 20))) * Variable(j);
      }
      system.insert(ray(e));
    }
    const C_Polyhedron polyhedron(system);
    std::vector<Vector6d> expected;
    for (const Constraint& c : polyhedron.minimized_constraints()) {
      REQUIRE(c.is_inequality());
      Vector6d h;
      for (int j = 0; j < 6; ++j) h[j] = -mpz_class(c.coefficient(Variable(j))).get_d();
      expected.push_back(h.normalized());
    }
    CheckSameFacets(DualDescription(generators), expected);
  }
}

TEST_CASE("the example that breaks a well-known float library has its 66 facets") {
  const double forces[14][6] = {
      {-257726, 257726, 983192, -23772802452, -324139924836, 78735808452},
      {-248949, -312182, 969576, -32324995956, -113149002678, -44731261265},
      {-983192, 257726, 257726, -481887054390, -1504487212494, -333850777386},
      {-983192, 257726, -257726, -255440743558, -1205248931026, -230774894490},
      {-983192, 257726, -257726, -277469100230, -1287709244066, -229199820906},
      {-983192, 364479, 0, -532467006621, -1436344209608, -167633551005},
      {-983192, 257726, 257726, -475554211118, -1584979175150, -229199820906},
      {-983192, 257726, -257726, -250965589294, -1289677594450, -332275703802},
      {-983192, 364479, 0, -533196693579, -1438312559992, -270709433901},
      {-983192, 257726, 257726, -503089656958, -1586947525534, -332275703802},
      {-983192, -257726, 257726, 250965589294, -1586947525534, -629545634886},
      {-983192, -364479, 0, 533196693579, -1438312559992, -691111904787},
      {438510, -446320, 841439, 813535239105, 219825647532, -307367206290},
      {181912, -550983, 873406, 944146757649, -82460057676, -248665242666}};
  std::vector<Vector6d> generators;
  for (const auto& f : forces) {
    Vector6d a;
    for (int j = 0; j < 6; ++j) a[j] = std::ldexp(f[j], j < 3 ? -20 : -40);
    generators.push_back(a);
  }
  const ConeFacets cone = DualDescription(generators);
  CHECK(cone.facets.size() == 66);
  Vector6d v;
  v << 0, 0, 568.98, 129.24292253878212, -48.702728382435055, 0;
  CHECK(FacetExcess(cone, v) > 0.001 * v.norm());
}

TEST_CASE("cones of low rank have equations, and the whole space has nothing") {
  StabilityQuery query;
  std::vector<Contact> contacts = {PointContact({0.25, 0.5, -1}, {0, 0, 1}, 0.5)};
  query.contacts = contacts;
  query.mass = 1;
  ConeFacets cone = DualDescription(WrenchGenerators(query, Pyramid::kInscribed));
  CHECK(cone.equations.size() == 3);
  CHECK(cone.facets.size() == 4);
  contacts.push_back(PointContact({-0.25, 0.5, -1}, {0, 0, 1}, 0.5));
  query.contacts = contacts;
  cone = DualDescription(WrenchGenerators(query, Pyramid::kInscribed));
  CHECK(cone.equations.size() == 1);
  std::vector<Vector6d> all;
  for (int i = 0; i < 6; ++i) {
    all.push_back(Vector6d::Unit(i));
    all.push_back(-Vector6d::Unit(i));
  }
  cone = DualDescription(all);
  CHECK(cone.facets.empty());
  CHECK(cone.equations.empty());
  CHECK(FacetExcess(cone, Vector6d::Ones()) == -std::numeric_limits<double>::infinity());
  cone = DualDescription({});
  CHECK(cone.equations.size() == 6);
  // A halfspace: five lines and a ray.
  all.erase(all.begin() + 5);
  cone = DualDescription(all);
  REQUIRE(cone.facets.size() == 1);
  CHECK(cone.facets[0].isApprox(-Vector6d::Unit(2), 1e-12));
}

TEST_CASE("repeated, zero and redundant generators add no facet") {
  Rng rng(313);
  auto generators = DyadicGenerators(1, 4, rng);
  const ConeFacets plain = DualDescription(generators);
  const std::size_t n = generators.size();
  for (std::size_t i = 0; i < n; ++i) generators.push_back(2 * generators[i]);
  generators.push_back(Vector6d::Zero());
  generators.push_back(generators[0] + generators[5] + generators[9]);
  CheckSameFacets(DualDescription(generators), plain.facets);
}

TEST_CASE("membership by facets agrees with the exact cone away from its boundary") {
  Rng rng(317);
  int inside = 0, outside = 0;
  for (int i = 0; i < 6; ++i) {
    const auto generators = DyadicGenerators(1 + i % 2, 4, rng);
    const ConeFacets cone = DualDescription(generators);
    const exact::HalfspaceCone reference = ExactFacets(generators);
    for (int j = 0; j < 100; ++j) {
      Vector6d v = Vector6d::Zero();
      for (const Vector6d& a : generators) v += Uniform(rng) * a / double(generators.size());
      const double noise = j % 2 ? 0.2 : 0.01;
      for (double& x : v) x += noise * Normal(rng);
      const double excess = FacetExcess(cone, v);
      if (std::abs(excess) < 1e-9) continue;
      const Sign side = exact::Side(reference, LiftVector(v));
      CHECK(side == (excess < 0 ? Sign::kNegative : Sign::kPositive));
      ++(excess < 0 ? inside : outside);
    }
  }
  CHECK(inside > 50);
  CHECK(outside > 50);
}

TEST_CASE("pyramids: inscribed edges lie on the cone, circumscribed ones contain it") {
  Rng rng(331);
  for (int i = 0; i < 50; ++i) {
    Eigen::Vector3d n(Normal(rng), Normal(rng), Normal(rng));
    const Contact c = PointContact({0, 0, 0}, n.normalized(), 0.2 + Uniform(rng));
    for (const int sides : {3, 4, 7, 16}) {
      std::vector<Eigen::Vector3d> in, out;
      AppendPyramid(c, sides, Pyramid::kInscribed, &in);
      AppendPyramid(c, sides, Pyramid::kCircumscribed, &out);
      REQUIRE(static_cast<int>(in.size()) == sides);
      for (int j = 0; j < sides; ++j) {
        CHECK((in[j] - c.n_W).norm() == Approx(c.friction));
        CHECK(in[j].dot(c.n_W) == Approx(1));
        // The middle of a circumscribed side touches the circle.
        const Eigen::Vector3d middle = 0.5 * (out[j] + out[(j + 1) % sides]);
        CHECK((middle - c.n_W).norm() == Approx(c.friction));
      }
    }
  }
  std::vector<Eigen::Vector3d> edges;
  AppendPyramid(PointContact({0, 0, 0}, {0, 0, 1}, 0.5), 4, Pyramid::kInscribed, &edges);
  CHECK(edges[0] == Eigen::Vector3d(0.5, 0, 1));  // x is the first of the axes least aligned with z
  CHECK((edges[1] - Eigen::Vector3d(0, 0.5, 1)).norm() < 1e-15);
  edges.clear();
  AppendPyramid(PointContact({0, 0, 0}, {0, 0, 1}, 0), 8, Pyramid::kInscribed, &edges);
  CHECK(edges.size() == 1);
}

}  // namespace
}  // namespace cguide::numeric
