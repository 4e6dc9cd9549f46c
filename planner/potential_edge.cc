#include <algorithm>
#include <cmath>

#include "cguide/exact/core/error.h"
#include "cguide/planner/potential_edge_internal.h"

namespace cguide::planner {
namespace {

using Eigen::Vector4d;

// How far below the best sample the minimum may be when the search ends.
constexpr double kGap = 1e-10;
// Motions shorter than these over a whole edge count as none, which changes no distance by more.
// Above them dp.dp has all its digits (no underflow), and rounding (1e-16) turns e2 by 1e-4 at
// most, which moves no point of the edge by more than 1e-4 times the angle.
constexpr double kNoMotion = 1e-100;
constexpr double kNoTurn = 1e-12;
// Every third step at least halves the interval: its width then is below the last bit of 1.
constexpr int kMaxSteps = 160;

Vector4d UnitCoefficients(const Quaternion& q) { return Vector4d(q.x, q.y, q.z, q.w).normalized(); }

}  // namespace

PotentialPoint::PotentialPoint(const Configuration& configuration)
    : p(configuration.X_WB.p),
      q(UnitCoefficients(configuration.X_WB.q)),
      joints(configuration.joints) {}

double QuaternionAngle(const Vector4d& a, const Vector4d& b) {
  const double chord = a.dot(b) < 0 ? (a + b).norm() : (a - b).norm();
  return 2 * std::asin(std::min(1.0, chord / 2));
}

double WeightedDistance(const PotentialPoint& a, const PotentialPoint& b,
                        const MetricWeights& metric) {
  return metric.translation * (a.p - b.p).norm() + metric.rotation * QuaternionAngle(a.q, b.q) +
         metric.joints * (a.joints - b.joints).norm();
}

PotentialEdge::PotentialEdge(const PotentialPoint& from, const PotentialPoint& to,
                             const MetricWeights& metric)
    : length(WeightedDistance(from, to, metric)),
      angle(QuaternionAngle(from.q, to.q)),
      p(from.p),
      dp(to.p - from.p),
      e1(from.q),
      joints(from.joints),
      dj(to.joints - from.joints),
      dp_squared(dp.squaredNorm()),
      dj_squared(dj.squaredNorm()) {
  const double dot = from.q.dot(to.q);
  Require(dot != 0, "two consecutive orientations of the guide are half a turn apart");
  // The part of the nearer of +-to across e1, by Gram-Schmidt on their difference, so that a small
  // angle keeps its digits.
  const Vector4d step = (dot < 0 ? Vector4d(-to.q) : to.q) - from.q;
  const Vector4d across = step - e1.dot(step) * e1;
  e2 = angle < kNoTurn ? Vector4d(Vector4d::Zero()) : across.normalized();
  if (angle < kNoTurn) angle = 0;
  if (dp_squared < kNoMotion * kNoMotion) dp_squared = 0;
  if (dj_squared < kNoMotion * kNoMotion) dj_squared = 0;
}

EdgeCost::EdgeCost(const PotentialEdge& edge, const PotentialPoint& q, const MetricWeights& metric,
                   double price, double reward)
    : rotation_weight_(metric.rotation), angle_(edge.angle), price_(price), reward_(reward) {
  position_ = {metric.translation, 0, edge.dp_squared, 0};
  const Eigen::Vector3d p = q.p - edge.p;
  if (edge.dp_squared > 0) position_.foot = p.dot(edge.dp) / edge.dp_squared;
  position_.off_squared = (p - position_.foot * edge.dp).squaredNorm();
  joints_ = {metric.joints, 0, edge.dj_squared, 0};
  if (edge.dj_squared > 0) joints_.foot = (q.joints - edge.joints).dot(edge.dj) / edge.dj_squared;
  joints_.off_squared = (q.joints - edge.joints - joints_.foot * edge.dj).squaredNorm();
  const double c1 = q.q.dot(edge.e1);
  const double c2 = q.q.dot(edge.e2);
  phase_ = std::atan2(c2, c1);
  in_plane_ = std::hypot(c1, c2);
  out_squared_ = (q.q - c1 * edge.e1 - c2 * edge.e2).squaredNorm();
}

void EdgeCost::AddLine(const Line& line, double t, Sample* sample) {
  const double along = t - line.foot;
  const double distance = std::sqrt(line.off_squared + line.speed_squared * along * along);
  sample->value += line.weight * distance;
  if (distance > 0) sample->slope += line.weight * line.speed_squared * along / distance;
}

void EdgeCost::AddAngle(double t, double branch, Sample* sample) const {
  const double x = angle_ * t - phase_;
  const double sine = in_plane_ * std::sin(x);
  const double cosine = branch * in_plane_ * std::cos(x);
  const double across = std::sqrt(out_squared_ + sine * sine);
  sample->value += rotation_weight_ * std::atan2(across, cosine);
  if (across > 0) {
    sample->slope += rotation_weight_ * angle_ * branch * sine / across;
  }
}

EdgeCost::Sample EdgeCost::At(double t, double branch) const {
  Sample sample;
  sample.t = t;
  AddLine(position_, t, &sample);
  AddLine(joints_, t, &sample);
  AddAngle(t, branch, &sample);
  sample.value = price_ * sample.value - reward_ * t;
  sample.slope = price_ * sample.slope - reward_;
  return sample;
}

// On an interval where the cost is convex: the tangents at its ends bound the minimum from below,
// so the search knows how far it still may be off. In turn the secant of the slopes (exact for a
// quadratic), the point where the tangents meet (exact for a kink) and, where these two did not
// halve the interval, its middle.
EdgeCost::Sample EdgeCost::ConvexMinimum(double begin, double end, double ceiling) const {
  const double branch = std::cos(angle_ * (0.5 * (begin + end)) - phase_) < 0 ? -1 : 1;
  Sample a = At(begin, branch);
  if (a.slope >= 0) return a;
  Sample b = At(end, branch);
  if (b.slope <= 0) return b;
  for (int step = 0; step < kMaxSteps; ++step) {
    const double width = b.t - a.t;
    const double rise = b.slope - a.slope;
    const double meet = (a.value - b.value + b.slope * width) / rise;  // from a.t
    const double bound = a.value + a.slope * meet;
    if (bound >= ceiling || std::min(a.value, b.value) - bound <= kGap) break;
    const double secant = -a.slope * width / rise;
    const double t = a.t + (step % 3 == 0 ? secant : step % 3 == 1 ? meet : 0.5 * width);
    if (!(t > a.t && t < b.t)) continue;
    const Sample sample = At(t, branch);
    if (sample.slope == 0) return sample;
    (sample.slope < 0 ? a : b) = sample;
  }
  return a.value < b.value ? a : b;
}

// Convexity. |p - p(t)| and |joints - joints(t)| are norms of affine functions. The angle is
// acos(r |cos x|), x = angle t - phase, r = in_plane_ <= 1: with |x| < pi/2 its second derivative
// in x is r cos x (1 - r^2) / (1 - r^2 cos^2 x)^(3/2) >= 0 (r = 1: |x|). It is periodic with pi,
// and where cos x = 0 its slope falls from r to -r: there, and nowhere else, convexity breaks. x
// covers at most pi/2 on an edge, so that this happens at most once.
EdgeCost::Sample EdgeCost::Minimum(double begin, double end, double ceiling) const {
  constexpr double kPi = 3.14159265358979323846;
  const double x0 = angle_ * begin - phase_;
  const double x1 = angle_ * end - phase_;
  const double kink = kPi * (std::floor(x0 / kPi - 0.5) + 1.5);  // the first in (x0, x0 + pi]
  if (!(kink > x0 && kink < x1)) return ConvexMinimum(begin, end, ceiling);
  const double t = std::clamp((kink + phase_) / angle_, begin, end);
  const Sample first = ConvexMinimum(begin, t, ceiling);
  const Sample second = ConvexMinimum(t, end, ceiling);
  return first.value < second.value ? first : second;
}

}  // namespace cguide::planner
