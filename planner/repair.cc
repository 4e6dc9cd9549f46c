#include "cguide/planner/repair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace cguide::planner {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using numeric::Approach;
using numeric::NearPair;
using numeric::World;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Steps shorter than this (m, rad) no longer change a verdict that a band of centimetres decides.
constexpr double kStalledStep = 1e-6;
// Bounds missed by less than this (m) need no task.
constexpr double kSlack = 1e-6;
constexpr int kMaxRounds = 4;         // of the active set
constexpr int kMaxWanted = 24;        // sites that may be asked into contact
constexpr double kMaxComShift = 0.3;  // lines of support farther away than this are no help (m)
constexpr double kLowBand = 0.2;      // contacts are kept within these parts of epsilon
constexpr double kHighBand = 0.8;
constexpr double kAim = 0.5;         // where further ones are brought
constexpr std::size_t kHistory = 3;  // steps after which goals must have come nearer
constexpr double kNeededGain = 0.5;  // to this part of their error

// direction . c >= offset for a centre of mass c that the contacts can balance.
struct SupportLine {
  Vector3d direction;
  double offset = 0;
};

class Repairer {
 public:
  Repairer(const World& world, const RepairOptions& options, ProjectionWorkspace* ws)
      : world_(world), options_(options), ws_(*ws) {}

  ProjectionResult Run(const Configuration& sample) {
    ProjectionResult result;
    result.q = sample;
    numeric::ClampToLimits(world_.tree(), &result.q);
    for (;; ++result.iterations) {
      numeric::Place(world_, result.q, &ws_.guide.geometry);
      const bool free = numeric::TestFree(world_, &ws_.guide.geometry).verdict == Verdict::kHolds;
      stability_ = TestStability();
      stable_ = stability_.verdict == Verdict::kHolds;
      const bool member = free && stable_;
      if (!member) errors_.clear();
      errors_.push_back(GoalError());
      result.stop = ProjectionStop::kSolved;
      if (member && errors_.back() <= options_.goal_tolerance) return result;
      result.stop = free ? ProjectionStop::kUnstable : ProjectionStop::kColliding;
      if (result.iterations >= options_.max_iterations) return result;
      if (member && GoalsRecede()) return result;
      const VectorXd step = Step(result.q);
      if (step.cwiseAbs().maxCoeff() < kStalledStep) {
        result.stop = ProjectionStop::kStalled;
        return result;
      }
      result.q = numeric::Integrate(result.q, step);
      numeric::ClampToLimits(world_.tree(), &result.q);
    }
  }

 private:
  const numeric::KinematicState& state() const { return ws_.guide.geometry.state; }

  bool Ignored(int body) const {
    return !options_.ignored.empty() && options_.ignored[static_cast<std::size_t>(body)];
  }

  // Stable without the ignored contacts is stable: more contacts only widen the cone. Where contact
  // is all that is asked for, a certain one does.
  numeric::StabilityAnswer TestStability() {
    numeric::FindContacts(world_, &ws_.guide.geometry, &ws_.guide.contacts);
    std::erase_if(ws_.guide.contacts,
                  [&](const numeric::Contact& contact) { return Ignored(contact.body); });
    if (world_.model().require == GuideRequirement::kContact) {
      numeric::StabilityAnswer answer;
      const auto& contacts = ws_.guide.contacts;
      if (std::any_of(contacts.begin(), contacts.end(), [](const auto& c) { return c.certain; })) {
        answer.verdict = Verdict::kHolds;
      }
      return answer;
    }
    return numeric::TryStability(numeric::PlacedQuery(world_, ws_.guide), &ws_.guide.stability);
  }

  Vector3d GoalPoint(const PointGoal& goal) const {
    return state().X_WB[static_cast<std::size_t>(goal.body)] * goal.p_B;
  }

  double GoalError() const {
    double worst = 0;
    for (const PointGoal& goal : options_.goals) {
      worst = std::max(worst, (goal.goal_W - GoalPoint(goal)).norm());
    }
    return worst;
  }

  bool GoalsRecede() const {
    const std::size_t n = errors_.size();
    return n > kHistory && errors_[n - 1] > kNeededGain * errors_[n - 1 - kHistory];
  }

  VectorXd Step(const Configuration& q) {
    count_ = 0;
    if (!stable_) ++unstable_;
    AddPairs();
    if (!stable_ && (!FindSupportLine() || unstable_ % options_.patience == 0)) {
      ++wanted_;
      lines_.clear();  // they were of fewer contacts
    }
    AddBalance();
    const std::size_t before = count_;
    while (true) {
      AddContacts();
      AddGoals();
      VectorXd step = Solve(q);
      if (stable_ || step.cwiseAbs().maxCoeff() >= kStalledStep || wanted_ >= kMaxWanted) {
        return step;
      }
      ++wanted_;
      count_ = before;
    }
  }

  // Room for one more bound lower <= row . v <= upper; its row is scratch still.
  TaskBound& NextBound(double lower, double upper) {
    if (ws_.bounds.size() <= count_) ws_.bounds.emplace_back();
    TaskBound& bound = ws_.bounds[count_++];
    bound.lower = lower;
    bound.upper = upper;
    return bound;
  }

  void AddPairs() {
    numeric::FindNearPairs(world_, options_.look, &ws_.guide.geometry, &ws_.pairs);
    for (const NearPair& pair : ws_.pairs) {
      double lower = options_.clearance - pair.distance;
      if (lower > 0) lower += options_.clearance;
      TaskBound& bound = NextBound(lower, kInfinity);
      numeric::NearPairRow(world_.tree(), state(), pair, &bound.row, &ws_.row);
    }
  }

  // With the contacts where they are, y of the separating wrench keeps separating when the centre
  // of mass moves by d, turned into (y_f + y_m x d, y_m), as long as (g x y_m) . d < -y_f . g: a
  // line that the centre of mass must cross.
  bool FindSupportLine() {
    if (stability_.verdict != Verdict::kFails) return false;
    const Vector3d g = world_.model().gravity;
    const Vector3d y_f = stability_.separator.y.head<3>(), y_m = stability_.separator.y.tail<3>();
    const Vector3d h = g.cross(y_m);
    const double norm = h.norm(), excess = -y_f.dot(g);
    if (!(norm > 0) || !(excess < kMaxComShift * norm)) return false;
    lines_.push_back({h / norm, h.dot(state().com_W) / norm + excess / norm});
    return true;
  }

  // Lines crossed before must not be crossed back; contacts move little from iterate to iterate.
  void AddBalance() {
    if (lines_.empty()) return;
    numeric::ComJacobian(world_.tree(), state(), &ws_.com_jacobian);
    for (const SupportLine& line : lines_) {
      const double crossed = line.direction.dot(state().com_W) - line.offset;
      TaskBound& bound = NextBound(options_.com_margin - crossed, kInfinity);
      bound.row = ws_.com_jacobian.transpose() * line.direction;
    }
  }

  void AddContacts() {
    const int count = wanted_ == 0 ? 0 : wanted_ + static_cast<int>(ws_.guide.contacts.size());
    numeric::FindApproaches(world_, {options_.search_distance, options_.sites_per_body, count},
                            &ws_.guide.geometry, &ws_.approaches);
    const double epsilon = world_.model().contact.epsilon;
    int further = 0;
    for (const Approach& approach : ws_.approaches) {
      if (Ignored(approach.body)) continue;
      const bool in_band = approach.distance < epsilon;
      if (!in_band && (stable_ || ++further > wanted_)) break;
      // A stable robot that collides may need to leave what it touches.
      const double upper =
          stable_ ? kInfinity : (in_band ? kHighBand : kAim) * epsilon - approach.distance;
      TaskBound& bound = NextBound(kLowBand * epsilon - approach.distance, upper);
      numeric::PointJacobianRow(world_.tree(), state(), approach.body, approach.x_W, approach.n_W,
                                &bound.row);
    }
  }

  void AddGoals() {
    for (const PointGoal& goal : options_.goals) {
      const Vector3d p = GoalPoint(goal);
      for (int axis = 0; axis < 3; ++axis) {
        const double rate = (goal.goal_W - p)[axis];
        numeric::PointJacobianRow(world_.tree(), state(), goal.body, p, Vector3d::Unit(axis),
                                  &NextBound(rate, rate).row);
      }
    }
  }

  // Bounds that the step so far violates become tasks, in the order of their priority, until none
  // is added. They are not taken out again: what is asked too much of a step is had back in the
  // next one.
  VectorXd Solve(const Configuration& q) {
    ws_.active.assign(count_, 0);
    VectorXd step = VectorXd::Zero(world_.tree().num_velocities());
    for (int round = 0; round < kMaxRounds && Activate(step); ++round) {
      std::size_t size = 0;
      for (std::size_t i = 0; i < count_; ++i) {
        if (!ws_.active[i]) continue;
        if (ws_.tasks.size() <= size) ws_.tasks.emplace_back();
        ws_.tasks[size].row = ws_.bounds[i].row;
        ws_.tasks[size++].rate = ws_.active[i] == 1 ? ws_.bounds[i].lower : ws_.bounds[i].upper;
      }
      step = numeric::SolveTaskStack(world_.tree(), q, {ws_.tasks.data(), size}, options_.stack,
                                     &ws_.stack);
    }
    return step;
  }

  bool Activate(const VectorXd& step) {
    bool changed = false;
    for (std::size_t i = 0; i < count_; ++i) {
      if (ws_.active[i]) continue;
      const TaskBound& bound = ws_.bounds[i];
      const double rate = bound.row.dot(step);
      if (rate < bound.lower - kSlack || bound.lower == bound.upper) ws_.active[i] = 1;
      if (rate > bound.upper + kSlack) ws_.active[i] = 2;
      changed = changed || ws_.active[i];
    }
    return changed;
  }

  const World& world_;
  const RepairOptions& options_;
  ProjectionWorkspace& ws_;
  numeric::StabilityAnswer stability_;
  bool stable_ = false;
  std::vector<SupportLine> lines_;
  std::vector<double> errors_;  // of the goals, since the last iterate outside
  std::size_t count_ = 0;       // bounds in use
  int unstable_ = 0;            // iterates that were
  int wanted_ = 0;              // sites to be brought into contact besides those that are
};

}  // namespace

ProjectionResult Repair(const World& world, const Configuration& q, const RepairOptions& options,
                        ProjectionWorkspace* workspace) {
  return Repairer(world, options, workspace).Run(q);
}

}  // namespace cguide::planner
