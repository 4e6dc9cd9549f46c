// The cost of certifying the edges of guides, against sampling them: kinematics over a leaf, and
// freedom from collisions over whole edges; and against bounds on speeds. One thread, one run; CPU
// time.
//   edge_benchmark [PROBLEM] [SEEDS]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "cguide/verify/certificate_writer.h"
#include "cguide/verify/check/check.h"
#include "cguide/verify/edge_collision.h"
#include "cguide/verify/edge_stability.h"
#include "tests/benchmark/guide_edges.h"
#include "tests/benchmark/lipschitz_section.h"
#include "tests/benchmark/timing.h"

namespace {

using namespace cguide;  // NOLINT: a program of one file
using benchmark_tools::GuideEdges;
using benchmark_tools::Mean;
using benchmark_tools::MicrosecondsOf;
using benchmark_tools::Quantile;

template <int N>
void ReportKinematics(const numeric::World& world, const Edge& edge, double plain) {
  verify::TaylorState<N> placed;
  const double us = MicrosecondsOf(2000, [&] {
    verify::EvaluateEdge<N>(world.tree(), edge, {0.5 + 0x1p-6, 0x1p-6}, &placed);
  });
  std::printf(
      "  degree %d: %.2f us (%.1f plain evaluations), remainder of the centre of mass %.1e m\n", N,
      us, us / plain, placed.com_W.r.maxCoeff());
}

void ReportCollisions(const numeric::World& world, const std::vector<Edge>& edges) {
  verify::EdgeWorkspace workspace(world);
  numeric::GuideWorkspace sampling(world);
  std::vector<double> certified, sampled;
  long leaves = 0, tests = 0, holds = 0, fails = 0;
  for (const Edge& edge : edges) {
    verify::EdgeCollision result;
    certified.push_back(
        MicrosecondsOf(3, [&] { result = DecideEdgeCollision(world, edge, {}, &workspace); }));
    sampled.push_back(MicrosecondsOf(1, [&] {
      TestSampledEdge(world, edge, {.step = 0.001, .space = numeric::Space::kFree}, &sampling);
    }));
    leaves += result.leaves;
    tests += result.tests;
    holds += result.verdict == Verdict::kHolds;
    fails += result.verdict == Verdict::kFails;
  }
  const double n = static_cast<double>(edges.size());
  std::printf(
      "collisions of %zu guide edges, self-collision on: %ld hold, %ld fail, %ld undecided\n",
      edges.size(), holds, fails, static_cast<long>(edges.size()) - holds - fails);
  std::printf(
      "  whole edge: mean %.0f us, 95th percentile %.0f us; %.1f leaves, %.0f plane tests\n",
      Mean(certified), Quantile(certified, 0.95), static_cast<double>(leaves) / n,
      static_cast<double>(tests) / n);
  std::printf("  sampled at 0.001 by our fastest test: mean %.0f us (%.1fx)\n", Mean(sampled),
              Mean(sampled) / Mean(certified));
}

void ReportStability(const numeric::World& world, const std::vector<Edge>& edges) {
  verify::StabilityEdgeWorkspace workspace(world);
  std::vector<double> certified;
  long leaves = 0, holds = 0, fails = 0;
  for (const Edge& edge : edges) {
    verify::EdgeStability result;
    certified.push_back(
        MicrosecondsOf(1, [&] { result = DecideEdgeStability(world, edge, {}, &workspace); }));
    leaves += result.leaves;
    holds += result.verdict == Verdict::kHolds;
    fails += result.verdict == Verdict::kFails;
    if (result.verdict == Verdict::kUndecided) {
      std::printf("  undecided at s = %.9f: %s (%ld leaves)\n", result.s, result.reason.c_str(),
                  result.leaves);
    }
  }
  const double n = static_cast<double>(edges.size());
  std::printf("contact and balance of the same edges: %ld hold, %ld fail, %ld undecided\n", holds,
              fails, static_cast<long>(edges.size()) - holds - fails);
  std::printf("  whole edge: mean %.0f us, median %.0f us, 95th percentile %.0f us; %.1f leaves\n",
              Mean(certified), Quantile(certified, 0.5), Quantile(certified, 0.95),
              static_cast<double>(leaves) / n);
}

/** Finding a proof of a whole edge, all obligations, against re-checking it. */
void ReportProofs(const numeric::World& world, const std::vector<Edge>& edges) {
  verify::EdgeWorkspace collision(world);
  verify::StabilityEdgeWorkspace stability(world);
  check::Checker fast(world.model()), precise(world.model(), {128});
  std::vector<double> found, checked, precisely, bytes;
  long refused = 0;
  for (const Edge& edge : edges) {
    verify::EdgeEvidence evidence;
    verify::EdgeCollisionOptions collision_options;
    verify::EdgeStabilityOptions stability_options;
    collision_options.evidence = stability_options.evidence = &evidence;
    Verdict verdict = Verdict::kUndecided;
    const double us = MicrosecondsOf(1, [&] {
      evidence = {};
      verdict = DecideEdgeCollision(world, edge, collision_options, &collision).verdict;
      if (verdict == Verdict::kHolds) {
        verdict = DecideEdgeStability(world, edge, stability_options, &stability).verdict;
      }
    });
    if (verdict != Verdict::kHolds) continue;
    const check::EdgeProof proof = AssembleProof(0, evidence);
    std::string refusal;
    checked.push_back(MicrosecondsOf(1, [&] { refusal = fast.CheckEdge(edge, proof); }));
    if (!refusal.empty()) {
      std::printf("  refused: %s\n", refusal.c_str());
      ++refused;
      checked.pop_back();
      continue;
    }
    precisely.push_back(MicrosecondsOf(1, [&] { refusal = precise.CheckEdge(edge, proof); }));
    refused += !refusal.empty();
    found.push_back(us);
    bytes.push_back(static_cast<double>(verify::WriteProof(proof).size()));
  }
  std::printf("proofs of %zu edges, %ld refused: mean %.0f us to find, 95th percentile %.0f us\n",
              found.size(), refused, Mean(found), Quantile(found, 0.95));
  std::printf("  checked in doubles: mean %.0f us (%.1fx); in 128 bits: mean %.0f us (%.0fx)\n",
              Mean(checked), Mean(checked) / Mean(found), Mean(precisely),
              Mean(precisely) / Mean(found));
  std::printf("  %.1f kB a proof on average, 95th percentile %.1f kB\n", Mean(bytes) / 1000,
              Quantile(bytes, 0.95) / 1000);
}

}  // namespace

int main(int argc, char** argv) {
  const benchmark_tools::Room room(argc > 1 ? argv[1]
                                            : CGUIDE_FIXTURES "/problems/chair_and_table.yaml");
  const numeric::World& world = room.world;
  const std::vector<Edge> edges = GuideEdges(room, argc > 2 ? std::atoi(argv[2]) : 10);
  if (edges.empty()) {
    std::puts("no guide was found");
    return 1;
  }
  numeric::KinematicState placed;
  const double plain = MicrosecondsOf(
      2000, [&] { numeric::ForwardKinematics(world.tree(), edges[0].from, &placed); });
  std::printf("kinematics over 1/32 of an edge, %zu bodies; one plain evaluation: %.2f us\n",
              world.tree().bodies.size(), plain);
  ReportKinematics<0>(world, edges[0], plain);
  ReportKinematics<1>(world, edges[0], plain);
  ReportKinematics<2>(world, edges[0], plain);
  ReportKinematics<3>(world, edges[0], plain);
  ReportCollisions(world, edges);
  ReportStability(world, edges);
  ReportProofs(world, edges);
  return benchmark::ReportLipschitz(room.problem, edges, 200) == 0 ? 0 : 1;
}
