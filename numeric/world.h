#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cguide/exact/core/model.h"
#include "cguide/exact/core/path.h"
#include "cguide/numeric/contact.h"
#include "cguide/numeric/kinematics.h"

namespace cguide::numeric {

class Geometry;  // numeric/geometry_internal.h

/** A model prepared for fast queries: kinematic tree, bounding volumes, collision geometry, sites
 by body. Immutable and shared by threads. */
class World {
 public:
  /** @throws Error where CheckModel refuses the model. */
  explicit World(Model model);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const Model& model() const { return model_; }
  const KinematicTree& tree() const { return tree_; }
  const Geometry& geometry() const { return *geometry_; }

 private:
  Model model_;
  KinematicTree tree_;
  std::unique_ptr<Geometry> geometry_;
};

/** Scratch of one thread, bound to one World. Its caches speed up later queries and never change an
 answer. */
class Workspace {
 public:
  explicit Workspace(const World& world);
  ~Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;

  KinematicState state;

  struct Scratch;  // numeric/geometry_internal.h
  std::unique_ptr<Scratch> scratch;
};

/** Places the robot: forward kinematics and the shapes' world placements (lazily). Every query
 below is about the configuration placed last. */
void Place(const World& world, const Configuration& q, Workspace* workspace);

/** The same from workspace->state as the caller filled it, bounds included: for placements that no
 double configuration gives, such as a point of an edge. */
void PlaceFromState(const World& world, Workspace* workspace);

/** Two things that must keep apart: a body and an object, or (self) two bodies. */
struct Pair {
  int body = -1;
  int other = -1;  ///< object index, or body index where `self`
  bool self = false;
  bool operator==(const Pair&) const = default;
};

/** Enclosure of a distance. lo <= d <= hi for the real distance of the two closed sets at the
 placed configuration, kinematic error included; 0 where they meet. A poor float answer gives a wide
 enclosure, never a wrong one. */
struct Clearance {
  double lo = 0;
  double hi = 0;
  Eigen::Vector3d a_W = Eigen::Vector3d::Zero();  ///< near-closest point of `body`
  Eigen::Vector3d b_W = Eigen::Vector3d::Zero();  ///< near-closest point of the other side
  bool overlap = false;  ///< the two provably share a point (then lo = hi = 0)
  double depth = 0;      ///< estimate of the penetration depth where they overlap, not a bound (m)
};

/** Distance of a pair. Distances beyond `cutoff` may be answered by lo >= cutoff, hi = infinity. */
Clearance PairClearance(const World& world, const Pair& pair, double cutoff, Workspace* workspace);

/** Every pair that C_free asks about: all body-object pairs, then Model::self_pairs. */
std::vector<Pair> AllPairs(const World& world);

/** Collision half of C_free: kHolds where every pair is separated by more than its error bound,
 kFails where one pair provably meets, else kUndecided. For may_touch pairs the skin replaces zero:
 two convex pieces hold where a translation shorter than the skin provably separates them, and fail
 where none does; a body and an object are judged piece by piece. Limits are WithinLimits' business.
 `first` is the first pair of AllPairs that fails, else the first undecided one; the test stops at
 the first that fails. Depends on model and configuration alone, not on what the workspace saw
 before. */
struct FreeAnswer {
  Verdict verdict = Verdict::kHolds;
  Pair first;
};
FreeAnswer TestFree(const World& world, Workspace* workspace);

/** Contacts of the placed configuration, certain ones and possible ones, ordered by site then
 object. Honours Model::contact (sites or nearest, bodies, epsilon, skin, seam). Local closest
 points that rounding cannot tell apart are one contact, whose `error` covers their spread; where
 their owners differ in friction it has the smallest, and an uncertain twin with the largest follows
 (a refutation must allow for it). Under ContactModel::kNearest x and y are one of possibly many
 closest pairs. */
void FindContacts(const World& world, Workspace* workspace, std::vector<Contact>* contacts);

/** For the projection: per body, the local closest point nearest to it. */
struct Approach {
  int body = -1;
  int site = -1;
  int object = -1;
  Eigen::Vector3d x_W = Eigen::Vector3d::Zero();   ///< site centre
  Eigen::Vector3d n_W = Eigen::Vector3d::UnitZ();  ///< unit, from the obstacle towards the site
  double distance = 0;                             ///< |x - y| - radius (m); negative inside
};

struct ApproachOptions {
  double cutoff = 0.6;  ///< approaches farther than this are of no interest (m)
  int per_body = 4;     ///< of each body only its nearest sites
  int count = 16;       ///< the search may stop when it has this many
};

/** The nearest approach of each site of each body that may carry contacts, ordered by (distance,
 site). At least the `count` nearest ones that cutoff and per_body allow are listed; more may be.
 Plain floats, no bounds: it proposes, it does not decide. */
void FindApproaches(const World& world, const ApproachOptions& options, Workspace* workspace,
                    std::vector<Approach>* approaches);

}  // namespace cguide::numeric
