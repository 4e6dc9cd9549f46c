#include "cguide/planner/repair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>

#include "cguide/planner/support_shift.h"

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
constexpr int kMaxWanted = 24;        // sites that may be asked into contact
constexpr double kMaxComShift = 0.3;  // lines of support farther away than this are no help (m)
constexpr double kLowBand = 0.2;      // contacts are kept within these parts of epsilon
constexpr double kHighBand = 0.8;
constexpr double kAim = 0.5;         // where further ones are brought
constexpr std::size_t kHistory = 3;  // steps after which goals must have come nearer
constexpr double kNeededGain = 0.5;  // to this part of their error

constexpr std::size_t kLines = 2;  // lines of support, those found last
// Of the active set of a step: what it lacks of the optimum the next step makes good. Six take a
// third less time than as many as it takes, and repair as many samples within a few in a hundred.
constexpr int kRounds = 6;
// What gives way first where bounds conflict: goals, then balance, then contacts.
constexpr double kPairCompliance = 5e-5;
constexpr double kContactCompliance = 2e-4;
constexpr double kBalanceCompliance = 5e-4;
constexpr double kWantedCompliance = 1e-3;
constexpr double kGoalCompliance = 1e-2;

// direction . (c - sum load_k x_k) >= offset for a centre of mass c that the contacts can balance;
// it moves with the points x_k that bear the robot at the line, or the feet would go with the
// centre.
struct SupportLine {
  struct Point {
    int body;
    Vector3d p_B;
    double load;
  };
  Vector3d direction;
  double offset = 0;
  std::vector<Point> points;
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
    FindSites();
    AddContacts();
    if (!stable_ && (!FindSupportLine() || unstable_ % options_.patience == 0)) {
      ++wanted_;
      lines_.clear();  // they were of fewer contacts
      FindSites();
    }
    AddBalance();
    const std::size_t before = count_;
    while (true) {
      AddWanted();
      AddGoals();
      VectorXd step = Solve(q);
      if (stable_ || step.cwiseAbs().maxCoeff() >= kStalledStep || wanted_ >= kMaxWanted) {
        return step;
      }
      ++wanted_;
      count_ = before;
      FindSites();
    }
  }

  // Room for one more bound lower <= row . v <= upper; its row is scratch still.
  TaskBound& NextBound(double lower, double upper, double compliance) {
    if (ws_.bounds.size() <= count_) ws_.bounds.emplace_back();
    TaskBound& bound = ws_.bounds[count_++];
    bound.lower = lower;
    bound.upper = upper;
    bound.compliance = compliance;
    return bound;
  }

  void AddPairs() {
    numeric::FindNearPairs(world_, options_.look, &ws_.guide.geometry, &ws_.pairs);
    for (const NearPair& pair : ws_.pairs) {
      double lower = options_.clearance - pair.distance;
      if (lower > 0) lower += options_.clearance;
      TaskBound& bound = NextBound(lower, kInfinity, kPairCompliance);
      numeric::NearPairRow(world_.tree(), state(), pair, &bound.row, &ws_.row);
    }
  }

  // With the contacts where they are. Sites inside an obstacle are on their way out, as contacts.
  bool FindSupportLine() {
    std::vector<numeric::Contact>& contacts = ws_.guide.contacts;
    for (const Approach& approach : ws_.approaches) {
      if (approach.distance <= 0 && !Ignored(approach.body))
        contacts.push_back(AsContact(approach));
    }
    const numeric::StabilityQuery query = numeric::PlacedQuery(world_, ws_.guide);
    const auto support = NearestSupport(
        numeric::WrenchGenerators(query, numeric::Pyramid::kInscribed), world_.model().gravity);
    if (!support || support->shift.norm() > kMaxComShift) return false;
    if (support->shift.norm() < kSlack) return true;
    if (lines_.size() >= kLines) lines_.erase(lines_.begin());
    lines_.push_back(MakeLine(*support));
    return true;
  }

  SupportLine MakeLine(const Support& support) const {
    SupportLine line;
    const double length = support.shift.norm();
    line.direction = support.shift / length;
    const auto& contacts = ws_.guide.contacts;
    double total = 0;
    auto next = support.loads.begin();
    for (const numeric::Contact& contact : contacts) {
      const auto end = next + (contact.friction == 0 ? 1 : world_.model().contact.generators);
      const double load = std::accumulate(next, end, 0.0);
      next = end;
      if (load == 0) continue;
      const auto& X_WB = state().X_WB[static_cast<std::size_t>(contact.body)];
      line.points.push_back({contact.body, X_WB.R.transpose() * (contact.x_W - X_WB.p), load});
      total += load;
    }
    for (SupportLine::Point& point : line.points) point.load /= total;
    line.offset = Crossed(line) + length;
    return line;
  }

  // By how much beyond the line.
  double Crossed(const SupportLine& line) const {
    Vector3d from = state().com_W;
    for (const SupportLine::Point& point : line.points) from -= point.load * Place(point);
    return line.direction.dot(from) - line.offset;
  }

  Vector3d Place(const SupportLine::Point& point) const {
    return state().X_WB[static_cast<std::size_t>(point.body)] * point.p_B;
  }

  numeric::Contact AsContact(const Approach& approach) const {
    numeric::Contact contact;
    contact.site = approach.site;
    contact.body = approach.body;
    contact.object = approach.object;
    contact.x_W = approach.x_W;
    contact.n_W = approach.n_W;
    contact.friction = world_.model().objects[static_cast<std::size_t>(approach.object)].friction;
    return contact;
  }

  // Lines crossed before must not be crossed back; contacts move little from iterate to iterate.
  void AddBalance() {
    if (lines_.empty()) return;
    numeric::ComJacobian(world_.tree(), state(), &ws_.com_jacobian);
    for (const SupportLine& line : lines_) {
      TaskBound& bound =
          NextBound(options_.com_margin - Crossed(line), kInfinity, kBalanceCompliance);
      bound.row = ws_.com_jacobian.transpose() * line.direction;
      for (const SupportLine::Point& point : line.points) {
        numeric::PointJacobianRow(world_.tree(), state(), point.body, Place(point), line.direction,
                                  &ws_.row);
        bound.row -= point.load * ws_.row;
      }
    }
  }

  void FindSites() {
    const int count = wanted_ == 0 ? 0 : wanted_ + static_cast<int>(ws_.guide.contacts.size());
    numeric::FindApproaches(world_, {options_.search_distance, options_.sites_per_body, count},
                            &ws_.guide.geometry, &ws_.approaches);
    std::erase_if(ws_.approaches, [&](const Approach& a) { return Ignored(a.body); });
  }

  // Those there are stay within the band. A stable robot that collides may need to leave what it
  // touches.
  void AddContacts() {
    const double epsilon = world_.model().contact.epsilon;
    for (const Approach& approach : ws_.approaches) {
      if (approach.distance >= epsilon) break;
      AddSite(approach, stable_ ? kInfinity : kHighBand * epsilon - approach.distance,
              kContactCompliance);
    }
    if (options_.slide_compliance > 0) AddHolds();
  }

  // Two sites a body say where it is on a face.
  void AddHolds() {
    const double epsilon = world_.model().contact.epsilon;
    held_.assign(world_.tree().bodies.size(), 0);
    for (const Approach& approach : ws_.approaches) {
      if (approach.distance >= epsilon) break;
      if (++held_[static_cast<std::size_t>(approach.body)] > 2) continue;
      const Vector3d a = approach.n_W.unitOrthogonal();
      for (const Vector3d& along : {a, Vector3d(approach.n_W.cross(a))}) {
        numeric::PointJacobianRow(world_.tree(), state(), approach.body, approach.x_W, along,
                                  &NextBound(0, 0, options_.slide_compliance).row);
      }
    }
  }

  void AddWanted() {
    if (stable_) return;
    const double epsilon = world_.model().contact.epsilon;
    int further = 0;
    for (const Approach& approach : ws_.approaches) {
      if (approach.distance < epsilon) continue;
      if (++further > wanted_) break;
      AddSite(approach, kAim * epsilon - approach.distance, kWantedCompliance);
    }
  }

  void AddSite(const Approach& approach, double upper, double compliance) {
    const double epsilon = world_.model().contact.epsilon;
    TaskBound& bound = NextBound(kLowBand * epsilon - approach.distance, upper, compliance);
    numeric::PointJacobianRow(world_.tree(), state(), approach.body, approach.x_W, approach.n_W,
                              &bound.row);
  }

  void AddGoals() {
    for (const PointGoal& goal : options_.goals) {
      const Vector3d p = GoalPoint(goal);
      for (int axis = 0; axis < 3; ++axis) {
        const double rate = (goal.goal_W - p)[axis];
        numeric::PointJacobianRow(world_.tree(), state(), goal.body, p, Vector3d::Unit(axis),
                                  &NextBound(rate, rate, kGoalCompliance).row);
      }
    }
  }

  VectorXd Solve(const Configuration& q) {
    return SolveBoundedStep(world_.tree(), q, {ws_.bounds.data(), count_},
                            {options_.stack, kRounds}, &ws_.bounded);
  }

  const World& world_;
  const RepairOptions& options_;
  ProjectionWorkspace& ws_;
  numeric::StabilityAnswer stability_;
  bool stable_ = false;
  std::vector<SupportLine> lines_;
  std::vector<double> errors_;  // of the goals, since the last iterate outside
  std::size_t count_ = 0;       // bounds in use
  std::vector<int> held_;       // sites of a body
  int unstable_ = 0;            // iterates that were
  int wanted_ = 0;              // sites to be brought into contact besides those that are
};

}  // namespace

ProjectionResult Repair(const World& world, const Configuration& q, const RepairOptions& options,
                        ProjectionWorkspace* workspace) {
  return Repairer(world, options, workspace).Run(q);
}

}  // namespace cguide::planner
