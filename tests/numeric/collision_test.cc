#include <catch2/catch.hpp>

#include "cguide/numeric/geometry_internal.h"
#include "cguide/numeric/io/problem_reader.h"
#include "tests/numeric/geometry_models.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using test::Between;
using test::RandomConfiguration;
using test::RandomPoint;
using test::RandomQuaternion;
using test::RandomRobot;

ConvexShape RandomShape(std::mt19937_64& rng) {
  switch (rng() % 5) {
    case 0:
      return Box{RandomPoint(rng, 0.2).cwiseAbs() + Vector3d::Constant(0.02)};
    case 1:
      return Sphere{Between(rng, 0.02, 0.15)};
    case 2:
      return Capsule{Between(rng, 0.02, 0.08), Between(rng, 0.05, 0.3)};
    case 3:
      return Cylinder{Between(rng, 0.02, 0.1), Between(rng, 0.05, 0.3)};
    default:
      return test::RandomHull(rng, 10, 0.12);
  }
}

PieceShape RandomPiece(std::mt19937_64& rng) {
  if (rng() % 4 == 0)
    return test::BoxMesh(RandomPoint(rng, 0.4) - Vector3d::Ones() * 0.5, Vector3d::Ones() * 0.2);
  return std::visit([](const auto& s) -> PieceShape { return s; }, RandomShape(rng));
}

Model RandomModel(std::mt19937_64& rng) {
  Model model;
  model.robot = RandomRobot(rng, 16);
  for (Link& link : model.robot.links) {
    link.shapes.clear();
    for (std::size_t i = 0; i < rng() % 3; ++i) {
      link.shapes.push_back({{RandomPoint(rng, 0.1), RandomQuaternion(rng)}, RandomShape(rng)});
    }
  }
  for (int i = 0; i < 5; ++i) {
    model.objects.push_back(test::OneObject("o" + std::to_string(i), RandomPiece(rng),
                                            {RandomPoint(rng, 2), RandomQuaternion(rng)},
                                            Between(rng, 0.1, 1)));
  }
  model.objects.push_back(test::OneObject("floor", Halfspace{{0.1, 0, 1}, -1.5}));
  const auto neighbours = NeighbourBodies(model.robot);
  const int bodies = static_cast<int>(model.robot.bodies.size());
  for (int i = 0; i < bodies; ++i) {
    model.contact.bodies.push_back(i);
    for (int j = i + 1; j < bodies; ++j) {
      if (std::find(neighbours.begin(), neighbours.end(), std::make_pair(i, j)) ==
              neighbours.end() &&
          rng() % 2 == 0) {
        model.self_pairs.emplace_back(i, j);
      }
    }
  }
  for (int link = 0; link < static_cast<int>(model.robot.links.size()); ++link) {
    for (int k = 0; k < 4; ++k)
      model.sites.push_back({link, RandomPoint(rng, 0.15), k == 0 ? 0.02 : 0});
  }
  model.contact.epsilon = 0.1;
  return model;
}

Configuration Step(std::mt19937_64& rng, Configuration q) {
  for (double& x : q.joints) x += Between(rng, -0.05, 0.05);
  q.X_WB.p += RandomPoint(rng, 0.03);
  return q;
}

bool Identical(const Contact& a, const Contact& b) {
  return a.site == b.site && a.body == b.body && a.object == b.object && a.x_W == b.x_W &&
         a.y_W == b.y_W && a.n_W == b.n_W && a.distance == b.distance && a.friction == b.friction &&
         a.error == b.error && a.certain == b.certain;
}

TEST_CASE("a warm workspace answers like a fresh one along random walks") {
  std::mt19937_64 rng(1);
  StageCounts counts;
  for (int m = 0; m < 12; ++m) {
    const World world(RandomModel(rng));
    const std::vector<Pair> pairs = AllPairs(world);
    Workspace warm(world);
    Configuration q = RandomConfiguration(rng, world.model().robot);
    for (int i = 0; i < 150; ++i) {
      q = i % 50 == 0 ? RandomConfiguration(rng, world.model().robot) : Step(rng, q);
      Workspace fresh(world);
      Place(world, q, &warm);
      Place(world, q, &fresh);
      const FreeAnswer a = TestFree(world, &warm), b = TestFree(world, &fresh);
      CAPTURE(m, i);
      REQUIRE(a.verdict == b.verdict);
      if (a.verdict != Verdict::kHolds) REQUIRE(a.first == b.first);
      std::vector<Contact> c, d;
      FindContacts(world, &warm, &c);
      FindContacts(world, &fresh, &d);
      REQUIRE(c.size() == d.size());
      for (std::size_t k = 0; k < c.size(); ++k) REQUIRE(Identical(c[k], d[k]));
      const Pair& pair = pairs[rng() % pairs.size()];
      const Clearance e = PairClearance(world, pair, 1, &warm),
                      f = PairClearance(world, pair, 1, &fresh);
      REQUIRE(e.lo == f.lo);
      REQUIRE(e.hi == f.hi);
    }
    const StageCounts& w = warm.scratch->counts;
    counts.spheres += w.spheres;
    counts.cached += w.cached;
    counts.boxes += w.boxes;
    counts.gjk += w.gjk;
    counts.meets += w.meets;
  }
  // Every stage earns its place.
  CHECK(counts.spheres > 10000);
  CHECK(counts.cached > 1000);
  CHECK(counts.boxes > 1000);
  CHECK(counts.gjk > 50);
  CHECK(counts.meets > 100);
}

TEST_CASE("the collision test and the clearances agree") {
  std::mt19937_64 rng(2);
  int holds = 0, fails = 0;
  for (int m = 0; m < 20; ++m) {
    const World world(RandomModel(rng));
    const std::vector<Pair> pairs = AllPairs(world);
    Workspace workspace(world);
    for (int i = 0; i < 30; ++i) {
      Place(world, RandomConfiguration(rng, world.model().robot), &workspace);
      const FreeAnswer answer = TestFree(world, &workspace);
      bool apart = true, meets = false;
      Pair first;
      for (const Pair& pair : pairs) {
        const Clearance c = PairClearance(world, pair, INFINITY, &workspace);
        CAPTURE(m, i, pair.body, pair.other, pair.self, c.lo, c.hi);
        REQUIRE(c.lo <= c.hi);
        if (c.overlap && !meets) first = pair;
        apart = apart && c.lo > 0;
        meets = meets || c.overlap;
      }
      CAPTURE(m, i);
      if (answer.verdict == Verdict::kHolds) REQUIRE_FALSE(meets);
      if (apart) REQUIRE(answer.verdict == Verdict::kHolds);
      if (meets) {
        REQUIRE(answer.verdict == Verdict::kFails);
        REQUIRE(answer.first == first);
      }
      holds += answer.verdict == Verdict::kHolds;
      fails += answer.verdict == Verdict::kFails;
    }
  }
  CHECK(holds + fails == 600);
  CHECK(holds > 20);
  CHECK(fails > 20);
}

TEST_CASE("bodies that touch exactly are left undecided") {
  const World world(test::OneBodyModel({{{}, Box{{1, 1, 1}}}},
                                       {test::BoxObject("box", {-1, -1, -1}, {1, 1, 0})}));
  Workspace workspace(world);
  Place(world, test::At(Vector3d(0, 0, 0.5)), &workspace);
  CHECK(TestFree(world, &workspace).verdict == Verdict::kUndecided);
  CHECK(TestFree(world, &workspace).first == Pair{0, 0, false});
  Place(world, test::At(Vector3d(0, 0, 0.5 + 1e-13)), &workspace);
  CHECK(TestFree(world, &workspace).verdict == Verdict::kHolds);
  Place(world, test::At(Vector3d(0, 0, 0.5 - 1e-12)), &workspace);
  CHECK(TestFree(world, &workspace).verdict == Verdict::kFails);
}

TEST_CASE("the chair problem starts and ends free, and sinking into the seat fails") {
  const Problem problem =
      io::ReadProblem(std::string(CGUIDE_FIXTURES) + "/problems/chair_and_table.yaml");
  const World world(problem.model);
  Workspace workspace(world);
  for (const Configuration& q : {problem.start, problem.goal}) {
    Place(world, q, &workspace);
    CHECK(TestFree(world, &workspace).verdict == Verdict::kHolds);
    std::vector<Contact> contacts;
    FindContacts(world, &workspace, &contacts);
    int soles = 0;
    for (const Contact& c : contacts) soles += world.model().objects[c.object].name == "floor";
    CHECK(soles >= 8);
  }
  Configuration low = problem.start;
  low.X_WB.p.z() -= 0.05;
  Place(world, low, &workspace);
  CHECK(TestFree(world, &workspace).verdict == Verdict::kFails);
  CHECK_FALSE(TestFree(world, &workspace).first.self);
}

}  // namespace
}  // namespace cguide::numeric
