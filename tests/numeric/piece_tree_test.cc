#include <catch2/catch.hpp>
#include <random>

#include "cguide/numeric/geometry_internal.h"
#include "tests/numeric/geometry_models.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using test::Between;
using test::RandomPoint;

PieceShape SomePiece(std::mt19937_64& rng) {
  switch (rng() % 5) {
    case 0:
      return Box{RandomPoint(rng, 0.2).cwiseAbs() + Vector3d::Constant(0.01)};
    case 1:
      return Sphere{0.1};
    case 2:
      return Capsule{0.05, 0.3};
    case 3:
      return Halfspace{{0, 0, 1}, -3};
    default:
      return Surface{{{0, 0, 0}, {0.2, 0, 0}, {0, 0.3, 0.1}}, {{0, 1, 2}}};
  }
}

TEST_CASE("A tree finds the pieces that a look at every box finds, in order") {
  std::mt19937_64 rng(21);
  int found = 0, left_out = 0;
  for (const int pieces : {0, 1, 4, 5, 60}) {
    for (int trial = 0; trial < 20; ++trial) {
      std::vector<Object> objects;
      for (int p = 0; p < pieces; ++p) {
        // Many at one place, so that medians tie.
        const Vector3d at = rng() % 3 ? RandomPoint(rng, 2) : Vector3d(0.5, 0.5, 0.5);
        objects.push_back(test::OneObject("o" + std::to_string(p), SomePiece(rng),
                                          {at, test::RandomQuaternion(rng)}));
      }
      const World world(test::OneBodyModel({{{}, Sphere{0.1}}}, objects));
      const Geometry& g = world.geometry();
      const PieceTree& tree = g.piece_tree;
      for (int query = 0; query < 20; ++query) {
        const Vector3d lower = RandomPoint(rng, 2), upper = lower + RandomPoint(rng, 1).cwiseAbs();
        const double reach = rng() % 2 ? 0 : Between(rng, 0, 0.5);
        std::vector<int> expected;
        for (int p = 0; p < static_cast<int>(g.pieces.size()); ++p) {
          const bool everywhere = g.pieces[p].kind == PieceKind::kHalfspace;
          if (everywhere || !BoxesApart(Widened({lower, upper}, reach), tree.Box(p))) {
            expected.push_back(p);
          }
        }
        const std::vector<int> near = tree.Near(lower, upper, reach);
        CHECK(near == expected);
        found += static_cast<int>(near.size());
        left_out += static_cast<int>(g.pieces.size() - near.size());
      }
    }
  }
  CHECK(found > 1000);
  CHECK(left_out > 1000);
}

TEST_CASE("Boxes hold their pieces") {
  std::mt19937_64 rng(22);
  for (int trial = 0; trial < 300; ++trial) {
    const Pose X{RandomPoint(rng, 5), test::RandomQuaternion(rng)};
    const World world(
        test::OneBodyModel({{{}, Sphere{0.1}}}, {test::OneObject("o", SomePiece(rng), X)}));
    const ObstaclePiece& piece = world.geometry().pieces[0];
    if (piece.kind != PieceKind::kConvex) continue;
    const PieceTree& tree = world.geometry().piece_tree;
    const auto& [lower, upper] = tree.Box(0);
    for (int k = 0; k < 20; ++k) {
      const Vector3d n = RandomPoint(rng, 1).normalized();
      const Vector3d p = CoreSupport(piece.convex, n) + piece.convex.c + piece.convex.radius * n;
      CHECK((p.array() >= lower.array()).all());
      CHECK((p.array() <= upper.array()).all());
    }
  }
}

}  // namespace
}  // namespace cguide::numeric
