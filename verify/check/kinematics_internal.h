// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "cguide/exact/core/model.h"
#include "cguide/exact/core/path.h"
#include "cguide/exact/core/rational.h"
#include "cguide/verify/check/polynomial_internal.h"

// Forward kinematics along an edge, link by link, as FORMAT.md part 3 defines it.
namespace cguide::check {

/** Part of an edge, s = middle + half t; both are dyadic numbers that doubles hold exactly. */
struct Span {
  double middle = 0.5;
  double half = 0.5;
};

/** A constant pose; `turned` is false where its quaternion is exactly (0, 0, 0, w). */
template <typename I>
struct ConstantPose {
  IntervalVector<I> R[3];  ///< columns
  IntervalVector<I> p;
  bool turned = false;
};

template <typename I>
ConstantPose<I> Lifted(const Pose& X) {
  const Quaternion& q = X.q;
  const Eigen::Matrix<I, 3, 3> M = UnnormalisedRotation(I(q.x), I(q.y), I(q.z), I(q.w));
  const I scale = Inverse(I(q.x) * I(q.x) + I(q.y) * I(q.y) + I(q.z) * I(q.z) + I(q.w) * I(q.w));
  ConstantPose<I> result;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) result.R[j][i] = scale * M(i, j);
  }
  result.p = Lifted<I>(X.p);
  result.turned = q.x != 0 || q.y != 0 || q.z != 0;
  return result;
}

/** X v for a constant point. */
template <typename I>
IntervalVector<I> Apply(const ConstantPose<I>& X, const IntervalVector<I>& v) {
  IntervalVector<I> result = X.p;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result[i] = result[i] + X.R[j][i] * v[j];
  }
  return result;
}

/** X_WL(t). */
template <typename I>
struct MovingPose {
  PolynomialVector<I> R[3];  ///< columns
  PolynomialVector<I> p;
};

/** R v. */
template <typename I>
PolynomialVector<I> Turn(const MovingPose<I>& X, const IntervalVector<I>& v) {
  PolynomialVector<I> result;
  for (int i = 0; i < 3; ++i) {
    result[i] = v[0] * X.R[0][i] + v[1] * X.R[1][i] + v[2] * X.R[2][i];
  }
  return result;
}

/** R v + p. */
template <typename I>
PolynomialVector<I> Apply(const MovingPose<I>& X, const IntervalVector<I>& v) {
  return Turn(X, v) + X.p;
}

template <typename I>
void TurnFrame(const ConstantPose<I>& C, MovingPose<I>* X) {
  if (!C.turned) return;
  const PolynomialVector<I> columns[3] = {Turn(*X, C.R[0]), Turn(*X, C.R[1]), Turn(*X, C.R[2])};
  for (int j = 0; j < 3; ++j) X->R[j] = columns[j];
}

/** cos and sin of theta + d t: Taylor's formula about theta with Lagrange's remainder |d|^3/6. */
template <typename I>
void CosSinOver(const I& theta, const I& d, Polynomial<I>* cos, Polynomial<I>* sin) {
  if (!IsNegative(Magnitude(d) - I(1.0))) {
    *cos = *sin = Polynomial<I>(Join(I(-1.0), I(1.0)));
    return;
  }
  I c, s;
  CosSin(theta, &c, &s);
  const I square = I(0.5) * (d * d), rest = PlusMinus(square * d * Inverse(I(3.0)));
  *cos = {c + rest, -(d * s), -(square * c)};
  *sin = {s + rest, d * c, -(square * s)};
}

/** One joint of the tree with its constants. */
template <typename I>
struct ConstantJoint {
  ConstantPose<I> X_PJ;
  IntervalVector<I> axis;  ///< unit
  int principal = -1;      ///< axis = sign e_principal exactly, or -1
  double sign = 1;
};

template <typename I>
ConstantJoint<I> Lifted(const Joint& joint) {
  ConstantJoint<I> result{Lifted<I>(joint.X_PJ), {}, -1, 1};
  if (joint.type == JointType::kFixed) return result;
  const IntervalVector<I> a = Lifted<I>(joint.axis);
  const I length = Inverse(Norm(a));
  for (int i = 0; i < 3; ++i) {
    result.axis[i] = length * a[i];
    const bool alone = joint.axis[(i + 1) % 3] == 0 && joint.axis[(i + 2) % 3] == 0;
    if (!alone) continue;
    result.principal = i;
    result.sign = joint.axis[i] < 0 ? -1 : 1;
  }
  return result;
}

/** Value of the joint: q0 + s (q1 - q0) of its column, through mimic where it is one. */
template <typename I>
Polynomial<I> ValueOver(const Robot& robot, const Joint& joint, const Edge& edge,
                        const Span& span) {
  const int column = joint.mimic ? robot.joints[joint.mimic->joint].column : joint.column;
  const I from(edge.from.joints[column]), way = I(edge.to.joints[column]) - from;
  Polynomial<I> value(from + I(span.middle) * way, I(span.half) * way, I(0.0));
  if (!joint.mimic) return value;
  return I(joint.mimic->multiplier) * value + Polynomial<I>(I(joint.mimic->offset));
}

/** R Rot(a, theta) = R + sin theta R K + (1 - cos theta) R K^2, K v = a x v [Rodrigues]; K^2 = a
 a^T
 - 1. About an axis of the frame two columns turn. */
template <typename I>
void TurnJoint(const ConstantJoint<I>& joint, const Polynomial<I>& value, MovingPose<I>* X) {
  Polynomial<I> cos, sin;
  CosSinOver(value.c[0], value.c[1], &cos, &sin);
  if (joint.principal >= 0) {
    PolynomialVector<I>&u = X->R[(joint.principal + 1) % 3], &v = X->R[(joint.principal + 2) % 3];
    if (joint.sign < 0) sin = -sin;
    for (int i = 0; i < 3; ++i) {
      const Polynomial<I> turned = cos * u[i] + sin * v[i];
      v[i] = cos * v[i] - sin * u[i];
      u[i] = turned;
    }
    return;
  }
  const PolynomialVector<I> axis = Turn(*X, joint.axis);
  const Polynomial<I> versine = Polynomial<I>(I(1.0)) - cos;
  const PolynomialVector<I> R[3] = {X->R[0], X->R[1], X->R[2]};
  for (int j = 0; j < 3; ++j) {
    const int k = (j + 1) % 3, l = (j + 2) % 3;
    for (int i = 0; i < 3; ++i) {
      // K e_j = a_l e_k - a_k e_l; K^2 e_j = a_j a - e_j.
      const Polynomial<I> once = joint.axis[l] * R[k][i] - joint.axis[k] * R[l][i];
      const Polynomial<I> twice = joint.axis[j] * axis[i] - R[j][i];
      X->R[j][i] = R[j][i] + sin * once + versine * twice;
    }
  }
}

/** f = sin(s phi)/sin(phi) with s = middle + half t, for 0 <= phi <= pi/2, 0 <= s <= 1. It grows
 with phi at a rate below 1, and s <= f <= s + phi^2/5 for phi <= 1 (FORMAT.md, lemma 2). So
 it is expanded at the lower end of phi, and its growth up to the upper end is added. */
template <typename I>
Polynomial<I> SlerpWeight(const I& phi, double middle, double half) {
  const I low = Lower(phi), spread = Upper(phi) - low;
  if (IsNegative(Upper(phi) - I(0x1p-27))) {
    return {I(middle) + Join(I(0.0), phi * phi * Inverse(I(5.0))), I(half), I(0.0)};
  }
  Polynomial<I> cos, sin;
  CosSinOver(I(middle) * low, I(half) * low, &cos, &sin);
  I cos_phi, sin_phi;
  CosSin(low, &cos_phi, &sin_phi);
  Polynomial<I> weight = Inverse(sin_phi) * sin;
  weight.c[0] = weight.c[0] + Join(I(0.0), spread);
  return weight;
}

inline Rational DotOf(const Quaternion& a, const Quaternion& b) {
  return Lift(a.x) * Lift(b.x) + Lift(a.y) * Lift(b.y) + Lift(a.z) * Lift(b.z) +
         Lift(a.w) * Lift(b.w);
}

/** The root's orientation and position: SLERP on the shorter arc, linear. */
template <typename I>
MovingPose<I> RootOver(const Edge& edge, const Span& span) {
  const auto unit = [](const Quaternion& q, double sign) {
    std::array<I, 4> c{I(sign * q.x), I(sign * q.y), I(sign * q.z), I(sign * q.w)};
    const I length = Inverse(Sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2] + c[3] * c[3]));
    for (I& x : c) x = length * x;
    return c;
  };
  const Quaternion &q0 = edge.from.X_WB.q, &q1 = edge.to.X_WB.q;
  const std::array<I, 4> a = unit(q0, 1), b = unit(q1, sgn(DotOf(q0, q1)) < 0 ? -1 : 1);
  I minus(0.0), plus(0.0);
  for (int k = 0; k < 4; ++k) {
    minus = minus + (b[k] - a[k]) * (b[k] - a[k]);
    plus = plus + (b[k] + a[k]) * (b[k] + a[k]);
  }
  const I phi = I(2.0) * Angle(Sqrt(minus), Sqrt(plus));
  const Polynomial<I> from = SlerpWeight(phi, 1 - span.middle, -span.half);
  const Polynomial<I> to = SlerpWeight(phi, span.middle, span.half);
  const Polynomial<I> x = a[0] * from + b[0] * to, y = a[1] * from + b[1] * to,
                      z = a[2] * from + b[2] * to, w = a[3] * from + b[3] * to;
  const auto twice = [](const Polynomial<I>& p) { return p + p; };
  const Polynomial<I> one(I(1.0)), xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z,
                                   yz = y * z, wx = w * x, wy = w * y, wz = w * z;
  MovingPose<I> X;
  X.R[0] = {one - twice(yy + zz), twice(xy + wz), twice(xz - wy)};
  X.R[1] = {twice(xy - wz), one - twice(xx + zz), twice(yz + wx)};
  X.R[2] = {twice(xz + wy), twice(yz - wx), one - twice(xx + yy)};
  for (int i = 0; i < 3; ++i) {
    const I way = I(edge.to.X_WB.p[i]) - I(edge.from.X_WB.p[i]);
    X.p[i] = {I(edge.from.X_WB.p[i]) + I(span.middle) * way, I(span.half) * way, I(0.0)};
  }
  return X;
}

/** Poses of all links over the span. */
template <typename I>
void PlaceLinks(const Robot& robot, const std::vector<ConstantJoint<I>>& joints, const Edge& edge,
                const Span& span, std::vector<MovingPose<I>>* links) {
  links->resize(robot.links.size());
  (*links)[0] = RootOver<I>(edge, span);
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    MovingPose<I>& X = (*links)[i + 1];
    X = (*links)[joint.parent];
    X.p = Apply(X, joints[i].X_PJ.p);
    TurnFrame(joints[i].X_PJ, &X);
    if (joint.type == JointType::kFixed) continue;
    const Polynomial<I> value = ValueOver<I>(robot, joint, edge, span);
    if (joint.type == JointType::kPrismatic) {
      const PolynomialVector<I> axis = Turn(X, joints[i].axis);
      for (int k = 0; k < 3; ++k) X.p[k] = X.p[k] + value * axis[k];
    } else {
      TurnJoint(joints[i], value, &X);
    }
  }
}

/** The robot's centre of mass and its mass. */
template <typename I>
PolynomialVector<I> CenterOfMass(const Robot& robot, const std::vector<MovingPose<I>>& links,
                                 I* mass) {
  PolynomialVector<I> moment;
  *mass = I(0.0);
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    if (robot.links[i].mass == 0) continue;
    const I m(robot.links[i].mass);
    *mass = *mass + m;
    const PolynomialVector<I> c = Apply(links[i], Lifted<I>(robot.links[i].com_L));
    for (int k = 0; k < 3; ++k) moment[k] = moment[k] + m * c[k];
  }
  const I share = Inverse(*mass);
  for (int k = 0; k < 3; ++k) moment[k] = share * moment[k];
  return moment;
}

}  // namespace cguide::check
