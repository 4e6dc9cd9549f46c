// What a proof costs in a room of many boxes: bytes, time to find it, time to check it, and what of
// the bytes is said about obstacles. The room: four walls of bricks about the problem's own, askew,
// with shelves full of boxes before them; boxes that the guides come too near to are left out.
// One thread, one run; CPU time.
//   boxes_benchmark [PROBLEM] [SEEDS] [BOXES]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "cguide/numeric/membership.h"
#include "cguide/numeric/near_pairs.h"
#include "cguide/verify/certificate_writer.h"
#include "cguide/verify/check/check.h"
#include "cguide/verify/edge_collision.h"
#include "cguide/verify/edge_stability.h"
#include "tests/benchmark/guide_edges.h"
#include "tests/benchmark/timing.h"

namespace {

using namespace cguide;  // NOLINT: a program of one file
using benchmark_tools::GuideEdges;
using benchmark_tools::Mean;
using benchmark_tools::MicrosecondsOf;
using benchmark_tools::Quantile;
using Eigen::Vector3d;

/** Box i of `count`: the first half are bricks of the walls, the others stand on shelves and on the
 floor in the annulus before them. Turned by half a radian about z, some a little more. */
Piece BoxOf(int i, int count, std::mt19937_64* rng) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto between = [&](double a, double b) { return a + (b - a) * unit(*rng); };
  Vector3d size, p;
  double turn = 0.5;
  if (i < count / 2) {
    const int side = i % 4, columns = 24, column = (i / 4) % columns, row = i / 4 / columns;
    const double along = -1.8 + 3.6 * (column + 0.5 * (row % 2)) / columns;
    size = {3.6 / columns - 0.004, 0.1, 0.116};
    p = {along, 1.8, 0.06 + 0.12 * row};
    for (int k = 0; k < side; ++k) p = Vector3d(-p.y(), p.x(), p.z());
    if (side % 2 == 1) std::swap(size.x(), size.y());
  } else {
    size = {between(0.03, 0.12), between(0.03, 0.12), between(0.03, 0.2)};
    const double angle = between(0, 2 * M_PI), out = between(0.5, 1.7);
    const int shelf = static_cast<int>(between(0, 5));
    p = {out * std::cos(angle), out * std::sin(angle), 0.002 + 0.35 * shelf + 0.5 * size.z()};
    turn = between(0, M_PI);
  }
  const double c = std::cos(0.5), s = std::sin(0.5);
  p = Vector3d(c * p.x() - s * p.y() + 0.25, s * p.x() + c * p.y() + 0.35, p.z());
  return {{p, {0, 0, std::sin(turn / 2), std::cos(turn / 2)}}, Box{size}};
}

/** Each box an object of its own, until those that the edges meet, or nearly meet, are gone. */
std::vector<Piece> FreeBoxes(const Model& model, const std::vector<Edge>& edges, int count) {
  std::mt19937_64 rng(1);
  std::vector<Piece> boxes;
  for (int i = 0; i < count; ++i) boxes.push_back(BoxOf(i, count, &rng));
  for (const Edge& edge : edges) {
    Model room = model;
    for (const Piece& box : boxes) {
      Piece wider = box;
      for (int k = 0; k < 3; ++k) std::get<Box>(wider.geometry).size[k] += 0.01;
      room.objects.push_back({"box", 0.6, {wider}});
    }
    const numeric::World world(room);
    numeric::Workspace workspace(world);
    std::vector<char> meets(boxes.size(), 0);
    for (int k = 0; k <= 20; ++k) {
      Place(world, Interpolate(edge, k / 20.0), &workspace);
      for (std::size_t b = 0; b < boxes.size(); ++b) {
        if (meets[b]) continue;
        const int object = static_cast<int>(model.objects.size() + b);
        for (std::size_t body = 0; body < model.robot.bodies.size() && !meets[b]; ++body) {
          const numeric::Pair pair{static_cast<int>(body), object, false};
          meets[b] = PairClearance(world, pair, 0.01, &workspace).lo < 0.01;
        }
      }
    }
    std::vector<Piece> kept;
    for (std::size_t b = 0; b < boxes.size(); ++b) {
      if (!meets[b]) kept.push_back(boxes[b]);
    }
    boxes = kept;
  }
  return boxes;
}

struct Bytes {
  double all = 0, apart = 0, self = 0, balance = 0;
};

void Add(const check::Node& node, Bytes* bytes) {
  const auto size = [](const check::Node& part) {
    return static_cast<double>(verify::WriteProof({0, {}, part}).size()) - 22;
  };
  check::Node part = node;
  part.halves.clear();
  part.balance.reset();
  part.self_apart.clear();
  bytes->apart += size(part);
  part = {};
  part.self_apart = node.self_apart;
  bytes->self += size(part);
  part = {};
  part.balance = node.balance;
  bytes->balance += size(part);
  for (const check::Node& half : node.halves) Add(half, bytes);
}

void Report(const numeric::World& world, const std::vector<Edge>& edges, int repeats) {
  verify::EdgeWorkspace collision(world);
  verify::StabilityEdgeWorkspace stability(world);
  check::Checker checker(world.model());
  std::vector<double> free, balance, checked, bytes;
  Bytes sum;
  long leaves = 0, refused = 0;
  for (const Edge& edge : edges) {
    verify::EdgeEvidence evidence;
    verify::EdgeCollisionOptions collision_options;
    verify::EdgeStabilityOptions stability_options;
    collision_options.evidence = stability_options.evidence = &evidence;
    verify::EdgeCollision found;
    const double us = MicrosecondsOf(repeats, [&] {
      evidence = {};
      found = DecideEdgeCollision(world, edge, collision_options, &collision);
    });
    if (found.verdict != Verdict::kHolds) continue;
    Verdict verdict = Verdict::kUndecided;
    const double balance_us = MicrosecondsOf(1, [&] {
      verdict = DecideEdgeStability(world, edge, stability_options, &stability).verdict;
    });
    if (verdict != Verdict::kHolds) continue;
    const check::EdgeProof proof = AssembleProof(0, evidence);
    std::string refusal;
    const double check_us = MicrosecondsOf(1, [&] { refusal = checker.CheckEdge(edge, proof); });
    if (!refusal.empty()) {
      std::printf("  refused: %s\n", refusal.c_str());
      ++refused;
      continue;
    }
    free.push_back(us / 1000);
    balance.push_back(balance_us / 1000);
    checked.push_back(check_us / 1000);
    bytes.push_back(static_cast<double>(verify::WriteProof(proof).size()) / 1000);
    Add(proof.root, &sum);
    leaves += found.leaves;
  }
  const double n = static_cast<double>(bytes.size());
  std::printf("%zu pieces, %zu edges proved, %ld refused; %.1f leaves of collision an edge\n",
              world.model().objects.back().pieces.size() + world.model().objects.size() - 1,
              bytes.size(), refused, static_cast<double>(leaves) / n);
  std::printf("  found: collisions %.2f ms, contact and balance %.2f ms; checked in %.2f ms\n",
              Mean(free), Mean(balance), Mean(checked));
  std::printf(
      "  a proof: mean %.1f kB, 95th percentile %.1f kB; obstacles %.1f, self %.1f, balance %.1f\n",
      Mean(bytes), Quantile(bytes, 0.95), sum.apart / n / 1000, sum.self / n / 1000,
      sum.balance / n / 1000);
}

/** What a planner asks of every configuration. */
void ReportMembership(const numeric::World& world, const std::vector<Edge>& edges) {
  numeric::GuideWorkspace workspace(world);
  std::vector<numeric::NearPair> near;
  std::vector<double> test, pairs;
  for (const Edge& edge : edges) {
    const Configuration q = Interpolate(edge, 0.5);
    test.push_back(MicrosecondsOf(
        10, [&] { TestConfiguration(world, q, numeric::Space::kGuide, &workspace); }));
    pairs.push_back(MicrosecondsOf(
        10, [&] { numeric::FindNearPairs(world, 0.03, &workspace.geometry, &near); }));
  }
  std::printf("  a configuration: tested in %.0f us, pairs within 30 mm found in %.0f us\n",
              Mean(test), Mean(pairs));
}

}  // namespace

int main(int argc, char** argv) {
  const benchmark_tools::Room room(argc > 1 ? argv[1]
                                            : CGUIDE_FIXTURES "/problems/chair_and_table.yaml");
  const std::vector<Edge> edges = GuideEdges(room, argc > 2 ? std::atoi(argv[2]) : 3);
  const int count = argc > 3 ? std::atoi(argv[3]) : 3600;
  Report(room.world, edges, 3);
  ReportMembership(room.world, edges);
  Model full = room.problem.model;
  full.objects.push_back({"boxes", 0.6, FreeBoxes(room.problem.model, edges, count)});
  const numeric::World world(full);
  Report(world, edges, 1);
  ReportMembership(world, edges);
  return 0;
}
