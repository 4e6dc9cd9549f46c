#include "cguide/exact/kinematics.h"

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/mp_interval_internal.h"

namespace cguide::exact {
namespace {

using internal::MpInterval;
using internal::MpMatrix;
using internal::MpVector;

MpVector Enclose(const Vector3q& v, int bits) {
  return {MpInterval(v[0], bits), MpInterval(v[1], bits), MpInterval(v[2], bits)};
}

MpMatrix Enclose(const Matrix3q& m, int bits) {
  const auto row = [&](int i) { return Enclose(Vector3q(m.row(i)), bits); };
  return {row(0), row(1), row(2)};
}

MpVector operator+(const MpVector& a, const MpVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

MpVector operator*(const MpMatrix& m, const MpVector& v) {
  const auto row = [&](int i) { return m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2]; };
  return {row(0), row(1), row(2)};
}

MpMatrix operator*(const MpMatrix& a, const MpMatrix& b) {
  MpMatrix c;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      c[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
    }
  }
  return c;
}

/** a/|a|: each component is +- sqrt(a_i^2/|a|^2), a rational under the root. */
MpVector UnitAxis(const Vector3q& a, int bits) {
  const Rational norm = SquaredNorm(a);
  Require(norm != 0, "a joint axis must not vanish");
  MpVector unit;
  for (int k = 0; k < 3; ++k) {
    const MpInterval size = Sqrt(MpInterval(Rational(a[k] * a[k] / norm), bits));
    unit[k] = a[k] < 0 ? -size : size;
  }
  return unit;
}

/** Rodrigues' formula c I + (1 - c) a a^T/|a|^2 + s [a/|a|]. */
MpMatrix AxisRotation(const Vector3q& a, const Rational& angle, int bits) {
  const MpInterval t(angle, bits);
  const MpInterval c = Cos(t), s = Sin(t), rest = MpInterval(Rational(1), bits) + -c;
  const MpVector unit = UnitAxis(a, bits);
  const Rational norm = SquaredNorm(a);
  MpMatrix R;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      R[i][j] = rest * MpInterval(Rational(a[i] * a[j] / norm), bits);
      if (i == j) {
        R[i][j] = R[i][j] + c;
      } else {
        const MpInterval sine = s * unit[3 - i - j];
        R[i][j] = R[i][j] + ((j - i + 3) % 3 == 1 ? -sine : sine);
      }
    }
  }
  return R;
}

struct Frame {
  MpMatrix R;
  MpVector p;
};

Frame Enclose(const Pose& X, int bits) {
  return {Enclose(RotationOf(X.q), bits), Enclose(Lift(X.p), bits)};
}

Frame operator*(const Frame& a, const Frame& b) { return {a.R * b.R, a.p + a.R * b.p}; }

Frame JointMotion(const Joint& joint, const Rational& value, int bits) {
  Frame X = Enclose(Pose{}, bits);
  if (joint.type == JointType::kRevolute || joint.type == JointType::kContinuous) {
    X.R = AxisRotation(Lift(joint.axis), value, bits);
  } else if (joint.type == JointType::kPrismatic) {
    const MpInterval t(value, bits);
    const MpVector unit = UnitAxis(Lift(joint.axis), bits);
    for (int k = 0; k < 3; ++k) X.p[k] = t * unit[k];
  }
  return X;
}

Vector3q Middle(const MpVector& v) { return {v[0].Middle(), v[1].Middle(), v[2].Middle()}; }

/** The Euclidean norm of an error vector is at most the sum of its components' sizes. */
Rational Radius(const MpVector& v) { return v[0].Radius() + v[1].Radius() + v[2].Radius(); }

LinkPlacement ToPlacement(const Frame& X) {
  LinkPlacement result;
  result.p = Middle(X.p);
  result.error_p = Radius(X.p);
  for (int i = 0; i < 3; ++i) {
    result.R.row(i) = Middle(X.R[i]);
    // 2-norm <= Frobenius norm <= sum of the entries' sizes.
    result.error_R += Radius(X.R[i]);
  }
  return result;
}

using MpQuaternion = std::array<MpInterval, 4>;  // x, y, z, w

std::array<Rational, 4> Coefficients(const Quaternion& q) {
  return {Lift(q.x), Lift(q.y), Lift(q.z), Lift(q.w)};
}

/** q/|q|, each component +- sqrt(q_i^2/|q|^2). */
MpQuaternion Normalised(const std::array<Rational, 4>& q, int bits) {
  Rational norm = 0;
  for (const Rational& x : q) norm += x * x;
  Require(norm != 0, "the quaternion of a pose must not vanish");
  MpQuaternion unit;
  for (int k = 0; k < 4; ++k) {
    const MpInterval size = Sqrt(MpInterval(Rational(q[k] * q[k] / norm), bits));
    unit[k] = q[k] < 0 ? -size : size;
  }
  return unit;
}

MpInterval Length(const MpQuaternion& q) {
  MpInterval sum(Rational(0), q[0].Bits());
  for (const MpInterval& x : q) sum = sum + (x * x).NonNegative();
  return Sqrt(sum);
}

/** sin(s angle)/sin(angle) a + ... for unit a, b with a.b > 0. With t = 2 atan2(|b - a|, |b + a|)
 the angle between them. Where sin t cannot be told from 0 every point of the arc is within t of a.
 */
MpQuaternion Slerp(const MpQuaternion& a, const MpQuaternion& b, const Rational& s, int bits) {
  MpQuaternion sum, difference, result;
  for (int k = 0; k < 4; ++k) {
    sum[k] = a[k] + b[k];
    difference[k] = b[k] + -a[k];
  }
  const MpInterval angle = MpInterval(Rational(2), bits) * Atan2(Length(difference), Length(sum));
  const MpInterval sine = Sin(angle);
  if (!sine.IsPositive()) {
    for (int k = 0; k < 4; ++k) result[k] = a[k].WidenedBy(angle);
    return result;
  }
  const MpInterval from = Sin(MpInterval(Rational(1 - s), bits) * angle) / sine;
  const MpInterval to = Sin(MpInterval(s, bits) * angle) / sine;
  for (int k = 0; k < 4; ++k) result[k] = from * a[k] + to * b[k];
  return result;
}

/** The rotation of a quaternion that is known to have norm 1. */
MpMatrix UnitRotation(const MpQuaternion& q, int bits) {
  const auto& [x, y, z, w] = q;
  const MpInterval two(Rational(2), bits), one(Rational(1), bits);
  const auto diagonal = [&](const MpInterval& a, const MpInterval& b) {
    return one + -(two * (a * a + b * b));
  };
  const auto plus = [&](const MpInterval& ab, const MpInterval& wc) { return two * (ab + wc); };
  return {MpVector{diagonal(y, z), plus(x * y, -(w * z)), plus(x * z, w * y)},
          MpVector{plus(x * y, w * z), diagonal(x, z), plus(y * z, -(w * x))},
          MpVector{plus(x * z, -(w * y)), plus(y * z, w * x), diagonal(x, y)}};
}

Frame RootOnEdge(const Edge& edge, const Rational& s, int bits) {
  const Pose &from = edge.from.X_WB, &to = edge.to.X_WB;
  const std::array<Rational, 4> a = Coefficients(from.q);
  std::array<Rational, 4> b = Coefficients(to.q);
  Rational dot = 0;
  for (int k = 0; k < 4; ++k) dot += a[k] * b[k];
  Require(dot != 0, "the end orientations are half a turn apart; the shorter arc is not defined");
  if (dot < 0) {
    for (Rational& x : b) x = -x;
  }
  const Vector3q p0 = Lift(from.p), p1 = Lift(to.p);
  Frame root;
  root.R = UnitRotation(Slerp(Normalised(a, bits), Normalised(b, bits), s, bits), bits);
  root.p = Enclose(Vector3q(p0 + Scaled(s, p1 - p0)), bits);
  return root;
}

/** The robot with its root at `root` and joint i at value(i). */
template <typename Value>
RobotPlacement Place(const Robot& robot, const Frame& root, const Value& value, int bits) {
  std::vector<Frame> frames{root};
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    // The narrow factors first: each product with the parent's frame widens it by up to sqrt 3.
    const Frame X_PC =
        Enclose(joint.X_PJ, bits) * JointMotion(joint, value(static_cast<int>(i)), bits);
    frames.push_back(frames[joint.parent] * X_PC);
  }
  RobotPlacement result;
  Rational total = 0;
  for (const Link& link : robot.links) total += Lift(link.mass);
  Require(total > 0, "the robot has no mass");
  MpVector com = Enclose(Vector3q(Vector3q::Zero()), bits);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    result.links.push_back(ToPlacement(frames[i]));
    const Link& link = robot.links[i];
    if (link.mass == 0) continue;
    const MpInterval share(Rational(Lift(link.mass) / total), bits);
    const MpVector centre = frames[i].p + frames[i].R * Enclose(Lift(link.com_L), bits);
    for (int k = 0; k < 3; ++k) com[k] = com[k] + share * centre[k];
  }
  result.com = Middle(com);
  result.com_error = Radius(com);
  return result;
}

void RequireBits(int bits) {
  Require(bits >= 32 && bits <= 1 << 20, "the precision must be between 32 and 2^20 bits");
}

}  // namespace

Rational JointValue(const Robot& robot, const Configuration& q, int joint) {
  const Joint& j = robot.joints.at(static_cast<std::size_t>(joint));
  if (j.type == JointType::kFixed) return 0;
  if (!j.mimic) return Lift(q.joints[j.column]);
  const Joint& master = robot.joints.at(static_cast<std::size_t>(j.mimic->joint));
  return Lift(j.mimic->multiplier) * Lift(q.joints[master.column]) + Lift(j.mimic->offset);
}

Rational JointValue(const Robot& robot, const Edge& edge, const Rational& s, int joint) {
  const Rational from = JointValue(robot, edge.from, joint);
  return from + s * (JointValue(robot, edge.to, joint) - from);
}

RobotPlacement PlaceRobot(const Robot& robot, const Configuration& q, int bits) {
  RequireBits(bits);
  Require(q.joints.size() == robot.num_columns, "one joint value per column is needed");
  return Place(
      robot, Enclose(q.X_WB, bits), [&](int joint) { return JointValue(robot, q, joint); }, bits);
}

RobotPlacement PlaceRobot(const Robot& robot, const Edge& edge, const Rational& s, int bits) {
  RequireBits(bits);
  Require(
      edge.from.joints.size() == robot.num_columns && edge.to.joints.size() == robot.num_columns,
      "one joint value per column is needed");
  Require(s >= 0 && s <= 1, "s must lie in [0, 1]");
  return Place(
      robot, RootOnEdge(edge, s, bits),
      [&](int joint) { return JointValue(robot, edge, s, joint); }, bits);
}

LinkPlacement ExactPlacement(const Pose& X) { return {RotationOf(X.q), Lift(X.p), 0, 0}; }

bool WithinLimits(const Robot& robot, const Configuration& q) {
  Require(q.joints.size() == robot.num_columns, "one joint value per column is needed");
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    if (joint.type != JointType::kRevolute && joint.type != JointType::kPrismatic) continue;
    const Rational value = JointValue(robot, q, static_cast<int>(i));
    if (value < Lift(joint.lower) || value > Lift(joint.upper)) return false;
  }
  return true;
}

}  // namespace cguide::exact
