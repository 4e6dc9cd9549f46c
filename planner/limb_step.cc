#include "cguide/planner/limb_step.h"

#include <algorithm>

namespace cguide::planner {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

// A site that is led, and where it is at both ends of the way.
struct LedSite {
  int site = -1;
  int body = -1;
  Vector3d p_B = Vector3d::Zero();
  Vector3d begin_W = Vector3d::Zero();
  Vector3d end_W = Vector3d::Zero();
};

bool Contains(const Limb& limb, int body) {
  return std::find(limb.bodies.begin(), limb.bodies.end(), body) != limb.bodies.end();
}

std::vector<LedSite> ContactSites(const Configuration& q, const Limb& limb,
                                  const ExtensionContext& context) {
  numeric::GuideWorkspace& ws = context.workspace->guide;
  numeric::Place(context.world, q, &ws.geometry);
  numeric::FindContacts(context.world, &ws.geometry, &ws.contacts);
  std::vector<LedSite> sites;
  for (const numeric::Contact& contact : ws.contacts) {
    if (!Contains(limb, contact.body)) continue;
    if (!sites.empty() && sites.back().site == contact.site) continue;  // ordered by site
    const auto& X_WB = ws.geometry.state.X_WB[static_cast<std::size_t>(contact.body)];
    LedSite site;
    site.site = contact.site;
    site.body = contact.body;
    site.p_B = X_WB.R.transpose() * (contact.x_W - X_WB.p);
    sites.push_back(site);
  }
  return sites;
}

void Locate(const Configuration& q, const ExtensionContext& context, Vector3d LedSite::*where,
            std::vector<LedSite>* sites) {
  numeric::Workspace& ws = context.workspace->guide.geometry;
  numeric::Place(context.world, q, &ws);
  for (LedSite& site : *sites) {
    site.*where = ws.state.X_WB[static_cast<std::size_t>(site.body)] * site.p_B;
  }
}

std::vector<LedSite> FindLedSites(const Configuration& from, const Configuration& target,
                                  const Limb& limb, const ExtensionContext& context) {
  std::vector<LedSite> sites = ContactSites(target, limb, context);
  if (sites.empty()) sites = ContactSites(from, limb, context);
  // Three points say where a body is; of more the first and the last are likely to be far apart.
  while (sites.size() > 3) {
    sites.erase(sites.begin() + static_cast<std::ptrdiff_t>(sites.size() / 2));
  }
  Locate(from, context, &LedSite::begin_W, &sites);
  Locate(target, context, &LedSite::end_W, &sites);
  return sites;
}

double Displacement(const std::vector<LedSite>& sites) {
  double most = 0;
  for (const LedSite& site : sites) most = std::max(most, (site.end_W - site.begin_W).norm());
  return most;
}

Points Raised(const Points& points, const Vector3d& up, double height) {
  double lowest = height;
  for (const Vector3d& p : points) lowest = std::min(lowest, up.dot(p));
  Points raised = points;
  for (Vector3d& p : raised) p += (height - lowest) * up;
  return raised;
}

class Stepper {
 public:
  Stepper(const Limb& limb, const LimbStepOptions& options, const ExtensionContext& context)
      : options_(options), context_(context) {
    if (context.options.repair) repair_ = *context.options.repair;
    repair_.ignored.assign(context.world.tree().bodies.size(), 0);
    for (const int body : limb.bodies) repair_.ignored[static_cast<std::size_t>(body)] = 1;
    repair_.slide_compliance = options.slide_compliance;
  }

  Chain Run(const Configuration& from, std::vector<LedSite> sites) {
    sites_ = std::move(sites);
    at_ = from;
    Points here, there;
    double highest = -1e300;
    const Vector3d up = -context_.world.model().gravity.normalized();
    for (const LedSite& site : sites_) {
      here.push_back(site.begin_W);
      there.push_back(site.end_W);
      highest = std::max({highest, up.dot(site.begin_W), up.dot(site.end_W)});
    }
    if (!FindEnd(there)) return {};
    const Points lifted = Raised(here, up, highest + options_.lift);
    const Points over = Raised(there, up, highest + options_.lift);
    // The parts of the way that the posture of the end is mixed in: shifting the weight keeps the
    // posture, placing the limb takes it over.
    repair_.goal_tolerance = options_.on_the_way;
    const bool ok = Carry(here, here, 0) && Carry(here, lifted, 0.1) && Carry(lifted, over, 0.8);
    repair_.goal_tolerance = options_.placed;
    chain_.reached = ok && Carry(over, there, 1);
    return std::move(chain_);
  }

 private:
  void SetGoals(const Points& begin, const Points& end, double part) {
    repair_.goals.clear();
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      repair_.goals.push_back(
          {sites_[i].body, sites_[i].p_B, begin[i] + part * (end[i] - begin[i])});
    }
  }

  ProjectionResult CountedRepair(const Configuration& q, const RepairOptions& options) {
    const ProjectionResult result = Repair(context_.world, q, options, context_.workspace);
    ++context_.counters->projections;
    context_.counters->newton_steps += result.iterations;
    ++context_.counters->projection_stops[static_cast<std::size_t>(result.stop)];
    return result;
  }

  bool FindEnd(const Points& there) {
    SetGoals(there, there, 1);
    RepairOptions far = repair_;
    far.max_iterations = options_.end_iterations;
    far.goal_tolerance = options_.placed;
    const ProjectionResult end = CountedRepair(at_, far);
    end_ = end.q;
    return end.stop == ProjectionStop::kSolved;
  }

  // Leads the sites along straight ways, in strides that grow where they succeed.
  bool Carry(const Points& begin, const Points& end, double mix) {
    double way = 0;
    for (std::size_t i = 0; i < begin.size(); ++i) {
      way = std::max(way, (end[i] - begin[i]).norm());
    }
    double done = 0, part = way > options_.stride ? options_.stride / way : 1;
    while (done < 1) {
      const double next = std::min(1.0, done + part);
      SetGoals(begin, end, next);
      if (Advance(std::min(1.0, mix * part))) {
        done = next;
        part *= 1.5;
      } else {
        part *= 0.5;
        if (part * std::max(way, options_.stride) < options_.least) return false;
      }
    }
    return true;
  }

  bool Advance(double mix) {
    const auto mixed = Between(at_, end_, mix);
    if (!mixed) return false;
    const ProjectionResult next = CountedRepair(*mixed, repair_);
    if (next.stop != ProjectionStop::kSolved) return false;
    return next.q == at_ || Join(next.q, options_.halvings);
  }

  // An edge to q, or two with a repaired point between them.
  bool Join(const Configuration& q, int halvings) {
    if (EdgeHolds(at_, q, context_)) {
      at_ = q;
      chain_.nodes.push_back(q);
      return true;
    }
    if (halvings == 0) return false;
    const auto between = Between(at_, q, 0.5);
    const auto middle = between ? MoveIntoSpace(*between, context_) : between;
    return middle && Join(*middle, halvings - 1) && Join(q, halvings - 1);
  }

  const LimbStepOptions& options_;
  const ExtensionContext& context_;
  RepairOptions repair_;
  std::vector<LedSite> sites_;
  Configuration at_;
  Configuration end_;
  Chain chain_;
};

}  // namespace

Chain StepLimb(const Configuration& from, const Configuration& target, const Limb& limb,
               const LimbStepOptions& options, const ExtensionContext& context) {
  return Stepper(limb, options, context).Run(from, FindLedSites(from, target, limb, context));
}

Chain StepTowards(const Configuration& from, const Configuration& target,
                  const std::vector<Limb>& limbs, const LimbStepOptions& options,
                  const ExtensionContext& context) {
  std::vector<std::pair<double, std::size_t>> open;
  for (std::size_t i = 0; i < limbs.size(); ++i) {
    const double moved = Displacement(FindLedSites(from, target, limbs[i], context));
    if (moved > options.least_move) open.emplace_back(-moved, i);
  }
  std::sort(open.begin(), open.end());
  Chain chain;
  Configuration at = from;
  for (std::size_t k = 0; k < open.size();) {
    Chain step = StepLimb(at, target, limbs[open[k].second], options, context);
    chain.nodes.insert(chain.nodes.end(), step.nodes.begin(), step.nodes.end());
    if (!step.nodes.empty()) at = step.nodes.back();
    if (!step.reached && !step.nodes.empty()) return chain;
    ++k;
    if (!step.reached) continue;  // another limb may make room for this one
    open.erase(open.begin() + static_cast<std::ptrdiff_t>(k) - 1);
    k = 0;
  }
  if (!open.empty()) return chain;
  Chain rest = Connect(at, target, context);
  chain.nodes.insert(chain.nodes.end(), rest.nodes.begin(), rest.nodes.end());
  chain.reached = rest.reached;
  return chain;
}

}  // namespace cguide::planner
