#include "cguide/planner/endpoint.h"

#include <cmath>
#include <sstream>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/describe.h"

namespace cguide::planner {
namespace {

using numeric::Membership;
using numeric::Obstruction;
using numeric::World;

std::string DescribeLimits(const World& world, const Configuration& q) {
  const auto names = ColumnNames(world.model().robot);
  std::ostringstream text;
  for (int i = 0; i < q.joints.size(); ++i) {
    const numeric::ColumnLimits& limit = world.tree().limits[i];
    if (q.joints[i] >= limit.lower && q.joints[i] <= limit.upper) continue;
    text << "joint \"" << names[i] << "\" at " << q.joints[i] << " is outside [" << limit.lower
         << ", " << limit.upper << "]";
    break;
  }
  return text.str();
}

std::string Describe(const World& world, const Configuration& q, const Membership& membership,
                     numeric::GuideWorkspace* workspace) {
  if (membership.obstruction == Obstruction::kLimits) return DescribeLimits(world, q);
  std::ostringstream text;
  text << numeric::DescribeMembership(world.model(), membership);
  if (membership.obstruction == Obstruction::kCollision) {
    const double depth =
        numeric::PairClearance(world, membership.pair, 1.0, &workspace->geometry).depth;
    if (depth > 0) text << " by about " << numeric::Millimetres(depth);
  } else if (membership.obstruction == Obstruction::kUnstable) {
    text << " with its " << workspace->contacts.size() << " contact points";
  }
  return text.str();
}

bool Near(const Configuration& a, const Configuration& b, const EndpointOptions& options) {
  const Quaternion &p = a.X_WB.q, &q = b.X_WB.q;
  const double dot = std::abs(p.x * q.x + p.y * q.y + p.z * q.z + p.w * q.w);
  const double turn = 2 * std::acos(std::min(1.0, dot));
  const double joint = a.joints.size() == 0 ? 0 : (a.joints - b.joints).cwiseAbs().maxCoeff();
  return (a.X_WB.p - b.X_WB.p).norm() < options.max_translation && turn < options.max_joint &&
         joint < options.max_joint;
}

}  // namespace

Endpoint PrepareEndpoint(const World& world, const Configuration& q, numeric::Space space,
                         const std::string& what, const EndpointOptions& options,
                         ProjectionWorkspace* workspace) {
  const Membership membership = TestConfiguration(world, q, space, &workspace->guide);
  if (membership.verdict == Verdict::kHolds) return {q, false};
  const std::string reason = Describe(world, q, membership, &workspace->guide);
  const std::string place = what + ": " + reason;
  if (space == numeric::Space::kFree) throw Error(Error::Code::kBadInput, place + "; move it");
  const ProjectionResult result = Project(world, q, options.projection, workspace);
  if (result.stop != ProjectionStop::kSolved) {
    throw Error(Error::Code::kBadInput,
                place + ", and projecting it did not help (" + ToString(result.stop) +
                    "); move it nearer to its supports or check the contact rules");
  }
  if (!Near(q, result.q, options)) {
    throw Error(Error::Code::kBadInput,
                place +
                    "; the nearest configuration found is farther than 0.05 m or 0.2 rad away; "
                    "move it");
  }
  return {result.q, true};
}

}  // namespace cguide::planner
