#include "cguide/verify/sample_ladder.h"

#include <algorithm>
#include <cmath>

#include "cguide/numeric/convex_distance.h"
#include "cguide/numeric/margins.h"

namespace cguide::verify {
namespace {

using numeric::Clearance;
using numeric::Pair;
using numeric::World;

constexpr int kBits[] = {106, 256};

}  // namespace

PreparedTwins::PreparedTwins(const World& world)
    : geometry(exact::PrepareModel(world.model())), stability(world) {}

SampleLadder::SampleLadder(const World& world, const PreparedTwins& twins)
    : world_(&world),
      twins_(&twins),
      pairs_(numeric::AllPairs(world)),
      workspace_(world),
      placements_(std::size(kBits)) {}

void SampleLadder::Place(const Configuration& q) {
  q_ = q;
  for (Placed& placed : placements_) placed = Placed{};
  numeric::Place(*world_, q, &workspace_.geometry);
}

double SampleLadder::Skin(const Pair& pair) const {
  const ContactRules& rules = world_->model().contact;
  if (pair.self || rules.skin == 0) return 0;
  const bool listed = std::binary_search(rules.may_touch.begin(), rules.may_touch.end(),
                                         std::pair(pair.body, pair.other));
  return listed ? rules.skin : 0;
}

const std::vector<exact::ConvexBracket>& SampleLadder::PlacedBody(std::size_t precision, int body) {
  Placed& placed = placements_[precision];
  if (!placed.links) {
    placed.links = exact::PlaceRobot(world_->model().robot, q_, kBits[precision]);
  }
  const auto [place, is_new] = placed.bodies.try_emplace(body);
  if (is_new) place->second = exact::PlaceBody(twins_->geometry, *placed.links, body);
  return place->second;
}

// What exact::BodyObjectSeparation and exact::BodyBodySeparation decide. The hulls of meshes have
// hundreds of points: they are placed once for all pairs, and their closest points come from floats
// that integers confirm.
Verdict SampleLadder::TestPairExactly(const Pair& pair, const Rational& threshold) {
  const exact::SeparateOptions options{[](auto a, auto b) {
    return numeric::ClosestPoints(a, b, numeric::SquaredConvexDistance(a, b));
  }};
  for (std::size_t i = 0; i < std::size(kBits); ++i) {
    const auto& body = PlacedBody(i, pair.body);
    const exact::Separation separation =
        pair.self
            ? exact::Separate(body, PlacedBody(i, pair.other), threshold, options)
            : exact::Separate(body, twins_->geometry.objects.at(pair.other), threshold, options);
    if (separation.verdict != Verdict::kUndecided) return separation.verdict;
  }
  return Verdict::kUndecided;
}

Verdict SampleLadder::TestPair(const Pair& pair, double* depth, StageCounts* counts) {
  constexpr double kNear = 0.01;  // farther pairs need no better bound than "farther"
  const Clearance clearance = numeric::PairClearance(*world_, pair, kNear, &workspace_.geometry);
  const double skin = Skin(pair);
  *depth = clearance.overlap ? clearance.depth : 0;
  if (clearance.lo > 0) {
    ++counts->fast;
    return Verdict::kHolds;
  }
  if (clearance.overlap && skin == 0) {
    ++counts->fast;
    return Verdict::kFails;
  }
  const Verdict verdict = TestPairExactly(pair, Lift(-skin));
  ++(verdict == Verdict::kUndecided ? counts->undecided : counts->exact);
  return verdict;
}

std::vector<PairFinding> SampleLadder::TestPairs(StageCounts* counts) {
  if (numeric::TestFree(*world_, &workspace_.geometry).verdict == Verdict::kHolds) {
    counts->fast += static_cast<long>(pairs_.size());
    return {};
  }
  std::vector<PairFinding> findings;
  for (const Pair& pair : pairs_) {
    double depth = 0;
    const Verdict verdict = TestPair(pair, &depth, counts);
    if (verdict != Verdict::kHolds) findings.push_back({pair, verdict, depth});
  }
  return findings;
}

std::optional<PairFinding> SampleLadder::NearestPair(double cutoff) {
  std::optional<PairFinding> nearest;
  for (const Pair& pair : pairs_) {
    if (cutoff <= 0) break;
    const Clearance clearance = numeric::PairClearance(*world_, pair, cutoff, &workspace_.geometry);
    if (clearance.lo >= cutoff) continue;
    cutoff = clearance.lo;
    nearest = {pair, Verdict::kHolds, clearance.lo};
  }
  return nearest;
}

numeric::LadderedStability SampleLadder::TestStability(StageCounts* counts) {
  numeric::LadderedStability decided = twins_->stability.Decide(q_, &workspace_);
  switch (decided.rung) {
    case numeric::StabilityRung::kFast:
      ++counts->fast;
      break;
    case numeric::StabilityRung::kBits106:
      ++counts->bits_106;
      ++counts->exact;
      break;
    case numeric::StabilityRung::kBits256:
      ++counts->bits_256;
      ++counts->exact;
      break;
    case numeric::StabilityRung::kStored:
      ++counts->exact;
      break;
    case numeric::StabilityRung::kUndecided:
      ++counts->undecided;
      break;
  }
  return decided;
}

double SampleLadder::ComMargin() {
  return numeric::FindComMargin(numeric::PlacedQuery(*world_, workspace_), {},
                                &workspace_.stability)
      .lo;
}

double SampleLadder::ForceMargin() const {
  return numeric::ForceMargin(numeric::PlacedQuery(*world_, workspace_));
}

std::vector<Eigen::Vector3d> SampleLadder::SupportRegion() {
  return numeric::FindSupportRegion(numeric::PlacedQuery(*world_, workspace_), {},
                                    &workspace_.stability)
      .vertices_W;
}

}  // namespace cguide::verify
