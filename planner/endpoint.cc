#include "cguide/planner/endpoint.h"

#include <cmath>
#include <sstream>

#include "cguide/exact/core/error.h"

namespace cguide::planner {
namespace {

using numeric::Membership;
using numeric::Obstruction;
using numeric::World;

std::string NameOf(const World& world, const numeric::Pair& pair) {
  const Model& model = world.model();
  const std::string body = "\"" + model.robot.bodies[pair.body].name + "\"";
  const std::string other =
      pair.self ? model.robot.bodies[pair.other].name : model.objects[pair.other].name;
  return body + " and \"" + other + "\"";
}

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
  std::ostringstream text;
  switch (membership.obstruction) {
    case Obstruction::kLimits:
      return DescribeLimits(world, q);
    case Obstruction::kCollision: {
      const numeric::Clearance clearance =
          numeric::PairClearance(world, membership.pair, 1.0, &workspace->geometry);
      text << NameOf(world, membership.pair)
           << (membership.verdict == Verdict::kFails ? " overlap" : " may touch");
      if (clearance.depth > 0) text << " by about " << clearance.depth << " m";
      return text.str();
    }
    case Obstruction::kNoContact:
      return "no body is within the contact band of an obstacle";
    case Obstruction::kUnstable:
      text << "it is not statically stable with its " << workspace->contacts.size()
           << " contact points";
      return text.str();
    case Obstruction::kNone:
      break;
  }
  return "it is in the space";
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
