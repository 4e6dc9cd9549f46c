#include "cguide/exact/cone.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cfenv>
#include <ppl.hh>
#include <random>
#include <string>

#include "cguide/exact/cone_membership.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "tests/exact/random_rationals.h"

namespace cguide::exact {
namespace {

namespace ppl = Parma_Polyhedra_Library;

// Loading PPL turns the rounding mode upwards; its integer polyhedra do without, and we must.
const bool kRoundingRestored = (ppl::restore_pre_PPL_rounding(), true);

VectorXq Vec(const std::vector<std::string>& x) {
  VectorXq v(static_cast<Eigen::Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) v[static_cast<Eigen::Index>(i)] = ParseRational(x[i]);
  return v;
}

ppl::Linear_Expression Expression(const VectorXq& v) {
  const VectorXq integral = Primitive(v);
  ppl::Linear_Expression e;
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    e += ppl::Coefficient(integral[i].get_num()) *
         ppl::Variable(static_cast<ppl::dimension_type>(i));
  }
  // Fixes the space dimension also where the last coefficients vanish.
  e += 0 * ppl::Variable(static_cast<ppl::dimension_type>(v.size() - 1));
  return e;
}

ppl::C_Polyhedron FromGenerators(const GeneratorCone& cone) {
  ppl::Generator_System system;
  ppl::Linear_Expression origin;
  origin += 0 * ppl::Variable(static_cast<ppl::dimension_type>(cone.dimension - 1));
  system.insert(ppl::point(origin));
  for (const VectorXq& r : cone.rays) {
    if (!IsZero(r)) system.insert(ppl::ray(Expression(r)));
  }
  for (const VectorXq& l : cone.lines) {
    if (!IsZero(l)) system.insert(ppl::line(Expression(l)));
  }
  return ppl::C_Polyhedron(system);
}

ppl::C_Polyhedron FromHalfspaces(const HalfspaceCone& cone) {
  ppl::C_Polyhedron polyhedron(static_cast<ppl::dimension_type>(cone.dimension));
  for (const VectorXq& h : cone.facets) polyhedron.add_constraint(Expression(h) <= 0);
  for (const VectorXq& e : cone.equations) polyhedron.add_constraint(Expression(e) == 0);
  return polyhedron;
}

template <typename System>
int Size(const System& system) {
  return static_cast<int>(std::distance(system.begin(), system.end()));
}

GeneratorCone RandomCone(std::mt19937& rng) {
  GeneratorCone cone;
  cone.dimension = 1 + static_cast<int>(rng() % 6);
  const int rays = static_cast<int>(rng() % 14), lines = rng() % 4 == 0 ? 1 : 0;
  const int size = 1 + static_cast<int>(rng() % 3);
  for (int i = 0; i < rays; ++i) cone.rays.push_back(RandomVectorX(rng, cone.dimension, size));
  for (int i = 0; i < lines; ++i) cone.lines.push_back(RandomVectorX(rng, cone.dimension, size));
  // Half of the pointed-looking ones in a half-space, so that not everything is the whole space.
  if (rng() % 2 == 0) {
    for (VectorXq& r : cone.rays) r[0] = abs(r[0]) + static_cast<int>(rng() % 2);
  }
  return cone;
}

}  // namespace

TEST_CASE("The rounding mode is to nearest while these tests run") {
  REQUIRE(kRoundingRestored);
  CHECK(std::fegetround() == FE_TONEAREST);
}

TEST_CASE("The double description agrees with the Parma Polyhedra Library on random cones") {
  std::mt19937 rng(1953);
  int whole = 0, flat = 0, pointed = 0;
  for (int round = 0; round < 400; ++round) {
    const GeneratorCone cone = RandomCone(rng);
    const HalfspaceCone facets = FacetsOf(cone);
    const ppl::C_Polyhedron peer = FromGenerators(cone);
    CAPTURE(round, cone.dimension, cone.rays.size(), facets.facets.size());
    REQUIRE(FromHalfspaces(facets) == peer);
    // PPL's minimal system counts an equation as one constraint, as we do.
    REQUIRE(Size(peer.minimized_constraints()) ==
            static_cast<int>(facets.facets.size() + facets.equations.size()));
    const GeneratorCone minimal = GeneratorsOf(facets);
    REQUIRE(FromGenerators(minimal) == peer);
    REQUIRE(Size(peer.minimized_generators()) ==
            static_cast<int>(minimal.rays.size() + minimal.lines.size()) + 1);  // and the apex
    whole += facets.facets.empty() && facets.equations.empty();
    flat += !facets.equations.empty();
    pointed += minimal.lines.empty() && !minimal.rays.empty();
  }
  CHECK(whole > 20);
  CHECK(flat > 20);
  CHECK(pointed > 20);
}

TEST_CASE("Results are canonical: order, scale and redundant copies of generators do not matter") {
  std::mt19937 rng(1954);
  for (int round = 0; round < 100; ++round) {
    GeneratorCone cone = RandomCone(rng);
    const HalfspaceCone facets = FacetsOf(cone);
    const GeneratorCone minimal = Minimal(cone);
    if (!cone.rays.empty()) {
      VectorXq copy = cone.rays[0];
      for (Rational& x : copy) x *= Rational(3, 7);
      cone.rays.push_back(copy);
      cone.rays.push_back(cone.rays[0] + cone.rays.back());
    }
    std::shuffle(cone.rays.begin(), cone.rays.end(), rng);
    REQUIRE(FacetsOf(cone) == facets);
    REQUIRE(Minimal(cone) == minimal);
    REQUIRE(FacetsOf(minimal) == facets);
    // The bipolar theorem.
    REQUIRE(GeneratorsOf(FacetsOf(minimal)) == minimal);
  }
}

TEST_CASE("Sides of facets and membership by linear programming agree") {
  std::mt19937 rng(1955);
  int counts[3] = {};
  for (int round = 0; round < 300; ++round) {
    GeneratorCone cone = RandomCone(rng);
    for (const VectorXq& l : cone.lines) {
      cone.rays.push_back(l);
      cone.rays.push_back(-l);
    }
    cone.lines.clear();
    VectorXq v = RandomVectorX(rng, cone.dimension, 2);
    if (rng() % 3 == 0 && !cone.rays.empty()) v = cone.rays[rng() % cone.rays.size()];
    const Sign side = Side(FacetsOf(cone), v);
    const Membership where = DecideConeMembership(cone.rays, v).where;
    REQUIRE((side == Sign::kNegative) == (where == Membership::kInterior));
    REQUIRE((side == Sign::kZero) == (where == Membership::kBoundary));
    ++counts[static_cast<int>(where)];
  }
  for (int count : counts) CHECK(count > 20);
}

TEST_CASE("Empty lists, zero vectors and single lines are cones") {
  const GeneratorCone origin{3, {}, {}};
  CHECK(FacetsOf(origin).equations.size() == 3);
  CHECK(FacetsOf(origin).facets.empty());
  CHECK(Minimal(origin) == origin);
  const GeneratorCone space = GeneratorsOf({3, {}, {}});
  CHECK(space.rays.empty());
  CHECK(space.lines.size() == 3);
  CHECK(FacetsOf(space) == HalfspaceCone{3, {}, {}});
  CHECK(Minimal({2, {Vec({"0", "0"})}, {}}) == GeneratorCone{2, {}, {}});
  // Opposite rays are a line, and a line given as such is the same cone.
  const GeneratorCone line{2, {}, {Vec({"1", "2"})}};
  CHECK(Minimal({2, {Vec({"1/2", "1"}), Vec({"-3", "-6"})}, {}}) == line);
  CHECK(FacetsOf({1, {Vec({"5"})}, {}}).facets == std::vector<VectorXq>{Vec({"-1"})});
  CHECK_THROWS_AS(FacetsOf({0, {}, {}}), Error);
  CHECK_THROWS_AS(FacetsOf({2, {Vec({"1"})}, {}}), Error);
}

TEST_CASE(
    "The stance on which cddlib loses nine facets has sixty-six, and v violates two of them") {
  // stability-anchors 2.2: forces x 2^20 | moments x 2^40, scaled to common units below.
  const std::vector<std::vector<std::string>> text{
      {"-257726", "257726", "983192", "-23772802452", "-324139924836", "78735808452"},
      {"-248949", "-312182", "969576", "-32324995956", "-113149002678", "-44731261265"},
      {"-983192", "257726", "257726", "-481887054390", "-1504487212494", "-333850777386"},
      {"-983192", "257726", "-257726", "-255440743558", "-1205248931026", "-230774894490"},
      {"-983192", "257726", "-257726", "-277469100230", "-1287709244066", "-229199820906"},
      {"-983192", "364479", "0", "-532467006621", "-1436344209608", "-167633551005"},
      {"-983192", "257726", "257726", "-475554211118", "-1584979175150", "-229199820906"},
      {"-983192", "257726", "-257726", "-250965589294", "-1289677594450", "-332275703802"},
      {"-983192", "364479", "0", "-533196693579", "-1438312559992", "-270709433901"},
      {"-983192", "257726", "257726", "-503089656958", "-1586947525534", "-332275703802"},
      {"-983192", "-257726", "257726", "250965589294", "-1586947525534", "-629545634886"},
      {"-983192", "-364479", "0", "533196693579", "-1438312559992", "-691111904787"},
      {"438510", "-446320", "841439", "813535239105", "219825647532", "-307367206290"},
      {"181912", "-550983", "873406", "944146757649", "-82460057676", "-248665242666"}};
  GeneratorCone cone{6, {}, {}};
  for (const auto& row : text) {
    VectorXq r = Vec(row);
    for (int k = 0; k < 6; ++k) r[k] /= mpz_class(1) << (k < 3 ? 20 : 40);
    cone.rays.push_back(r);
  }
  VectorXq v = VectorXq::Zero(6);
  v[2] = Lift(568.98);
  v[3] = Lift(129.24292253878212);
  v[4] = Lift(-48.702728382435055);
  const HalfspaceCone facets = FacetsOf(cone);
  CHECK(facets.facets.size() == 66);
  CHECK(facets.equations.empty());
  CHECK(std::count_if(facets.facets.begin(), facets.facets.end(),
                      [&](const VectorXq& h) { return Dot(h, v) > 0; }) == 2);
  CHECK(DecideConeMembership(cone.rays, v).where == Membership::kOutside);
  CHECK(FromHalfspaces(facets) == FromGenerators(cone));
}

}  // namespace cguide::exact
