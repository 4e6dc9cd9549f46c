#include "posture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace contact_planner {
namespace {

using cguide::Configuration;
using cguide::Verdict;
using cguide::numeric::Contact;
using cguide::numeric::Task;
using Eigen::Vector3d;
using Eigen::VectorXd;

// A contact whose normal leaves its face's by more (cosine) is on an edge of the obstacle.
constexpr double kFlat = 0.999;
constexpr double kLongestPull = 0.05;  // of one step, any component (m, rad)
constexpr double kMargin = 0.005;      // of a new contact to the border of its face (m)

/** One search for a posture. */
class Search {
 public:
  Search(const Setting& setting, const PostureQuery& query, const PostureOptions& options,
         PostureWorkspace* workspace)
      : setting_(setting), query_(query), options_(options), ws_(*workspace) {}

  std::optional<Posture> Run(const cguide::planner::GuidePotential& potential,
                             const Configuration& start);

 private:
  const cguide::numeric::KinematicState& state() const { return ws_.guide.geometry.state; }
  const cguide::numeric::KinematicTree& tree() const { return setting_.world.tree(); }
  Vector3d At(int site) const {
    return SitePosition(setting_.world.model(), tree(), state(), site);
  }
  bool Stable();
  bool InPlace(const Grip& grip) const;
  bool Touches(const Grip& grip) const;
  bool Feasible(const Configuration& q, bool stable);
  Grip Placed() const;

  Task& NextTask();
  void PushPoint(int body, const Vector3d& x_W, const Vector3d& n_W, double rate);
  void PushHeld();
  void PushWanted();
  void PushClearance();
  void PushBalance();
  void PushPlace();
  VectorXd Pull(const Configuration& q) const;
  VectorXd Solve(const Configuration& q);

  const Setting& setting_;
  const PostureQuery& query_;
  const PostureOptions& options_;
  PostureWorkspace& ws_;
};

// Only the bearing grips' contacts count, whatever else happens to be near.
bool Search::Stable() {
  cguide::numeric::FindContacts(setting_.world, &ws_.guide.geometry, &ws_.guide.contacts);
  ws_.bearing.clear();
  for (const Contact& contact : ws_.guide.contacts) {
    const bool bears =
        std::any_of(query_.bearing.begin(), query_.bearing.end(), [&](const Grip& g) {
          return contact.object == setting_.faces[g.face].object &&
                 std::find(g.sites.begin(), g.sites.end(), contact.site) != g.sites.end();
        });
    if (bears) ws_.bearing.push_back(contact);
  }
  auto query = cguide::numeric::PlacedQuery(setting_.world, ws_.guide);
  query.contacts = ws_.bearing;
  return cguide::numeric::TryStability(query, &ws_.guide.stability).verdict == Verdict::kHolds;
}

bool Search::InPlace(const Grip& grip) const {
  for (std::size_t i = 0; i < grip.sites.size(); ++i) {
    if ((At(grip.sites[i]) - grip.at_W[i]).norm() > options_.tolerance) return false;
  }
  return true;
}

// Every site of the grip has a contact with the face.
bool Search::Touches(const Grip& grip) const {
  const Face& face = setting_.faces[grip.face];
  return std::all_of(grip.sites.begin(), grip.sites.end(), [&](int site) {
    return std::any_of(ws_.guide.contacts.begin(), ws_.guide.contacts.end(), [&](const Contact& c) {
      return c.site == site && c.certain && c.object == face.object &&
             c.n_W.dot(face.normal_W) > kFlat;
    });
  });
}

// The wanted grip where it is now.
Grip Search::Placed() const {
  Grip grip = *query_.wanted;
  for (std::size_t i = 0; i < grip.sites.size(); ++i) grip.at_W[i] = At(grip.sites[i]);
  return grip;
}

bool Search::Feasible(const Configuration& q, bool stable) {
  if (!stable || !cguide::numeric::WithinLimits(tree(), q)) return false;
  for (const Grip& grip : query_.held) {
    if (!InPlace(grip) || !Touches(grip)) return false;
  }
  if (query_.wanted) {
    const Face& face = setting_.faces[query_.wanted->face];
    for (const int site : query_.wanted->sites) {
      const double height = face.normal_W.dot(At(site) - face.centre_W);
      if (std::abs(height - options_.gap) > options_.tolerance) return false;
    }
    if (!Touches(*query_.wanted)) return false;
  }
  return cguide::numeric::TestFree(setting_.world, &ws_.guide.geometry).verdict == Verdict::kHolds;
}

Task& Search::NextTask() {
  if (ws_.tasks.size() == ws_.num_tasks) ws_.tasks.emplace_back();
  return ws_.tasks[ws_.num_tasks++];
}

void Search::PushPoint(int body, const Vector3d& x_W, const Vector3d& n_W, double rate) {
  Task& task = NextTask();
  cguide::numeric::PointJacobianRow(tree(), state(), body, x_W, n_W, &task.row);
  task.rate = rate;
}

// The first site in three directions, a second across their line, a third across their plane: six
// rows fix a limb held by three sites or more.
void Search::PushHeld() {
  for (const Grip& grip : query_.held) {
    const int body = setting_.limbs[grip.limb].body;
    std::vector<Vector3d> x;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, grip.sites.size()); ++i) {
      x.push_back(At(grip.sites[i]));
    }
    const auto push = [&](std::size_t i, const Vector3d& direction) {
      PushPoint(body, x[i], direction, direction.dot(grip.at_W[i] - x[i]));
    };
    for (int axis = 0; axis < 3; ++axis) push(0, Vector3d::Unit(axis));
    if (x.size() < 3) continue;
    const Vector3d along = (x[1] - x[0]).normalized();
    const Vector3d normal = along.cross(x[2] - x[0]).normalized();
    push(1, normal);
    push(1, normal.cross(along));
    push(2, normal);
  }
}

// Gap and border of the face.
void Search::PushWanted() {
  if (!query_.wanted) return;
  const Face& face = setting_.faces[query_.wanted->face];
  const int body = setting_.limbs[query_.wanted->limb].body;
  for (std::size_t i = 0; i < query_.wanted->sites.size(); ++i) {
    const Vector3d x = At(query_.wanted->sites[i]);
    const Vector3d from_centre = x - face.centre_W;
    const double height = face.normal_W.dot(from_centre);
    if (i < 3) PushPoint(body, x, face.normal_W, options_.gap - height);  // a plane has three
    for (int k = 0; k < 2; ++k) {
      const Vector3d& axis = k == 0 ? face.u_W : face.v_W;
      const double room = std::max(0.0, face.half[k] - kMargin);
      const double along = axis.dot(from_centre);
      if (std::abs(along) > room) PushPoint(body, x, axis, std::clamp(along, -room, room) - along);
    }
  }
}

void Search::PushClearance() {
  const auto touching = [&](const cguide::numeric::Pair& pair) {
    const auto is = [&](const Grip& g) {
      return setting_.limbs[g.limb].body == pair.body &&
             setting_.faces[g.face].object == pair.other;
    };
    return !pair.self && (std::any_of(query_.held.begin(), query_.held.end(), is) ||
                          (query_.wanted && is(*query_.wanted)));
  };
  for (const cguide::numeric::Pair& pair : setting_.pairs) {
    const auto near = cguide::numeric::PairClearance(setting_.world, pair, options_.clearance,
                                                     &ws_.guide.geometry);
    if (near.overlap || near.lo >= options_.clearance || touching(pair)) continue;
    const Vector3d apart = near.a_W - near.b_W;
    if (apart.norm() < 1e-6) continue;
    const Vector3d n = apart.normalized();
    PushPoint(pair.body, near.a_W, n, options_.clearance - near.lo);
    if (!pair.self) continue;
    VectorXd other;
    cguide::numeric::PointJacobianRow(tree(), state(), pair.other, near.b_W, n, &other);
    ws_.tasks[ws_.num_tasks - 1].row -= other;
  }
}

// The centre of mass over the mean of the bearing sites.
void Search::PushBalance() {
  Vector3d mean = Vector3d::Zero();
  double count = 0;
  for (const Grip& grip : query_.bearing) {
    for (const int site : grip.sites) {
      mean += At(site);
      ++count;
    }
  }
  mean /= count;
  cguide::numeric::ComJacobian(tree(), state(), &ws_.com_jacobian);
  const Vector3d up = -setting_.world.model().gravity.normalized();
  const Vector3d a = up.unitOrthogonal();
  for (const Vector3d& direction : {a, Vector3d(up.cross(a))}) {
    Task& task = NextTask();
    task.row = ws_.com_jacobian.transpose() * direction;
    task.rate = options_.pull * direction.dot(mean - state().com_W);
  }
}

void Search::PushPlace() {
  if (!query_.wanted) return;
  const Face& face = setting_.faces[query_.wanted->face];
  const int body = setting_.limbs[query_.wanted->limb].body;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, query_.wanted->sites.size()); ++i) {
    const Vector3d x = At(query_.wanted->sites[i]);
    for (const Vector3d& axis : {face.u_W, face.v_W}) {
      PushPoint(body, x, axis, options_.pull * axis.dot(query_.wanted->at_W[i] - x));
    }
  }
}

// The velocity that leads to the target, were nothing in the way.
VectorXd Search::Pull(const Configuration& q) const {
  VectorXd v(tree().num_velocities());
  v.head<3>() = query_.target.X_WB.p - q.X_WB.p;
  const auto quaternion = [](const cguide::Quaternion& x) {
    return Eigen::Quaterniond(x.w, x.x, x.y, x.z).normalized();
  };
  const Eigen::AngleAxisd turn(quaternion(query_.target.X_WB.q) * quaternion(q.X_WB.q).conjugate());
  v.segment<3>(3) = turn.angle() * turn.axis();
  v.tail(q.joints.size()) = query_.target.joints - q.joints;
  return v *
         std::min(options_.pull, kLongestPull / std::max(v.cwiseAbs().maxCoeff(), kLongestPull));
}

// The velocity nearest to the pull, in the weighted norm, that does the tasks: their stack is
// solved for the difference.
VectorXd Search::Solve(const Configuration& q) {
  const VectorXd pull = Pull(q);
  for (std::size_t i = 0; i < ws_.num_tasks; ++i) {
    ws_.tasks[i].rate -= ws_.tasks[i].row.dot(pull);
  }
  Configuration shifted = q;
  shifted.joints += pull.tail(q.joints.size());
  cguide::numeric::TaskStackOptions stack;
  stack.damping = 0.01;
  stack.max_translation = 0.1;
  stack.max_rotation = 0.2;
  stack.translation_weight = 10;  // a metre off costs as much as three radians of a joint
  stack.rotation_weight = 2;
  return pull + cguide::numeric::SolveTaskStack(tree(), shifted, {ws_.tasks.data(), ws_.num_tasks},
                                                stack, &ws_.stack);
}

std::optional<Posture> Search::Run(const cguide::planner::GuidePotential& potential,
                                   const Configuration& start) {
  std::optional<Posture> best;
  Configuration q = start;
  for (int i = 0; i < options_.iterations; ++i, ++ws_.iterations) {
    cguide::numeric::Place(setting_.world, q, &ws_.guide.geometry);
    const bool stable = Stable();
    if (Feasible(q, stable)) {
      const double value = potential.Value(q);
      if (!best || value < best->value) best = Posture{q, query_.held, value};
      if (best->value == value && query_.wanted) best->stance = With(query_.held, Placed());
    }
    ws_.num_tasks = 0;
    PushHeld();
    PushWanted();
    PushClearance();
    if (!stable) PushBalance();
    PushPlace();
    const VectorXd step = Solve(q);
    if (step.cwiseAbs().maxCoeff() < 1e-4) break;
    q = cguide::numeric::Integrate(q, step);
    cguide::numeric::ClampToLimits(tree(), &q);
  }
  return best;
}

}  // namespace

Setting::Setting(const cguide::numeric::World& a_world, std::vector<Limb> some_limbs)
    : world(a_world),
      limbs(std::move(some_limbs)),
      faces(FacesOf(a_world.model())),
      pairs(cguide::numeric::AllPairs(a_world)) {}

std::optional<Posture> FindPosture(const Setting& setting, const PostureQuery& query,
                                   const cguide::planner::GuidePotential& potential,
                                   const Configuration& start, const PostureOptions& options,
                                   PostureWorkspace* workspace) {
  return Search(setting, query, options, workspace).Run(potential, start);
}

}  // namespace contact_planner
