#pragma once

#include <map>
#include <set>
#include <vector>

#include "cguide/numeric/world.h"
#include "cguide/verify/check/certificate.h"
#include "cguide/verify/edge_kinematics.h"

namespace cguide::verify {

/** What was found to prove an edge, by leaf, while it is being bisected. */
struct EdgeEvidence {
  struct Order {
    bool operator()(const Leaf& a, const Leaf& b) const {
      return a.half != b.half ? a.half > b.half : a.middle < b.middle;
    }
  };
  std::map<Leaf, check::Node, Order> nodes;  ///< `halves` unused
  std::set<Leaf, Order> splits;              ///< leaves that were halved
  std::vector<check::OutsideRay> outside;
};

/** The tree of nodes that the checker walks. */
check::EdgeProof AssembleProof(int edge, const EdgeEvidence& evidence);

/** The certificate's number of each shape of the world's geometry: certificates count them link by
 link, geometry body by body. */
std::vector<int> CertificateShapes(const numeric::World& world);

/** Rays for each shape and solid whose boxes meet where the edge begins, in directions that are
 unlikely to meet an edge of a mesh; the checker needs one that does not. */
std::vector<check::OutsideRay> OutsideRays(int shape, int piece);

}  // namespace cguide::verify
