#include "search.h"

#include <algorithm>
#include <ctime>
#include <queue>

namespace contact_planner {
namespace {

using cguide::Configuration;
using cguide::planner::GuidePotential;
using Eigen::Vector3d;

// Of the thread: other programs of the machine do not count.
double CpuSeconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Distance along the normal and beyond the border of a face.
double DistanceToFace(const Face& face, const Vector3d& x) {
  const Vector3d d = x - face.centre_W;
  const double u = std::max(0.0, std::abs(face.u_W.dot(d)) - face.half[0]);
  const double v = std::max(0.0, std::abs(face.v_W.dot(d)) - face.half[1]);
  return Vector3d(face.normal_W.dot(d), u, v).norm();
}

bool SameHolds(const Stance& a, const Stance& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Grip& g, const Grip& h) {
    return g.limb == h.limb && g.face == h.face;
  });
}

/** The state of one search. */
class StanceSearch {
 public:
  StanceSearch(const Setting& setting, const GuidePotential& potential,
               const SearchOptions& options, cguide::numeric::Rng& rng)
      : setting_(setting),
        potential_(potential),
        options_(options),
        rng_(rng),
        workspace_(setting.world) {}

  SearchResult Run(const Configuration& start, const Configuration& goal);

 private:
  Configuration Target(const Configuration& q) const;
  std::optional<Posture> Find(const PostureQuery& query, const Configuration& start);
  bool Known(const Stance& stance) const;
  void AddNode(StanceNode node, int parent);
  void TryRemoval(int parent, const Grip& grip);
  void TryAddition(int parent, const Grip& wanted);
  std::vector<Grip> Additions(const StanceNode& node);
  void Expand(int index);
  double GoalDistance(const StanceNode& node) const;
  std::optional<SearchStop> Stop(double begin) const;

  const Setting& setting_;
  const GuidePotential& potential_;
  const SearchOptions& options_;
  cguide::numeric::Rng& rng_;
  PostureWorkspace workspace_;
  Configuration goal_;
  Stance goal_stance_;
  std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>>
      open_;
  SearchResult result_;
};

// The attractor and a little ahead: for the goal alone, the goal.
Configuration StanceSearch::Target(const Configuration& q) const {
  return potential_.At(potential_.Progress(q) + options_.lookahead);
}

std::optional<Posture> StanceSearch::Find(const PostureQuery& query, const Configuration& start) {
  ++result_.postures;
  return FindPosture(setting_, query, potential_, start, options_.posture, &workspace_);
}

bool StanceSearch::Known(const Stance& stance) const {
  return std::any_of(result_.nodes.begin(), result_.nodes.end(), [&](const StanceNode& node) {
    return Alike(node.stance, stance, options_.spacing);
  });
}

void StanceSearch::AddNode(StanceNode node, int parent) {
  node.parent = parent;
  node.depth = parent < 0 ? 0 : result_.nodes[parent].depth + 1;
  node.priority = node.value + options_.step_cost * node.depth;
  open_.push({node.priority, static_cast<int>(result_.nodes.size())});
  result_.nodes.push_back(std::move(node));
}

// Where the contact is broken the others carry; then it moves away.
void StanceSearch::TryRemoval(int parent, const Grip& grip) {
  const StanceNode node = result_.nodes[parent];
  const Stance rest = Without(node.stance, grip.limb);
  if (rest.empty() || Known(rest)) return;
  const Configuration target = Target(node.q);
  const auto transition = Find({node.stance, {}, rest, target}, node.q);
  if (!transition) return;
  const auto posture = Find({rest, {}, rest, target}, transition->q);
  if (!posture) return;
  AddNode({rest, posture->q, transition->q, posture->value, 0, -1, 0,
           "lift " + Describe(grip, setting_.limbs, setting_.faces)},
          parent);
}

// Where the contact is made the old ones carry; then it carries too.
void StanceSearch::TryAddition(int parent, const Grip& wanted) {
  const StanceNode node = result_.nodes[parent];
  const Configuration target = Target(node.q);
  const auto transition = Find({node.stance, wanted, node.stance, target}, node.q);
  if (!transition || Known(transition->stance)) return;
  const auto posture = Find({transition->stance, {}, transition->stance, target}, transition->q);
  if (!posture) return;
  AddNode({transition->stance, posture->q, transition->q, posture->value, 0, -1, 0,
           "place " + Describe(wanted, setting_.limbs, setting_.faces)},
          parent);
}

// Every free limb on every face within reach; its site nearest to the face, or all of a surface.
// Its places: where the target has the limb, and random ones about it.
std::vector<Grip> StanceSearch::Additions(const StanceNode& node) {
  const auto& world = setting_.world;
  cguide::numeric::KinematicState now, then;
  cguide::numeric::ForwardKinematics(world.tree(), node.q, &now);
  cguide::numeric::ForwardKinematics(world.tree(), Target(node.q), &then);
  std::vector<Grip> grips;
  for (int limb = 0; limb < static_cast<int>(setting_.limbs.size()); ++limb) {
    if (FindGrip(node.stance, limb)) continue;
    const Limb& l = setting_.limbs[limb];
    for (int face = 0; face < static_cast<int>(setting_.faces.size()); ++face) {
      const Face& f = setting_.faces[face];
      const auto distance = [&](int site) {
        return DistanceToFace(f, SitePosition(world.model(), world.tree(), now, site));
      };
      const int nearest = *std::min_element(
          l.sites.begin(), l.sites.end(), [&](int a, int b) { return distance(a) < distance(b); });
      const Vector3d x = SitePosition(world.model(), world.tree(), now, nearest);
      if (distance(nearest) > options_.reach || f.normal_W.dot(x - f.centre_W) < 0) continue;
      Grip grip{limb, face, l.hold == Hold::kSurface ? l.sites : std::vector<int>{nearest}, {}};
      for (int place = 0; place < options_.places; ++place) {
        const double sigma = place == 0 ? 0 : options_.place_sigma;
        const Vector3d shift =
            sigma * (cguide::numeric::Normal(rng_) * f.u_W + cguide::numeric::Normal(rng_) * f.v_W);
        grip.at_W.clear();
        for (const int site : grip.sites) {
          grip.at_W.push_back(SitePosition(world.model(), world.tree(), then, site) + shift);
        }
        grips.push_back(grip);
      }
    }
  }
  return grips;
}

void StanceSearch::Expand(int index) {
  result_.expanded.push_back(index);
  const StanceNode node = result_.nodes[index];
  for (const Grip& grip : node.stance) TryRemoval(index, grip);
  for (const Grip& grip : Additions(node)) TryAddition(index, grip);
}

double StanceSearch::GoalDistance(const StanceNode& node) const {
  Configuration root = node.q;
  root.joints = goal_.joints;
  return cguide::Distance(root, goal_);
}

std::optional<SearchStop> StanceSearch::Stop(double begin) const {
  if (open_.empty()) return SearchStop::kExhausted;
  if (static_cast<int>(result_.expanded.size()) >= options_.node_limit)
    return SearchStop::kNodeLimit;
  if (CpuSeconds() - begin > options_.time_limit_s) return SearchStop::kTimeLimit;
  return {};
}

SearchResult StanceSearch::Run(const Configuration& start, const Configuration& goal) {
  const double begin = CpuSeconds();
  goal_ = goal;
  goal_stance_ = StanceAt(setting_, goal, &workspace_);
  const Stance first = StanceAt(setting_, start, &workspace_);
  AddNode({first, start, start, potential_.Value(start), 0, -1, 0, "start"}, -1);
  for (;;) {
    if (const auto stop = Stop(begin)) {
      result_.stop = *stop;
      break;
    }
    const int index = open_.top().second;
    open_.pop();
    const StanceNode& node = result_.nodes[index];
    if (node.value < result_.nodes[result_.last].value) result_.last = index;
    if (SameHolds(node.stance, goal_stance_) && GoalDistance(node) <= options_.goal_tolerance) {
      result_.stop = SearchStop::kSolved;
      result_.last = index;
      break;
    }
    Expand(index);
  }
  result_.seconds = CpuSeconds() - begin;
  result_.iterations = workspace_.iterations;
  result_.goal_distance = GoalDistance(result_.nodes[result_.last]);
  return std::move(result_);
}

}  // namespace

const char* ToString(SearchStop stop) {
  switch (stop) {
    case SearchStop::kSolved:
      return "solved";
    case SearchStop::kNodeLimit:
      return "node limit";
    case SearchStop::kTimeLimit:
      return "time limit";
    case SearchStop::kExhausted:
      return "nothing left";
  }
  return "unknown";
}

std::vector<int> SearchResult::Sequence() const {
  std::vector<int> sequence;
  for (int i = last; i >= 0; i = nodes[i].parent) sequence.insert(sequence.begin(), i);
  return sequence;
}

Stance StanceAt(const Setting& setting, const Configuration& q, PostureWorkspace* workspace) {
  auto& guide = workspace->guide;
  cguide::numeric::Place(setting.world, q, &guide.geometry);
  cguide::numeric::FindContacts(setting.world, &guide.geometry, &guide.contacts);
  Stance stance;
  for (int limb = 0; limb < static_cast<int>(setting.limbs.size()); ++limb) {
    for (int face = 0; face < static_cast<int>(setting.faces.size()); ++face) {
      Grip grip{limb, face, {}, {}};
      for (const auto& contact : guide.contacts) {
        const auto& sites = setting.limbs[limb].sites;
        const bool of_limb = std::find(sites.begin(), sites.end(), contact.site) != sites.end();
        const Face& f = setting.faces[face];
        if (!of_limb || contact.object != f.object || contact.n_W.dot(f.normal_W) < 0.999) continue;
        if (setting.limbs[limb].hold == Hold::kPoint && !grip.sites.empty()) continue;
        grip.sites.push_back(contact.site);
        grip.at_W.push_back(contact.x_W);
      }
      if (!grip.sites.empty() && !FindGrip(stance, limb)) stance = With(stance, grip);
    }
  }
  return stance;
}

SearchResult SearchStances(const Setting& setting, const Configuration& start,
                           const Configuration& goal, const GuidePotential& potential,
                           const SearchOptions& options, cguide::numeric::Rng& rng) {
  return StanceSearch(setting, potential, options, rng).Run(start, goal);
}

}  // namespace contact_planner
