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

}  // namespace

Rational JointValue(const Robot& robot, const Configuration& q, int joint) {
  const Joint& j = robot.joints.at(static_cast<std::size_t>(joint));
  if (j.type == JointType::kFixed) return 0;
  if (!j.mimic) return Lift(q.joints[j.column]);
  const Joint& master = robot.joints.at(static_cast<std::size_t>(j.mimic->joint));
  return Lift(j.mimic->multiplier) * Lift(q.joints[master.column]) + Lift(j.mimic->offset);
}

RobotPlacement PlaceRobot(const Robot& robot, const Configuration& q, int bits) {
  Require(bits >= 32 && bits <= 1 << 20, "the precision must be between 32 and 2^20 bits");
  Require(q.joints.size() == robot.num_columns, "one joint value per column is needed");
  std::vector<Frame> frames{Enclose(q.X_WB, bits)};
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    // The narrow factors first: each product with the parent's frame widens it by up to sqrt 3.
    const Frame X_PC = Enclose(joint.X_PJ, bits) *
                       JointMotion(joint, JointValue(robot, q, static_cast<int>(i)), bits);
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
