#pragma once

#include <map>
#include <optional>
#include <vector>

#include "cguide/exact/body_distance.h"
#include "cguide/numeric/membership.h"
#include "cguide/numeric/stability_ladder.h"
#include "cguide/numeric/world.h"
#include "cguide/verify/sampled_audit.h"

namespace cguide::verify {

/** The world's geometry as the exact twins read it, which must outlive this. Immutable; shared by
 * threads. */
struct PreparedTwins {
  explicit PreparedTwins(const numeric::World& world);
  exact::PreparedModel geometry;
  numeric::StabilityLadder stability;
};

/** A pair that did not keep apart, or the nearest one. */
struct PairFinding {
  numeric::Pair pair;
  Verdict verdict = Verdict::kFails;
  double depth = 0;  ///< penetration, an estimate (m); for NearestPair the distance's lower bound
};

/** Every question of C_guide about one configuration, each climbing from doubles with a proven
 bound to the exact twin on MPFR placements of 106 and then 256 bits. One per thread. */
class SampleLadder {
 public:
  SampleLadder(const numeric::World& world, const PreparedTwins& twins);

  /** The configuration that the questions below are about. */
  void Place(const Configuration& q);

  /** The pairs of C_free that do not provably hold; counts one answer per pair asked. */
  std::vector<PairFinding> TestPairs(StageCounts* counts);

  /** The pair with the smallest lower bound of its distance, if that is below cutoff. */
  std::optional<PairFinding> NearestPair(double cutoff);

  /** Static stability by numeric::StabilityLadder; fills contacts(). */
  numeric::LadderedStability TestStability(StageCounts* counts);

  /** Of the last TestStability: com_m (m, negative where unstable) and `force`, floats. */
  double ComMargin();
  double ForceMargin() const;
  std::vector<Eigen::Vector3d> SupportRegion();  ///< corners in W, counter-clockwise about -gravity

  /** The question of the last TestStability, for margins with proofs. */
  numeric::StabilityQuery Query() const { return numeric::PlacedQuery(*world_, workspace_); }

  const Eigen::Vector3d& com_W() const { return workspace_.geometry.state.com_W; }

  const std::vector<numeric::Contact>& contacts() const { return workspace_.contacts; }

 private:
  Verdict TestPair(const numeric::Pair& pair, double* depth, StageCounts* counts);
  Verdict TestPairExactly(const numeric::Pair& pair, const Rational& threshold);
  const std::vector<exact::ConvexBracket>& PlacedBody(std::size_t precision, int body);
  double Skin(const numeric::Pair& pair) const;

  const numeric::World* world_;
  const PreparedTwins* twins_;
  std::vector<numeric::Pair> pairs_;
  numeric::GuideWorkspace workspace_;
  Configuration q_;
  /** The robot placed with one precision, as far as it was asked for. */
  struct Placed {
    std::optional<exact::RobotPlacement> links;
    std::map<int, std::vector<exact::ConvexBracket>> bodies;
  };
  std::vector<Placed> placements_;
};

}  // namespace cguide::verify
