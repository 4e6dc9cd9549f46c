#pragma once

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSpace.h>
#include <ompl/geometric/PathGeometric.h>

#include <cstdint>
#include <memory>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/membership.h"
#include "cguide/numeric/sampling.h"
#include "cguide/numeric/world.h"
#include "cguide/planner/projection.h"

// C_guide for OMPL's planners: optional target cguide::ompl, built where OMPL is found.
namespace cguide::ompl_adapter {

/** How states between two others are made. */
enum class Interpolation {
  kStraight,  ///< the edge of exact/core/path.h
  /** That state moved into C_guide by Algorithm 3, or left where it is if that fails (it is then
   found invalid): planners that steer by interpolation get projected extensions. The state it
   starts from where that does not lead nearer to the other end. */
  kProjected
};

/** Position x SO(3) x independent joints with the metric of exact/core/path.h, Distance().
 Unbounded continuous joints and the root's position have bounds of +-`reach`, as OMPL asks for
 some. */
class GuideStateSpace : public ompl::base::CompoundStateSpace {
 public:
  struct Options {
    Interpolation interpolation = Interpolation::kStraight;
    double step = 0.02;  ///< between states where OMPL discretises a motion by itself
    double reach = 100;  ///< m, rad
    planner::ProjectionOptions projection;
  };
  GuideStateSpace(const numeric::World& world, const Options& options);

  void Write(const Configuration& q, ompl::base::State* state) const;
  Configuration Read(const ompl::base::State* state) const;

  double distance(const ompl::base::State* a, const ompl::base::State* b) const override;
  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double t,
                   ompl::base::State* state) const override;
  unsigned validSegmentCount(const ompl::base::State* a, const ompl::base::State* b) const override;
  /** OMPL's checks of itself at setup, but for what projected interpolation is not made for. */
  void sanityChecks() const override;

 private:
  struct Scratch;
  const numeric::World& world_;
  Options options_;
  std::shared_ptr<Scratch> scratch_;
};

enum class Samples {
  kRaw,       ///< as the sampling rules give them; almost none is in C_guide
  kProjected  ///< moved into C_guide by Algorithm 3, drawn again where that fails
};

struct AdapterOptions {
  numeric::Space space = numeric::Space::kGuide;
  Samples samples = Samples::kProjected;
  std::uint64_t seed = 1;  ///< of the samples; OMPL's own choices follow ompl::RNG
  GuideStateSpace::Options state_space;
};

/** A space information whose parts are ours: state space, samplers (uniform and valid ones), the
 validity of a state (TestConfiguration: limits, collisions, contact, balance; undecided is
 invalid), and the validity of a motion, which is what `oracle` says of the edge: with
 verify::MakeWholeOracle every motion of a path that OMPL returns has been decided for every real s.
 An empty oracle leaves OMPL's DiscreteMotionValidator in place. checkMotion with a last valid state
 gives the start of the motion where it is not valid. Calls from several threads take turns.
 `world` and `rules` must outlive the result. */
std::shared_ptr<ompl::base::SpaceInformation> MakeSpaceInformation(
    const numeric::World& world, const numeric::SamplingRules& rules, const EdgeOracle& oracle,
    const AdapterOptions& options);

/** The states of a path of such a space. */
Path ToPath(const ompl::geometric::PathGeometric& path, const numeric::World& world);

}  // namespace cguide::ompl_adapter
