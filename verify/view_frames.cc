#include "cguide/verify/view_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/membership.h"

namespace cguide::verify {
namespace {

Configuration ConfigurationAt(const Path& path, const Instant& instant) {
  if (path.waypoints.size() == 1) return path.waypoints.front();
  return Interpolate({path.waypoints[instant.edge], path.waypoints[instant.edge + 1]}, instant.s);
}

// Smallest clearance of any pair; the pairs seen before bound the work for those that follow.
double SmallestClearance(const numeric::World& world, const std::vector<numeric::Pair>& pairs,
                         numeric::Workspace* workspace) {
  double least = std::numeric_limits<double>::infinity();
  for (const numeric::Pair& pair : pairs) {
    const numeric::Clearance answer =
        numeric::PairClearance(world, pair, std::max(least, 0.0), workspace);
    least = std::min(least, answer.overlap ? -answer.depth : answer.lo);
  }
  return least;
}

std::string NameOfOther(const Model& model, const numeric::Pair& pair) {
  return pair.self ? model.robot.bodies[pair.other].name : model.objects[pair.other].name;
}

void Explain(const Model& model, const numeric::Membership& answer, ViewFrame* frame) {
  if (answer.verdict == Verdict::kHolds) return;
  switch (answer.obstruction) {
    case numeric::Obstruction::kNone:
      return;
    case numeric::Obstruction::kLimits:
      frame->note = "a joint is beyond its limits";
      break;
    case numeric::Obstruction::kNoContact:
      frame->note = "no contact";
      break;
    case numeric::Obstruction::kUnstable:
      frame->note = "the contacts cannot carry the robot";
      break;
    case numeric::Obstruction::kCollision:
      frame->note =
          model.robot.bodies[answer.pair.body].name + " meets " + NameOfOther(model, answer.pair);
      frame->marked_bodies = {answer.pair.body};
      if (answer.pair.self) frame->marked_bodies.push_back(answer.pair.other);
      break;
  }
  if (answer.verdict == Verdict::kUndecided) frame->note = "too close to call: " + frame->note;
}

ViewFrame MakeFrame(const numeric::World& world, const Path& path, const Instant& instant,
                    const std::vector<numeric::Pair>& pairs, numeric::GuideWorkspace* workspace) {
  ViewFrame frame;
  frame.edge = instant.edge;
  frame.s = instant.s;
  const Configuration q = ConfigurationAt(path, instant);
  const numeric::Membership answer =
      numeric::TestConfiguration(world, q, numeric::Space::kGuide, workspace);
  frame.verdict = answer.verdict;
  Explain(world.model(), answer, &frame);

  numeric::Workspace& geometry = workspace->geometry;
  numeric::Place(world, q, &geometry);
  for (const numeric::Transform& X : geometry.state.X_WB) {
    frame.X_WB.push_back({X.R.cast<float>(), X.p.cast<float>()});
  }
  frame.com_W = geometry.state.com_W;
  numeric::FindContacts(world, &geometry, &workspace->contacts);
  for (const numeric::Contact& contact : workspace->contacts) {
    frame.contacts.push_back({contact.body, contact.object, contact.force_point_W(), contact.n_W,
                              contact.friction, contact.certain});
  }
  const double clearance = SmallestClearance(world, pairs, &geometry);
  if (std::isfinite(clearance)) frame.clearance = clearance;
  return frame;
}

}  // namespace

std::vector<Instant> InstantsAlong(const Path& path, const FrameOptions& options) {
  Require(!path.waypoints.empty(), "the path has no waypoint");
  Require(options.count >= 1, "at least one frame must be asked for");
  const int edges = std::max<int>(1, static_cast<int>(path.waypoints.size()) - 1);
  std::vector<double> length(edges, 0.0);
  double whole = 0;
  for (std::size_t i = 1; i < path.waypoints.size(); ++i) {
    whole += length[i - 1] = Distance(path.waypoints[i - 1], path.waypoints[i]);
  }
  std::vector<Instant> instants;
  for (int edge = 0; edge < edges; ++edge) {
    const double share = whole > 0 ? length[edge] / whole : 0;
    const int parts = std::max(1, static_cast<int>(std::lround(options.count * share)));
    for (int i = 0; i < parts; ++i) instants.push_back({edge, static_cast<double>(i) / parts});
  }
  if (path.waypoints.size() > 1) instants.push_back({edges - 1, 1.0});
  for (const Instant& instant : options.also) {
    Require(instant.edge >= 0 && instant.edge < edges && instant.s >= 0 && instant.s <= 1,
            "an instant is off the path");
    instants.push_back(instant);
  }
  const auto key = [](const Instant& i) { return std::pair(i.edge, i.s); };
  std::sort(instants.begin(), instants.end(),
            [&](const Instant& a, const Instant& b) { return key(a) < key(b); });
  const auto same = [&](const Instant& a, const Instant& b) { return key(a) == key(b); };
  instants.erase(std::unique(instants.begin(), instants.end(), same), instants.end());
  return instants;
}

std::vector<ViewFrame> FramesAlong(const numeric::World& world, const Path& path,
                                   const FrameOptions& options) {
  CheckPath(path, world.model().robot);
  const std::vector<Instant> instants = InstantsAlong(path, options);
  const std::vector<numeric::Pair> pairs = numeric::AllPairs(world);
  numeric::GuideWorkspace workspace(world);
  std::vector<ViewFrame> frames;
  for (const Instant& instant : instants) {
    frames.push_back(MakeFrame(world, path, instant, pairs, &workspace));
  }
  return frames;
}

}  // namespace cguide::verify
