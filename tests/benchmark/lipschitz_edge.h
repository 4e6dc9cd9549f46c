#pragma once

#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/membership.h"

// The usual exact edge test, by bounds on speeds and distances [Schwarzer, Saha, Latombe 2005;
// HPP], written as a fair peer of the certifier: same distances, same kinematics, same bisection.
namespace cguide::benchmark {

struct LipschitzEdge {
  /** kHolds: every pair of AllPairs keeps apart, and at every s one contact is active. kUndecided:
   max_nodes were not enough. */
  Verdict verdict = Verdict::kHolds;
  long nodes = 0;  ///< whose kinematics were evaluated
  long distances = 0;
};

/** How speeds are bounded, and contact. */
enum class SpeedBounds {
  /** As HPP does: of the first body's points in the frame of the second, the lever arm growing
   along the whole chain of joints between them; a contact's distance keeps within (r, r + eps). */
  kAlongChain,
  /** A better bound than anybody's we know: both bodies relative to the last common one, each with
   its own lever arms; that a contact keeps above r is left to the collision half. */
  kFromCommonBody
};

struct LipschitzOptions {
  SpeedBounds bounds = SpeedBounds::kFromCommonBody;
  long max_nodes = 100000;
};

/** Decides collision and contact of an edge. A node [c - h, c + h] is done with a pair when its
 distance at c exceeds V h, V a bound on the speed at which its two bodies approach: the sum over
 the joints between them (and the root's motion, against obstacles) of |rate| times the longest
 lever arm that the links' lengths allow. It is done with contact when the distance of a site at c
 is farther than V h of that site from the ends of its band. Only what is not done goes on to the
 halves. Rounding of V is not accounted for. */
class LipschitzTester {
 public:
  LipschitzTester(const numeric::World& world, const LipschitzOptions& options);

  LipschitzEdge Test(const Edge& edge);

 private:
  struct Node {
    double lo, hi;
    std::vector<int> pairs;  // not done
    bool contact;            // not done
  };

  void SetSpeeds(const Edge& edge);
  double PairSpeed(std::size_t pair) const;
  double SpeedUp(int ancestor, int body, double* reach) const;
  double SpeedDown(int ancestor, int body, double* reach) const;
  Verdict Look(const Edge& edge, const Node& node, Node* left, LipschitzEdge* result);
  Verdict LookForContact(double h);

  const numeric::World& world_;
  LipschitzOptions options_;
  std::vector<numeric::Pair> pairs_;
  std::vector<double> reach_;          // per body: of its shapes from its origin
  std::vector<int> common_;            // per pair: last common body; -1: the world
  std::vector<double> rates_;          // per body: |rate| of its joint along the edge
  double translation_ = 0, turn_ = 0;  // of the root
  std::vector<double> speeds_;         // per pair
  std::vector<double> site_speeds_;    // per site
  numeric::GuideWorkspace workspace_;
};

}  // namespace cguide::benchmark
