#include "cguide/verify/edge_kinematics.h"

#include <algorithm>
#include <array>

#include "cguide/exact/core/error.h"
#include "cguide/exact/core/rational.h"

namespace cguide::verify {
namespace {

using Eigen::Array4d;
using Eigen::Vector3d;
using numeric::BodyNode;
using numeric::KinematicTree;
using numeric::Transform;

// What the doubles of the prepared tree differ from the model's real constants: X_PJ.R by 32 u
// (ToTransform); the axis by 4 u an entry, which turns the joint's rotation, a function of the axis
// of slope at most 4 in the 2-norm (entries a_i a_j (1 - c) + a_k s), by less than 64 u; and A of
// Aligning by 32 u, used twice. All factors have norm 1 up to such errors, so that errors add, up
// to a product of two of them that kGrowth covers. As in numeric/kinematics.cc merged links bring
// their slack.
constexpr double kConstantError = 256 * kUnit;
constexpr double kGrowth = 1 + 0x1p-40;

/** sum_i x_i a_i (+ b): the coefficients have at most four terms, each product and sum rounded
 once: 5 u of the sum of their sizes. */
template <int N>
TaylorVector<N> Combine(const TaylorVector<N> (&a)[3], const Vector3d& x,
                        const TaylorVector<N>* b) {
  TaylorVector<N> sum;
  Array4d magnitude = Array4d::Zero();
  for (int k = 0; k <= N; ++k) {
    sum.c[k] = x[0] * a[0].c[k] + x[1] * a[1].c[k] + x[2] * a[2].c[k];
    magnitude += std::abs(x[0]) * a[0].c[k].abs() + std::abs(x[1]) * a[1].c[k].abs() +
                 std::abs(x[2]) * a[2].c[k].abs();
    if (!b) continue;
    sum.c[k] += b->c[k];
    magnitude += b->c[k].abs();
  }
  sum.r = std::abs(x[0]) * a[0].r + std::abs(x[1]) * a[1].r + std::abs(x[2]) * a[2].r;
  if (b) sum.r += b->r;
  sum.r = (sum.r + 5 * kUnit * magnitude) * kUp + kTiny;
  return sum;
}

/** R C for a constant matrix. */
template <int N>
void TurnBy(const Eigen::Matrix3d& C, TaylorVector<N> (*R)[3]) {
  if (C == Eigen::Matrix3d::Identity()) return;
  const TaylorVector<N> columns[3] = {(*R)[0], (*R)[1], (*R)[2]};
  for (int j = 0; j < 3; ++j) (*R)[j] = Combine<N>(columns, C.col(j), nullptr);
}

/** R times the rotation about its own axis k: two columns turn. */
template <int N>
void TurnAboutAxis(int k, const CosSin<N>& turn, TaylorVector<N> (*R)[3]) {
  TaylorVector<N>&a = (*R)[(k + 1) % 3], &b = (*R)[(k + 2) % 3];
  const TaylorVector<N> x = turn.cos * a + turn.sin * b;
  b = turn.cos * b - turn.sin * a;
  a = x;
}

/** The half turn about a + e, e the signed unit vector nearest to a: a rotation, 2 v v^T/|v|^2 - I,
 that takes e to a. |v|^2 >= 2 for unit a, so nothing cancels: entries are within 10 u. */
Eigen::Matrix3d Aligning(const Vector3d& a, int k) {
  Vector3d v = a;
  v[k] += a[k] < 0 ? -1 : 1;
  return 2 / v.squaredNorm() * (v * v.transpose()) - Eigen::Matrix3d::Identity();
}

/** The joint's value over the leaf: value + slope t, within error. */
struct Motion {
  double value = 0;
  double slope = 0;
  double error = 0;
};

// theta = q0 + middle (q1 - q0) and d = half (q1 - q0) take at most three roundings of numbers up
// to |q0| + |q1|, each: 8 u of that covers both. A mimic joint adds a product and a sum.
Motion JointMotion(const BodyNode& node, const Edge& edge, const Leaf& leaf) {
  const double from = edge.from.joints[node.column], to = edge.to.joints[node.column];
  const double way = to - from;
  Motion motion{from + leaf.middle * way, leaf.half * way,
                8 * kUnit * (std::abs(from) + std::abs(to))};
  if (node.multiplier != 1 || node.offset != 0) {
    const double size = std::abs(node.multiplier) * (std::abs(from) + std::abs(to));
    motion.value = node.multiplier * motion.value + node.offset;
    motion.slope *= node.multiplier;
    motion.error =
        std::abs(node.multiplier) * motion.error + 4 * kUnit * (size + std::abs(node.offset));
  }
  motion.error = motion.error * kUp + kTiny;
  return motion;
}

template <int N>
TaylorModel<N> Affine(double value, double slope, double error) {
  TaylorModel<N> result = Constant<N>(value);
  if constexpr (N >= 1) {
    result.c[1] = slope;
    result.r = error;
  } else {
    result.r = (error + std::abs(slope)) * kUp;
  }
  return result;
}

using Coefficients = Eigen::Vector4d;  // x, y, z, w

Coefficients Normalised(const Quaternion& q) {
  const Coefficients c(q.x, q.y, q.z, q.w);
  return c / std::sqrt(c.squaredNorm());
}

/** Sign of q0.q1, which says where the shorter arc lies; `dot` is its value for the normalised ends
 within 16 u. */
int DotSign(const Quaternion& a, const Quaternion& b, double dot) {
  if (std::abs(dot) > 32 * kUnit) return dot > 0 ? 1 : -1;
  const Rational exact =
      Lift(a.x) * Lift(b.x) + Lift(a.y) * Lift(b.y) + Lift(a.z) * Lift(b.z) + Lift(a.w) * Lift(b.w);
  Require(exact != 0,
          "the end orientations of an edge are half a turn apart; add a waypoint between them");
  return sgn(exact);
}

/** f(s) = sin(s phi)/sin(phi) with s = middle + half t, for the real angle phi within 64 u of the
 double `angle`, 0 <= phi <= pi/2.

 In phi, f has slope at most 1/2: with g = s cos(s phi) sin phi - sin(s phi) cos phi, df/dphi =
 g/sin^2 phi, g(0) = 0 and g' = (1 - s^2) sin(s phi) sin phi <= 0.385 phi^2, so g <= 0.129 phi^3
 while sin^2 phi >= (2 phi/pi)^2. The error of `angle` so costs 32 u; and f = s + at most phi^2/2,
 which serves where sin phi is small. Elsewhere each coefficient sin^(k)(middle phi) (half phi)^k/k!
 / sin phi is below 2 and takes at most 2 N + 6 roundings, the library's sines included, each of
 which is small relative to its value. */
template <int N>
TaylorModel<N> SlerpWeight(double angle, double middle, double half) {
  if (angle < 0x1p-27) {
    const double bound = angle + 64 * kUnit;
    return Affine<N>(middle, half, bound * bound * kUp);
  }
  const double sine = std::sin(angle), theta = middle * angle, d = half * angle;
  const double s = std::sin(theta), c = std::cos(theta);
  const double derivative[4] = {s, c, -s, -c};
  TaylorModel<N> weight{};
  double power = 1 / sine;
  for (int k = 0; k <= N; ++k) {
    weight.c[k] = derivative[k % 4] * power;
    power *= d / (k + 1);
  }
  weight.r = (std::abs(power) + (64 + 16 * N) * kUnit) * kUp;
  return weight;
}

/** The unit quaternion of SLERP over the leaf. Normalised ends are within 4 u a component, 8 u in
 norm; |b - a| and |b + a| within 20 u, and phi = 2 atan2(|b - a|, |b + a|), whose gradient has norm
 1 in them because their squares sum to 4, within 64 u. */
template <int N>
std::array<TaylorModel<N>, 4> SlerpOver(const Edge& edge, const Leaf& leaf) {
  const Coefficients a = Normalised(edge.from.X_WB.q);
  Coefficients b = Normalised(edge.to.X_WB.q);
  if (DotSign(edge.from.X_WB.q, edge.to.X_WB.q, a.dot(b)) < 0) b = -b;
  const double angle =
      2 * std::atan2(std::sqrt((b - a).squaredNorm()), std::sqrt((b + a).squaredNorm()));
  const TaylorModel<N> from = SlerpWeight<N>(angle, 1 - leaf.middle, -leaf.half);
  const TaylorModel<N> to = SlerpWeight<N>(angle, leaf.middle, leaf.half);
  std::array<TaylorModel<N>, 4> q;
  for (int k = 0; k < 4; ++k) {
    q[k] = a[k] * from + b[k] * to;
    q[k].r += 16 * kUnit;  // weights are at most 1, ends within 4 u
  }
  return q;
}

/** R of a quaternion whose real values have norm 1. */
template <int N>
void UnitRotation(const std::array<TaylorModel<N>, 4>& q, TaylorVector<N> (*R)[3]) {
  const auto& [x, y, z, w] = q;
  const TaylorModel<N> one = Constant<N>(1.0), xx = x * x, yy = y * y, zz = z * z, xy = x * y,
                       xz = x * z, yz = y * z, wx = w * x, wy = w * y, wz = w * z;
  const TaylorModel<N> entries[3][3] = {{one - 2.0 * (yy + zz), 2.0 * (xy + wz), 2.0 * (xz - wy)},
                                        {2.0 * (xy - wz), one - 2.0 * (xx + zz), 2.0 * (yz + wx)},
                                        {2.0 * (xz + wy), 2.0 * (yz - wx), one - 2.0 * (xx + yy)}};
  for (int j = 0; j < 3; ++j) {
    (*R)[j] = Constant<N>(Vector3d(Vector3d::Zero()));
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k <= N; ++k) (*R)[j].c[k][i] = entries[j][i].c[k];
      (*R)[j].r[i] = entries[j][i].r;
    }
  }
}

template <int N>
void PlaceRoot(const KinematicTree& tree, const Edge& edge, const Leaf& leaf, TaylorPose<N>* X) {
  UnitRotation<N>(SlerpOver<N>(edge, leaf), &X->R);
  const Vector3d &from = edge.from.X_WB.p, &to = edge.to.X_WB.p;
  X->p = Constant<N>(Vector3d(Vector3d::Zero()));
  for (int i = 0; i < 3; ++i) {
    const double way = to[i] - from[i];
    const TaylorModel<N> p = Affine<N>(from[i] + leaf.middle * way, leaf.half * way,
                                       8 * kUnit * (std::abs(from[i]) + std::abs(to[i])) + kTiny);
    for (int k = 0; k <= N; ++k) X->p.c[k][i] = p.c[k];
    X->p.r[i] = p.r;
  }
  X->error_R = tree.bodies[0].slack_R;
  X->error_p = tree.bodies[0].slack_p;
}

template <int N>
void PlaceChild(const BodyNode& node, const Motion& motion, const TaylorPose<N>& parent,
                TaylorPose<N>* X) {
  for (int j = 0; j < 3; ++j) X->R[j] = parent.R[j];
  X->p = Combine<N>(X->R, node.X_PJ.p, &parent.p);
  TurnBy<N>(node.X_PJ.R, &X->R);
  X->error_R = (parent.error_R + kConstantError + node.slack_R) * kGrowth;
  X->error_p =
      (parent.error_p + parent.error_R * node.X_PJ.p.template lpNorm<1>() + node.slack_p) * kGrowth;
  if (node.type == JointType::kPrismatic) {
    const TaylorVector<N> axis = Combine<N>(X->R, node.axis, nullptr);
    X->p = X->p + Affine<N>(motion.value, motion.slope, motion.error) * axis;
    const double reach = std::abs(motion.value) + std::abs(motion.slope) + motion.error;
    X->error_p = (X->error_p + (parent.error_R + kConstantError) * reach) * kGrowth;
    return;
  }
  int k = 0;
  node.axis.cwiseAbs().maxCoeff(&k);
  const double sign = node.axis[k] < 0 ? -1 : 1;
  const CosSin<N> turn = CosSinOf<N>(sign * motion.value, sign * motion.slope, motion.error);
  if (node.axis[(k + 1) % 3] == 0 && node.axis[(k + 2) % 3] == 0) {
    TurnAboutAxis<N>(k, turn, &X->R);
    return;
  }
  const Eigen::Matrix3d A = Aligning(node.axis, k);
  TurnBy<N>(A, &X->R);
  TurnAboutAxis<N>(k, turn, &X->R);
  TurnBy<N>(A.transpose(), &X->R);
}

/** m_b/M weights the body's centre; both the quotient and com_B carry the rounding of a sum over
 the links, 2 n + 8 roundings for n bodies as in numeric/kinematics.cc. */
template <int N>
void PlaceCom(const KinematicTree& tree, TaylorState<N>* state) {
  TaylorVector<N> com = Constant<N>(Vector3d(Vector3d::Zero()));
  const double terms = 2.0 * static_cast<double>(tree.bodies.size()) + 40;
  for (std::size_t b = 0; b < tree.bodies.size(); ++b) {
    const BodyNode& node = tree.bodies[b];
    if (node.mass == 0) continue;
    const TaylorVector<N> centre = PointOnBody<N>(state->X_WB[b], node.com_B);
    const double share = node.mass / tree.mass;
    TaylorVector<N> part = share * centre;
    part.r.template head<3>() +=
        terms * kUnit * share *
        (Magnitude(centre) + centre.r + node.com_B.template lpNorm<1>()).template head<3>();
    com = com + part;
  }
  com.r *= kUp;
  state->com_W = com;
}

}  // namespace

template <int N>
TaylorVector<N> PointOnBody(const TaylorPose<N>& X_WB, const Vector3d& p_B) {
  TaylorVector<N> p_W = Combine<N>(X_WB.R, p_B, &X_WB.p);
  const double error = X_WB.error_R * p_B.template lpNorm<1>() + X_WB.error_p;
  p_W.r.template head<3>() += error * kUp;
  p_W.r *= kUp;
  return p_W;
}

template <int N>
TaylorVector<N> VectorOnBody(const TaylorPose<N>& X_WB, const Vector3d& v_B) {
  TaylorVector<N> v_W = Combine<N>(X_WB.R, v_B, nullptr);
  v_W.r.template head<3>() += X_WB.error_R * v_B.template lpNorm<1>() * kUp;
  v_W.r *= kUp;
  return v_W;
}

template <int N>
void EvaluateEdge(const KinematicTree& tree, const Edge& edge, const Leaf& leaf,
                  TaylorState<N>* state) {
  Require(edge.from.joints.size() == tree.num_columns && edge.to.joints.size() == tree.num_columns,
          "the edge has another number of joints than the robot");
  numeric::RequireRoundToNearest();
  state->X_WB.resize(tree.bodies.size());
  PlaceRoot<N>(tree, edge, leaf, &state->X_WB[0]);
  for (std::size_t b = 1; b < tree.bodies.size(); ++b) {
    const BodyNode& node = tree.bodies[b];
    PlaceChild<N>(node, JointMotion(node, edge, leaf), state->X_WB[node.parent], &state->X_WB[b]);
  }
  PlaceCom<N>(tree, state);
}

#define CGUIDE_INSTANTIATE(N)                                                                     \
  template void EvaluateEdge<N>(const KinematicTree&, const Edge&, const Leaf&, TaylorState<N>*); \
  template TaylorVector<N> PointOnBody<N>(const TaylorPose<N>&, const Vector3d&);                 \
  template TaylorVector<N> VectorOnBody<N>(const TaylorPose<N>&, const Vector3d&);
CGUIDE_INSTANTIATE(0)
CGUIDE_INSTANTIATE(1)
CGUIDE_INSTANTIATE(2)
CGUIDE_INSTANTIATE(3)
#undef CGUIDE_INSTANTIATE

}  // namespace cguide::verify
