#include <random>

#include "cguide/numeric/triangle_distance.h"
#include "tests/benchmark/distance_section.h"
#include "tests/benchmark/timing.h"
#include "tests/cases/triangle_sets.h"
#include "tests/peers/fcl_peer.h"

namespace cguide::benchmark_tools {
namespace {

using Points = std::vector<Eigen::Vector3d>;

volatile double sink = 0;  // Keeps results alive.

struct MeshShape {
  int rows;
  int columns;
  int twins;  // pairs compared with the textbook, which takes its time
};

long MeshRow(std::FILE* out, const MeshShape& shape, int count, std::mt19937_64& rng) {
  std::vector<double> ours, fcl, textbook, ratio, rational;
  long wrong = 0, pairs = 0, candidates = 0, features = 0;
  for (int i = 0; i < count; ++i) {
    test::TriangleCase a = test::BumpySphere(rng, shape.rows, shape.columns, 0.3);
    test::TriangleCase b = test::BumpySphere(rng, shape.rows, shape.columns, 0.3);
    test::Move(&b, test::cases::Uniform(rng, 0.7, 1.1) * test::cases::Direction(rng));
    const numeric::TriangleTree p(a.vertices, a.triangles), q(b.vertices, b.triangles);
    const auto peer_a = peers::FclObject::Mesh(a.vertices, a.triangles),
               peer_b = peers::FclObject::Mesh(b.vertices, b.triangles);
    numeric::TriangleTreeDistance distance, turned;
    exact::LinkPlacement X = exact::ExactPlacement({{0.1, 0.2, 0.3}, {0.3, -0.1, 0.7, 0.5}});
    rational.push_back(
        MicrosecondsOf(3, [&] { turned = SquaredTriangleDistance(p.Placed(X), q.Placed(X)); }));
    fcl.push_back(MicrosecondsOf(3, [&] { sink = peers::FclDistance(peer_a, peer_b, 1e-6); }));
    ours.push_back(MicrosecondsOf(3, [&] { distance = SquaredTriangleDistance(p, q); }));
    ratio.push_back(ours.back() / fcl.back());
    wrong += turned.squared != distance.squared;  // Motions keep distances, here exactly.
    pairs += distance.pairs;
    candidates += distance.candidates;
    features += distance.features;
    if (i >= shape.twins) continue;
    const exact::LinkPlacement at = exact::ExactPlacement(Pose{});
    const auto exact_a = exact::MakeTriangleSet(a.vertices, a.triangles, at),
               exact_b = exact::MakeTriangleSet(b.vertices, b.triangles, at);
    Rational squared;
    textbook.push_back(MicrosecondsOf(
        1, [&] { squared = exact::SquaredTriangleDistance(exact_a, exact_b).squared; }));
    wrong += squared != distance.squared;
  }
  std::fprintf(out, "%-8d %10.0f %10.1f %10.1f %10.1f %8.2f   %8.1f %6.1f %6.1f %6ld\n",
               2 * shape.columns * (shape.rows - 1), Median(textbook), Median(fcl), Median(ours),
               Median(rational), Median(ratio), static_cast<double>(pairs) / count,
               static_cast<double>(candidates) / count, static_cast<double>(features) / count,
               wrong);
  return wrong;
}

// A hull, or a point, and a surface of 2000 faces.
long HullRow(std::FILE* out, int vertices, int count, std::mt19937_64& rng) {
  const test::TriangleCase surface = test::BumpySphere(rng, 26, 40, 0.3);
  const numeric::TriangleTree tree(surface.vertices, surface.triangles);
  const auto set =
      exact::MakeTriangleSet(surface.vertices, surface.triangles, exact::ExactPlacement(Pose{}));
  std::vector<double> ours, textbook;
  long wrong = 0;
  for (int i = 0; i < count; ++i) {
    Points hull = test::cases::Ellipsoid(rng, vertices, 0.2);
    test::cases::Move(&hull, test::cases::Uniform(rng, 0.6, 1) * test::cases::Direction(rng));
    numeric::TriangleTreeDistance distance;
    Rational squared;
    ours.push_back(MicrosecondsOf(10, [&] { distance = SquaredTriangleDistance(hull, tree); }));
    std::vector<Vector3q> points;
    for (const Eigen::Vector3d& p : hull) points.push_back(Lift(p));
    textbook.push_back(
        MicrosecondsOf(1, [&] { squared = exact::SquaredTriangleDistance(points, set).squared; }));
    wrong += squared != distance.squared;
  }
  std::fprintf(out, "hull of %d to 2000 faces: textbook %.0f, ours %.1f, differ %ld\n", vertices,
               Median(textbook), Median(ours), wrong);
  return wrong;
}

}  // namespace

long ReportTriangleDistances(std::FILE* out, int count) {
  std::fprintf(
      out,
      "\nTriangle sets: exact squared distance, ours; FCL's float one (OBBRSS); the\n"
      "textbook twin; ours after placing both by a rational motion (us, medians); ours / FCL;\n"
      "pairs bounded, candidates, features\n");
  std::fprintf(out, "%-8s %10s %10s %10s %10s %8s   %8s %6s %6s %6s\n", "faces", "textbook", "FCL",
               "ours", "over Q", "ours/FCL", "pairs", "cand.", "feat.", "differ");
  std::mt19937_64 rng(55);
  long wrong = 0;
  for (const MeshShape& shape :
       {MeshShape{3, 3, 20}, MeshShape{11, 10, 10}, MeshShape{26, 40, 2}}) {
    wrong += MeshRow(out, shape, count, rng);
  }
  for (const int vertices : {1, 20}) wrong += HullRow(out, vertices, count / 2, rng);
  return wrong;
}

}  // namespace cguide::benchmark_tools
