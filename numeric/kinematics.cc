#include "cguide/numeric/kinematics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cguide/exact/core/error.h"
#include "cguide/exact/core/rational.h"

namespace cguide::numeric {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Error model, u = 2^-53, products of 3x3 matrices of 2-norm 1 (Frobenius norm sqrt 3):
//   ToTransform: M(q) has entries of magnitude <= |q|^2 formed by at most 5 roundings each, |q|^2
//   by
//     4, the quotient by 1: every entry is within 10 u, so the matrix within 3 * 10 u < 32 u.
//   Rot(a, t): the unit axis is within 4 u per entry, sin and cos within 2 u (glibc documents 1
//   ulp);
//     an entry a_i a_j (1 - c) + a_k s has an error below 20 u, the matrix one below 60 u.
//   Each product adds gamma_3 |A|_F |B|_F <= 3 u * 3 * 1.01 < 10 u.
// A moving joint therefore adds at most 32 (X_PJ) + 60 (Rot) + 2 * 10 u, rounded up to kJointError;
// R entering with an error e leaves with at most e (1 + 2^-40) + kJointError, which the slack
// covers for every tree of fewer than 10^6 joints.
constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;
constexpr double kRotationError = 32 * kUnit;
constexpr double kJointError = 128 * kUnit;
// Links welded to a body: X_BL is a product of such transforms, each adding kRotationError and a
// product's 10 u; its error is carried into the error of its body (slack), from where the recursion
// hands it on to the children, whose X_PJ contains X_BL.
constexpr double kWeldError = 48 * kUnit;
// R p + t with |R p| <= 1.01 |p|: gamma_4 per component, three components, and the error of p
// itself (a stored double, or a merged one whose error is carried in BodyNode by the same rule).
constexpr double kPointError = 8 * kUnit;

Matrix3d AxisRotation(const Vector3d& a, double sine, double cosine) {
  const double v = 1 - cosine;
  const double xy = a.x() * a.y() * v, xz = a.x() * a.z() * v, yz = a.y() * a.z() * v;
  const Vector3d s = sine * a;
  Matrix3d R;
  R << a.x() * a.x() * v + cosine, xy - s.z(), xz + s.y(),  //
      xy + s.z(), a.y() * a.y() * v + cosine, yz - s.x(),   //
      xz - s.y(), yz + s.x(), a.z() * a.z() * v + cosine;
  return R;
}

// The smallest interval of doubles x with lower <= multiplier x + offset <= upper, exactly.
ColumnLimits MimicLimits(const Joint& joint) {
  const Mimic& mimic = *joint.mimic;
  ColumnLimits result{-std::numeric_limits<double>::infinity(),
                      std::numeric_limits<double>::infinity(), false};
  if (joint.type == JointType::kContinuous || mimic.multiplier == 0) return result;
  Rational low = (Lift(joint.lower) - Lift(mimic.offset)) / Lift(mimic.multiplier);
  Rational high = (Lift(joint.upper) - Lift(mimic.offset)) / Lift(mimic.multiplier);
  if (low > high) std::swap(low, high);
  return {RoundUp(low), RoundDown(high), true};
}

void Intersect(const ColumnLimits& other, ColumnLimits* limits) {
  if (!other.bounded) return;
  limits->lower = std::max(limits->lower, other.lower);
  limits->upper = std::min(limits->upper, other.upper);
  limits->bounded = true;
}

std::vector<ColumnLimits> MakeLimits(const Robot& robot) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<ColumnLimits> limits(robot.num_columns, {-kInfinity, kInfinity, false});
  for (const Joint& joint : robot.joints) {
    if (joint.column >= 0 && joint.type != JointType::kContinuous) {
      Intersect({joint.lower, joint.upper, true}, &limits[joint.column]);
    } else if (joint.mimic) {
      Intersect(MimicLimits(joint), &limits[robot.joints[joint.mimic->joint].column]);
    }
  }
  for (const Joint& joint : robot.joints) {
    if (joint.column >= 0 && limits[joint.column].lower > limits[joint.column].upper) {
      throw Error(Error::Code::kBadInput, "joint \"" + joint.name +
                                              "\": no value satisfies its limits and those of the "
                                              "joints that mimic it");
    }
  }
  return limits;
}

void JoinBody(const Robot& robot, const std::vector<Transform>& X_BL, int body,
              std::vector<BodyNode>* bodies) {
  BodyNode& node = (*bodies)[body];
  node.joint = robot.links[robot.bodies[body].links.front()].joint;
  if (node.joint < 0) return;
  const Joint& joint = robot.joints[node.joint];
  node.parent = robot.links[joint.parent].body;
  node.type = joint.type;
  node.column = joint.column;
  if (joint.mimic) {
    node.column = robot.joints[joint.mimic->joint].column;
    node.multiplier = joint.mimic->multiplier;
    node.offset = joint.mimic->offset;
  }
  node.X_PJ = X_BL[joint.parent] * ToTransform(joint.X_PJ);
  node.axis = joint.axis.normalized();
  node.depth = (*bodies)[node.parent].depth + 1;
}

void AddMass(const Robot& robot, const KinematicTree& tree, int body, BodyNode* node) {
  Vector3d moment = Vector3d::Zero();
  for (int link : robot.bodies[body].links) {
    node->mass += robot.links[link].mass;
    moment += robot.links[link].mass * (tree.X_BL[link] * robot.links[link].com_L);
  }
  if (node->mass > 0) node->com_B = moment / node->mass;
}

double JointValue(const BodyNode& node, const Configuration& q) {
  return node.multiplier * q.joints[node.column] + node.offset;
}

void PlaceChild(const BodyNode& node, int body, double value, KinematicState* state) {
  const Transform& X_WP = state->X_WB[node.parent];
  Transform& X_WB = state->X_WB[body];
  const Matrix3d R_WJ = X_WP.R * node.X_PJ.R;
  X_WB.p = X_WP * node.X_PJ.p;
  state->axis_W[body] = R_WJ * node.axis;
  const double arm = node.X_PJ.p.lpNorm<1>();
  double error_R = state->error_R[node.parent] + kJointError;
  double error_p = state->error_p[node.parent] + state->error_R[node.parent] * arm +
                   kPointError * (arm + X_WP.p.lpNorm<1>());
  if (node.type == JointType::kPrismatic) {
    X_WB.R = R_WJ;
    X_WB.p += value * state->axis_W[body];
    error_p += (error_R + kPointError) * std::abs(value) + kPointError * X_WB.p.lpNorm<1>();
  } else {
    X_WB.R = R_WJ * AxisRotation(node.axis, std::sin(value), std::cos(value));
  }
  // A mimic value carries two roundings; d Rot / dt has norm 1.
  if (node.multiplier != 1 || node.offset != 0) {
    const double slip = 2 * kUnit * (std::abs(value) + 2 * std::abs(node.offset));
    (node.type == JointType::kPrismatic ? error_p : error_R) += slip;
  }
  state->error_R[body] = error_R + node.slack_R;
  state->error_p[body] = error_p + node.slack_p;
}

void UpdateCom(const KinematicTree& tree, KinematicState* state) {
  Vector3d moment = Vector3d::Zero();
  double error = 0, spread = 0;
  for (std::size_t b = 0; b < tree.bodies.size(); ++b) {
    const BodyNode& node = tree.bodies[b];
    if (node.mass == 0) continue;
    const Vector3d c_W = state->X_WB[b] * node.com_B;
    moment += node.mass * c_W;
    const double arm = node.com_B.lpNorm<1>();
    // The merged com_B has the relative error of a short weighted sum, covered by kRotationError.
    error += node.mass * (state->error_R[b] * arm + state->error_p[b] + kRotationError * arm);
    spread += node.mass * c_W.lpNorm<1>();
  }
  state->com_W = moment / tree.mass;
  // gamma_{n+2} for the sum over n bodies, and as much again for the total mass and the division.
  const double terms = 2.0 * static_cast<double>(tree.bodies.size()) + 8;
  state->com_error = (error + terms * kUnit * spread) / tree.mass * (1 + 1e-12);
}

}  // namespace

Transform ToTransform(const Pose& X_AB) {
  const Quaternion& q = X_AB.q;
  const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  Require(std::isfinite(square) && square > 0, "the quaternion of a pose is zero or not finite");
  return {UnnormalisedRotation(q.x, q.y, q.z, q.w) / square, X_AB.p};
}

void KinematicTree::WeldLinks(const Robot& robot) {
  X_BL.resize(robot.links.size());
  link_body.resize(robot.links.size());
  std::vector<double> error_R(robot.links.size(), 0), error_p(robot.links.size(), 0);
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    link_body[i] = robot.links[i].body;
    BodyNode& node = bodies[link_body[i]];
    const bool first = robot.bodies[link_body[i]].links.front() == static_cast<int>(i);
    if (first) continue;
    const Joint& joint = robot.joints[robot.links[i].joint];
    const Transform X_PL = ToTransform(joint.X_PJ);
    X_BL[i] = X_BL[joint.parent] * X_PL;
    const double arm = X_PL.p.lpNorm<1>();
    error_R[i] = error_R[joint.parent] + kWeldError;
    error_p[i] = error_p[joint.parent] + error_R[joint.parent] * arm +
                 kPointError * (arm + X_BL[i].p.lpNorm<1>());
    // |p_L| <= |p_B| + |p_BL|, and moving a point by X_BL rounds once more.
    const double rounding = error_R[i] + kPointError;
    node.slack_R = std::max(node.slack_R, rounding);
    node.slack_p = std::max(node.slack_p, error_p[i] + 2 * rounding * X_BL[i].p.lpNorm<1>());
  }
}

KinematicTree::KinematicTree(const Robot& robot) : num_columns(robot.num_columns) {
  bodies.resize(robot.bodies.size());
  WeldLinks(robot);
  for (int b = 0; b < static_cast<int>(robot.bodies.size()); ++b) {
    JoinBody(robot, X_BL, b, &bodies);
    AddMass(robot, *this, b, &bodies[b]);
    mass += bodies[b].mass;
  }
  limits = MakeLimits(robot);
  SetReach();
}

void KinematicTree::SetReach() {
  std::vector<double> path(bodies.size(), 0);
  for (std::size_t b = 1; b < bodies.size(); ++b) {
    double slide = 0;
    if (bodies[b].type == JointType::kPrismatic) {
      const ColumnLimits& limit = limits[bodies[b].column];
      slide =
          std::abs(bodies[b].multiplier) * std::max(std::abs(limit.lower), std::abs(limit.upper)) +
          std::abs(bodies[b].offset);
    }
    path[b] = path[bodies[b].parent] + bodies[b].X_PJ.p.norm() + slide;
    reach = std::max(reach, path[b]);
  }
}

void ForwardKinematics(const KinematicTree& tree, const Configuration& q, KinematicState* state) {
  Require(q.joints.size() == tree.num_columns, "the configuration has another number of joints");
  RequireRoundToNearest();
  const std::size_t n = tree.bodies.size();
  state->X_WB.resize(n);
  state->axis_W.resize(n);
  state->error_R.resize(n);
  state->error_p.resize(n);
  state->X_WB[0] = ToTransform(q.X_WB);
  state->axis_W[0].setZero();
  state->error_R[0] = kRotationError + tree.bodies[0].slack_R;
  state->error_p[0] = tree.bodies[0].slack_p;
  for (std::size_t b = 1; b < n; ++b) {
    const BodyNode& node = tree.bodies[b];
    PlaceChild(node, static_cast<int>(b), JointValue(node, q), state);
  }
  UpdateCom(tree, state);
}

void PointJacobianRow(const KinematicTree& tree, const KinematicState& state, int body,
                      const Vector3d& p_W, const Vector3d& n_W, Eigen::VectorXd* row) {
  row->setZero(tree.num_velocities());
  row->head<3>() = n_W;
  row->segment<3>(3) = (p_W - state.X_WB[0].p).cross(n_W);
  for (int b = body; tree.bodies[b].parent >= 0; b = tree.bodies[b].parent) {
    const BodyNode& node = tree.bodies[b];
    const Vector3d& a_W = state.axis_W[b];
    const double rate = node.type == JointType::kPrismatic
                            ? a_W.dot(n_W)
                            : a_W.dot((p_W - state.X_WB[b].p).cross(n_W));
    (*row)[6 + node.column] += node.multiplier * rate;
  }
}

void ComJacobian(const KinematicTree& tree, const KinematicState& state,
                 Eigen::MatrixXd* jacobian) {
  jacobian->setZero(3, tree.num_velocities());
  jacobian->leftCols<3>().setIdentity();
  const Vector3d r = state.com_W - state.X_WB[0].p;
  jacobian->middleCols<3>(3) << 0, r.z(), -r.y(), -r.z(), 0, r.x(), r.y(), -r.x(), 0;
  // Mass and first moment of the subtree that each joint moves, children before parents.
  std::vector<double> mass(tree.bodies.size());
  std::vector<Vector3d> moment(tree.bodies.size());
  for (std::size_t b = 0; b < tree.bodies.size(); ++b) {
    mass[b] = tree.bodies[b].mass;
    moment[b] = mass[b] * (state.X_WB[b] * tree.bodies[b].com_B);
  }
  for (std::size_t b = tree.bodies.size(); b-- > 1;) {
    const BodyNode& node = tree.bodies[b];
    mass[node.parent] += mass[b];
    moment[node.parent] += moment[b];
    const Vector3d& a_W = state.axis_W[b];
    const Vector3d rate = node.type == JointType::kPrismatic
                              ? Vector3d(mass[b] * a_W)
                              : a_W.cross(moment[b] - mass[b] * state.X_WB[b].p);
    jacobian->col(6 + node.column) += node.multiplier / tree.mass * rate;
  }
}

Configuration Integrate(const Configuration& q, const Eigen::VectorXd& v) {
  Require(v.size() == q.joints.size() + 6, "the velocity has another size than the configuration");
  Configuration result;
  result.X_WB.p = q.X_WB.p + v.head<3>();
  result.joints = q.joints + v.tail(q.joints.size());
  const Vector3d half = 0.5 * v.segment<3>(3);
  const double angle = half.norm();
  const double sinc = angle < 1e-8 ? 1 : std::sin(angle) / angle;
  const Vector3d e = sinc * half;
  const double c = std::cos(angle);
  const Quaternion& a = q.X_WB.q;
  const Vector3d u(a.x, a.y, a.z);
  const Vector3d w = c * u + a.w * e + e.cross(u);
  const double s = c * a.w - e.dot(u);
  const double norm = std::sqrt(w.squaredNorm() + s * s);
  result.X_WB.q = {w.x() / norm, w.y() / norm, w.z() / norm, s / norm};
  return result;
}

bool WithinLimits(const KinematicTree& tree, const Configuration& q) {
  for (int i = 0; i < tree.num_columns; ++i) {
    if (!(q.joints[i] >= tree.limits[i].lower && q.joints[i] <= tree.limits[i].upper)) return false;
  }
  return true;
}

void ClampToLimits(const KinematicTree& tree, Configuration* q) {
  for (int i = 0; i < tree.num_columns; ++i) {
    q->joints[i] = std::clamp(q->joints[i], tree.limits[i].lower, tree.limits[i].upper);
  }
}

}  // namespace cguide::numeric
