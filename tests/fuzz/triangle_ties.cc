// Near ties of sets of triangles: two pairs of triangles, far from one another, whose distances
// differ by a tiny step, so that which is closest is the question; and pairs that touch or nearly
// do.
#include <array>

#include "cguide/exact/convex_distance.h"
#include "cguide/exact/kinematics.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/triangle_distance.h"
#include "cguide/numeric/triangle_distance.h"
#include "tests/fuzz/near_ties.h"
#include "tests/fuzz/twins.h"

namespace cguide::fuzz {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<Vector3d, 3>;

Triangle GridTriangle(TieRng& rng) {
  return {GridPoint(rng, 16, 16), GridPoint(rng, 16, 16), GridPoint(rng, 16, 16)};
}

Triangle Moved(const Triangle& t, const Vector3d& by) { return {t[0] + by, t[1] + by, t[2] + by}; }

// A point of the triangle with few bits: a corner, the middle of an edge, a point inside.
Vector3d PointOf(TieRng& rng, const Triangle& t) {
  switch (Below(rng, 3)) {
    case 0:
      return t[rng() % 3];
    case 1:
      return (t[0] + t[1]) / 2;
    default:
      return (2 * t[0] + t[1] + t[2]) / 4;
  }
}

/** Two triangles with a common point, or one above the other by a multiple of 1/16. */
std::array<Triangle, 2> BasePair(TieRng& rng) {
  const Triangle a = GridTriangle(rng);
  Triangle b = GridTriangle(rng);
  if (Below(rng, 4) == 0) b = Moved(a, GridPoint(rng, 4, 4));  // parallel, edge to edge
  b = Moved(b, PointOf(rng, a) - PointOf(rng, b));
  if (Below(rng, 2) == 0) b = Moved(b, GridPoint(rng, 32, 16));
  return {a, b};
}

struct Soup {
  std::vector<Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;

  void Add(const Triangle& t) {
    const int n = static_cast<int>(vertices.size());
    vertices.insert(vertices.end(), t.begin(), t.end());
    triangles.push_back({n, n + 1, n + 2});
  }
};

struct Sets {
  Soup a;
  Soup b;
  bool tied = false;  ///< both pairs at the same distance
};

// The pair again at 16 m, with the second triangle moved by the step: two distances within |step|.
Sets MakeSets(TieRng& rng) {
  const auto [a, b] = BasePair(rng);
  const Vector3d far(16, 0, 0);
  const Vector3d step = TinyStep(rng) * Vector3d::Unit(Below(rng, 3));
  Sets sets;
  sets.tied = step.isZero(0);
  const bool swapped = Below(rng, 2) == 0;
  sets.a.Add(swapped ? Moved(a, far) : a);
  sets.a.Add(swapped ? a : Moved(a, far));
  sets.b.Add(Moved(b, step));
  sets.b.Add(Moved(b, far));
  if (Below(rng, 2) == 0) sets.b.Add({b[0], b[1], b[1]});  // a segment of the first
  return sets;
}

}  // namespace

std::string TiesOfTriangles(TieRng& rng, long every, Tally* tally) {
  const exact::LinkPlacement identity = exact::ExactPlacement(Pose{});
  for (int k = 0; k < 16; ++k) {
    const Sets sets = MakeSets(rng);
    const numeric::TriangleTree a(sets.a.vertices, sets.a.triangles);
    const numeric::TriangleTree b(sets.b.vertices, sets.b.triangles);
    const auto ours = numeric::SquaredTriangleDistance(a, b);
    const auto exact_a = exact::MakeTriangleSet(sets.a.vertices, sets.a.triangles, identity);
    const auto exact_b = exact::MakeTriangleSet(sets.b.vertices, sets.b.triangles, identity);
    const auto twin = exact::SquaredTriangleDistance(exact_a, exact_b);
    ++tally->cases;
    tally->tied += sets.tied;
    ++(ours.candidates <= 1 ? tally->fast : tally->exact);
    if (twin.squared != ours.squared) return "the exact twin finds another distance";
    if (exact::SquaredNorm(ours.a - ours.b) != ours.squared) return "the closest pair is another";
    const auto& one = exact_a.triangles.at(static_cast<std::size_t>(ours.index_a));
    const auto& other = exact_b.triangles.at(static_cast<std::size_t>(ours.index_b));
    if (!SlowCheckIsDue(*tally, every)) continue;
    ++tally->checked;
    if (exact::SquaredConvexDistanceByQp(one, other).squared != ours.squared) {
      return "quadratic programming finds another distance for the closest triangles";
    }
  }
  return "";
}

}  // namespace cguide::fuzz
