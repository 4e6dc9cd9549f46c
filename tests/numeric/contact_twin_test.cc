// numeric::FindContacts and exact::FindContacts about the same robots and rooms.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/numeric/contact_agreement.h"
#include "tests/numeric/geometry_models.h"
#include "tests/planner/room.h"

namespace cguide::numeric {
namespace {

using exact::FoundContact;
using test::Between;
using test::OneObject;
using test::RandomPoint;
using test::RandomQuaternion;
using testing::Agree;

struct Counts {
  int certain = 0;         ///< contacts certain on both sides
  int doubtful_fast = 0;   ///< certain in exact arithmetic, listed as possible in floats
  int doubtful_exact = 0;  ///< not certain even in exact arithmetic
  int possible_only = 0;   ///< possible in floats, none in truth
};

class Twins {
 public:
  explicit Twins(const Model& model) : world_(model), workspace_(world_), scene_(model) {}

  void Compare(const Configuration& q, Counts* counts) {
    Place(world_, q, &workspace_);
    FindContacts(world_, &workspace_, &fast_);
    const auto slow =
        exact::FindContacts(scene_, exact::PlaceRobot(world_.model().robot, q, 106), {170});
    for (const FoundContact& c : slow) FindInFast(c, counts);
    for (const Contact& c : fast_) FindInSlow(c, slow, counts);
  }

 private:
  // Every exact contact is at least possible in the float list, and certain there only if it is.
  void FindInFast(const FoundContact& c, Counts* counts) {
    bool found = false, certain = false;
    for (const Contact& f : fast_) {
      if (!Agree(f, c)) continue;
      found = true;
      certain = certain || f.certain;
    }
    CAPTURE(c.site, c.object, c.contact.certain, NearestDouble(c.distance), NearestDouble(c.y[0]),
            NearestDouble(c.y[1]), NearestDouble(c.y[2]));
    REQUIRE(found);
    counts->certain += certain && c.contact.certain;
    counts->doubtful_fast += !certain && c.contact.certain;
    counts->doubtful_exact += !c.contact.certain;
  }

  // Every certain float contact is a certain exact one.
  static void FindInSlow(const Contact& f, const std::vector<FoundContact>& slow, Counts* counts) {
    bool found = false, certain = false;
    for (const FoundContact& c : slow) {
      if (!Agree(f, c)) continue;
      found = true;
      certain = certain || c.contact.certain;
    }
    CAPTURE(f.site, f.object, f.certain, f.distance, f.error, f.y_W.transpose());
    if (f.certain) REQUIRE(certain);
    counts->possible_only += !found;
  }

  World world_;
  Workspace workspace_;
  exact::ContactScene scene_;
  std::vector<Contact> fast_;
};

PieceShape RandomShape(int kind, std::mt19937_64& rng) {
  const auto size = [&] { return Between(rng, 0.05, 0.4); };
  switch (kind) {
    case 0:
      return Box{{size(), size(), size()}};
    case 1:
      return Sphere{size()};
    case 2:
      return Capsule{size() / 2, size()};
    case 3:
      return Cylinder{size(), size()};
    case 4:
      return test::RandomHull(rng, 8, 0.3);
    case 5:
      return Halfspace{RandomPoint(rng, 1), Between(rng, -1, -0.5)};
    case 6: {
      const Solid mesh = test::BoxMesh({-size(), -size(), -size()}, {size(), size(), size()});
      return Surface{mesh.vertices, {mesh.triangles.begin(), mesh.triangles.begin() + 7}};
    }
    default:
      return test::BoxMesh({-size(), -size(), -size()}, {size(), size(), size()});
  }
}

/** Overlapping objects of every kind around a tree of links with sites of all sizes. */
Model RandomModel(std::mt19937_64& rng) {
  Model model;
  model.robot = test::RandomRobot(rng, 6);
  for (int i = 0; i < 10; ++i) {
    model.objects.push_back(OneObject(
        "object", RandomShape((i + static_cast<int>(rng() % 3)) % 8, rng),
        {RandomPoint(rng, 0.8), RandomQuaternion(rng)}, 0.25 * static_cast<double>(1 + rng() % 4)));
  }
  for (int link = 0; link < 6; ++link) {
    for (int k = 0; k < 3; ++k) {
      model.sites.push_back({link, RandomPoint(rng, 0.3), k == 0 ? 0.0 : Between(rng, 0, 0.1)});
    }
  }
  for (int b = 0; b < static_cast<int>(model.robot.bodies.size()); ++b) {
    model.contact.bodies.push_back(b);
  }
  model.contact.epsilon = 0.15;
  model.contact.seam = rng() % 2 ? 0.001 : 0.02;
  return model;
}

Configuration Disturbed(Configuration q, double size, std::mt19937_64& rng) {
  std::normal_distribution<double> normal(0, size);
  for (double& x : q.X_WB.p) x += normal(rng);
  q.X_WB.q.x += normal(rng);
  q.X_WB.q.y += normal(rng);
  for (double& x : q.joints) x += normal(rng);
  return q;
}

}  // namespace

TEST_CASE("contacts in floats and over the rationals agree in random rooms of every shape") {
  std::mt19937_64 rng(20261126);
  Counts counts;
  for (int i = 0; i < 100; ++i) {
    const Model model = RandomModel(rng);
    Twins twins(model);
    for (int k = 0; k < 4; ++k) {
      CAPTURE(i, k);
      twins.Compare(test::RandomConfiguration(rng, model.robot), &counts);
    }
  }
  CAPTURE(counts.certain, counts.doubtful_fast, counts.doubtful_exact, counts.possible_only);
  CHECK(counts.certain > 500);
  CHECK(counts.doubtful_exact == 0);
  CHECK(counts.doubtful_fast < counts.certain / 50);
}

TEST_CASE("contacts in floats and over the rationals agree in the rooms of the fixtures") {
  for (const char* name : {"chair_and_table", "stairs_mesh", "stairs", "sofa"}) {
    const test::Room room(name);
    Twins twins(room.problem.model);
    std::mt19937_64 rng(5);
    Counts counts;
    for (int i = 0; i < 30; ++i) {
      CAPTURE(name, i);
      const Configuration& from = i % 2 == 0 ? room.problem.start : room.problem.goal;
      twins.Compare(Disturbed(from, i < 2 ? 0 : 0.01 * (i % 5), rng), &counts);
    }
    CAPTURE(name, counts.certain, counts.doubtful_fast, counts.doubtful_exact,
            counts.possible_only);
    CHECK(counts.certain > 50);
    CHECK(counts.doubtful_exact == 0);
  }
}

}  // namespace cguide::numeric
