#include "tests/benchmark/lipschitz_section.h"

#include <cmath>
#include <cstdio>
#include <vector>

#include "cguide/numeric/sampled_edge.h"
#include "cguide/planner/extension.h"
#include "cguide/verify/edge_collision.h"
#include "cguide/verify/edge_stability.h"
#include "tests/benchmark/lipschitz_edge.h"
#include "tests/benchmark/timing.h"
#include "tests/verify/pendulum.h"

namespace cguide::benchmark {
namespace {

using benchmark_tools::GeometricMean;
using benchmark_tools::Mean;
using benchmark_tools::Median;
using benchmark_tools::MicrosecondsOf;
using benchmark_tools::Quantile;
using test::Pendulum;

/** The certifier's answer to what LipschitzTester is asked: the model asks for contact alone. */
class Certifier {
 public:
  explicit Certifier(const numeric::World& world)
      : world_(world), collision_(world), stability_(world) {}

  Verdict Decide(const Edge& edge) {
    const auto free = DecideEdgeCollision(world_, edge, {}, &collision_);
    leaves = free.leaves;
    if (free.verdict != Verdict::kHolds) return free.verdict;
    const auto kept = DecideEdgeStability(world_, edge, {}, &stability_);
    leaves += kept.leaves;
    return kept.verdict;
  }

  long leaves = 0;

 private:
  const numeric::World& world_;
  verify::EdgeWorkspace collision_;
  verify::StabilityEdgeWorkspace stability_;
};

/** Edges as the planner makes them: chains of projected extensions towards random samples. */
std::vector<Edge> Extensions(const numeric::World& world, const numeric::SamplingRules& sampling,
                             int count, double step) {
  planner::ProjectionWorkspace workspace(world);
  planner::ExtensionOptions options;
  options.step = step;
  planner::PlannerCounters counters;
  const EdgeOracle oracle = numeric::MakeSampledOracle(world, {0.005});
  const planner::ExtensionContext context{world, oracle, options, &workspace, &counters};
  numeric::Rng rng(1);
  const auto sample = [&] {
    return numeric::SampleConfiguration(sampling, world.model().robot, rng);
  };
  std::vector<Edge> edges;
  for (int tries = 0; tries < 100000 && static_cast<int>(edges.size()) < count; ++tries) {
    auto at = planner::MoveIntoSpace(sample(), context);
    for (int i = 0; at && i < 6 && static_cast<int>(edges.size()) < count; ++i) {
      const auto next = planner::Extend(*at, sample(), context);
      if (next) edges.push_back({*at, *next});
      if (next) at = next;
    }
  }
  return edges;
}

struct Tally {
  std::vector<double> ours, theirs, ratios;  // us, on edges that both prove
  double our_leaves = 0, their_nodes = 0;
  int held = 0, held_by_peer = 0, contradicted = 0;
};

Tally Compare(const numeric::World& world, const std::vector<Edge>& edges, SpeedBounds bounds) {
  Certifier certifier(world);
  LipschitzTester tester(world, {bounds});
  Tally tally;
  for (const Edge& edge : edges) {
    Verdict verdict = Verdict::kUndecided;
    LipschitzEdge peer;
    const double ours = MicrosecondsOf(3, [&] { verdict = certifier.Decide(edge); });
    const double theirs = MicrosecondsOf(1, [&] { peer = tester.Test(edge); });
    tally.held += verdict == Verdict::kHolds;
    tally.held_by_peer += peer.verdict == Verdict::kHolds;
    tally.contradicted += (verdict == Verdict::kHolds && peer.verdict == Verdict::kFails) ||
                          (verdict == Verdict::kFails && peer.verdict == Verdict::kHolds);
    if (verdict != Verdict::kHolds || peer.verdict != Verdict::kHolds) continue;
    tally.ours.push_back(ours);
    tally.theirs.push_back(theirs);
    tally.ratios.push_back(theirs / ours);
    tally.our_leaves += static_cast<double>(certifier.leaves);
    tally.their_nodes += static_cast<double>(peer.nodes);
  }
  return tally;
}

int ReportEdges(const char* name, const numeric::World& world, const std::vector<Edge>& edges) {
  int contradicted = 0;
  for (const SpeedBounds bounds : {SpeedBounds::kAlongChain, SpeedBounds::kFromCommonBody}) {
    const Tally t = Compare(world, edges, bounds);
    contradicted += t.contradicted;
    if (t.ours.empty()) {
      std::printf("| %s | %zu | none proved by both | | | |\n", name, edges.size());
      continue;
    }
    const double n = static_cast<double>(t.ours.size());
    std::printf("| %s, %s | %zu | %d, %d | %.0f (%.1f) | %.0f (%.0f) | **%.1fx**, %.1fx, %.1fx |\n",
                name, bounds == SpeedBounds::kAlongChain ? "as HPP" : "from the last common body",
                edges.size(), t.held, t.held_by_peer, Mean(t.ours), t.our_leaves / n,
                Mean(t.theirs), t.their_nodes / n, Mean(t.theirs) / Mean(t.ours),
                GeometricMean(t.ratios), Median(t.ratios));
    if (t.contradicted > 0) std::printf("(%d contradictions)\n", t.contradicted);
  }
  return contradicted;
}

Edge Swing(double from, double to) {
  Edge edge;
  edge.from.joints = Eigen::VectorXd::Constant(1, from);
  edge.to.joints = Eigen::VectorXd::Constant(1, to);
  return edge;
}

void ReportGraze() {
  for (const double clearance : {1e-2, 1e-6, 1e-12}) {
    const numeric::World world(Pendulum(clearance));
    verify::EdgeWorkspace workspace(world);
    const Edge edge = Swing(-0.3, 0.41);
    const auto ours = DecideEdgeCollision(world, edge, {}, &workspace);
    const auto peer = LipschitzTester(world, {}).Test(edge);
    std::printf("tangential graze of %g m: %s, %ld leaves; by speeds: %s, %ld nodes\n", clearance,
                ours.verdict == Verdict::kHolds ? "holds" : "NOT PROVED", ours.leaves,
                peer.verdict == Verdict::kHolds ? "holds" : "not proved", peer.nodes);
  }
}

/** The tip of a leg of 0.6 m swings 0.1 rad through its lowest point. It starts and ends 0.9 mm
 above the floor and sinks by 0.6 m (1 - cos 0.05) = 0.75 mm in between: 0.15 mm are left of a band
 of 1 mm. */
void ReportBand() {
  Model model = Pendulum(0);
  const double arm = 0.6, half = 0.05, top = 0.9e-3;
  model.robot.links[1].shapes[0] = {{{0, 0, -arm / 2}, {}}, Capsule{1e-4, arm - 2e-4}};
  model.sites = {{1, {0, 0, -arm}, 0}};
  model.contact.bodies = {1};
  model.contact.epsilon = 1e-3;
  model.require = GuideRequirement::kContact;
  std::get<Halfspace>(model.objects[0].pieces[0].geometry).offset = -arm * std::cos(half) - top;
  const numeric::World world(model);
  Certifier certifier(world);
  const Edge edge = Swing(-half, half);
  const Verdict verdict = certifier.Decide(edge);
  const auto peer = LipschitzTester(world, {}).Test(edge);
  std::printf("contact band of 1 mm over 0.1 rad: %s, %ld leaves; by speeds: %s, %ld nodes\n",
              verdict == Verdict::kHolds ? "holds" : "NOT PROVED", certifier.leaves,
              peer.verdict == Verdict::kHolds ? "holds" : "not proved", peer.nodes);
}

}  // namespace

int ReportLipschitz(const numeric::Problem& problem, const std::vector<Edge>& guides, int count) {
  Model model = problem.model;
  model.require = GuideRequirement::kContact;
  const numeric::World wide(model);
  model.contact.epsilon = 0.005;
  const numeric::World contact(model);
  model.require = GuideRequirement::kStability;
  const numeric::World planning(model);
  std::puts(
      "\ncollision and contact against bounds on relative speeds; times in us, of edges that both "
      "prove");
  std::puts(
      "| edges, contact band, speeds | number | proved by us, by speeds | ours (leaves) | by "
      "speeds "
      "(nodes) | ratio of means, geometric mean, median |");
  std::puts("|---|---|---|---|---|---|");
  int contradicted = ReportEdges("extensions by 0.25, 5 mm", contact,
                                 Extensions(planning, problem.sampling, count, 0.25));
  contradicted += ReportEdges("extensions by 0.1, 5 mm", contact,
                              Extensions(planning, problem.sampling, count, 0.1));
  contradicted += ReportEdges("guides, the problem's band", wide, guides);
  ReportGraze();
  ReportBand();
  return contradicted;
}

}  // namespace cguide::benchmark
