#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "cguide/exact/core/path.h"

namespace cguide::planner {

/** d = translation |p - p'| + rotation acos|q.q'| + joints |joints - joints'|, each weight >= 0. */
struct MetricWeights {
  double translation = 1;
  double rotation = 1;
  double joints = 0.3;
};

struct PotentialOptions {
  /** w: the price of a unit of distance off the guide; a unit along it costs 1. >= 1. */
  double weight = 4;
  /** h: with a hint s_prev only arc lengths in [s_prev - h, s_prev + h] are looked at. */
  double window = std::numeric_limits<double>::infinity();
  MetricWeights metric;  ///< as in Distance; joints = 0 makes a potential of the root's pose alone
};

/** A point of a guide as seen from a configuration q. */
struct GuidePoint {
  double s = 0;         ///< arc length from the start of the guide
  int edge = 0;         ///< it lies on the edge from waypoint `edge`
  double fraction = 0;  ///< at this parameter, in [0, 1]
  double distance = 0;  ///< d(q, gamma(s))
  double value = 0;     ///< (L - s) + w d(q, gamma(s))
};

/** A guide as potential field for a planner of contacts [Bouyarmane 2009, IV; Escande 2006]: the
 least cost of reaching the goal where motion along the guide costs 1 and motion off it w >= 1,

   V(q) = min over s in [0, L] of (L - s) + w d(q, gamma(s)),

 gamma the guide by arc length in the metric d, L its length. d is Distance of path.h (or the one of
 PotentialOptions::metric); along an edge each of its three parts has constant speed, so arc length
 is proportional to the edge parameter. The minimum is of the *sum*: taken at the nearest point
 instead, V would jump where two parts of the guide are equally near and have no Lipschitz constant.

 Laws, for every guide, all tested:
 1. V >= 0, V(goal) = 0, and V(gamma(t)) <= L - t.
 2. |V(q) - V(q')| <= w d(q, q'): a minimum of functions of q, each w-Lipschitz by the triangle
    inequality. A hint keeps this for fixed s_prev: then V is the minimum over the window alone.
    Between calls with different hints it is no law: V is never below the one without, and it jumps
    where the window leaves the global minimum out.
 3. No strict local minimum but V = 0: on an edge from q to gamma(s*), s* the argument of the
    minimum, d is additive, so V falls by at least w a unit; and from gamma(s*) on along the guide
    V <= L - s falls on.
 4. V(gamma(t)) = L - t for all t, and so V strictly decreases along the guide, iff w is at least
    the guide's distortion, the largest (s - t) / d(gamma(t), gamma(s)); by definition of V. A guide
    that passes a place twice has no finite one, and no function of q alone can decrease along it;
    with a hint only |s - t| <= h counts. A turn by the angle a in one part of the metric, the other
    parts at rest, has distortion 1 / cos(a / 2).

 Immutable: calls may come from several threads. Values are within 1e-9 of the formulas (1e-10 from
 the search, the rest rounding, for guides of length below 1e4). A few microseconds a call. */
class GuidePotential {
 public:
  /** @param guide at least one waypoint, edges as CheckPath allows; one waypoint, the goal alone,
   gives V = w d(q, goal).
   @throws Error where the guide is empty, waypoints differ in size, consecutive orientations are
   orthogonal, or weight < 1, window <= 0 or a metric weight is negative. */
  explicit GuidePotential(const std::vector<Configuration>& guide, PotentialOptions options = {});

  /** L, in the metric. */
  double length() const;

  /** C with |V(q) - V(q')| <= C Distance(q, q'), but for the rounding of Distance, whose acos may
   be 3e-8 off near 0. */
  double LipschitzConstant() const;

  /** The point whose cost is least: where to go, gamma(s*). */
  GuidePoint Attractor(const Configuration& q, std::optional<double> s_prev = {}) const;

  /** The point of least distance; its `value` is an upper bound on V(q). */
  GuidePoint Nearest(const Configuration& q, std::optional<double> s_prev = {}) const;

  double Value(const Configuration& q, std::optional<double> s_prev = {}) const {
    return Attractor(q, s_prev).value;
  }

  /** s*: arc length behind the attractor; the hint for the next call near q. */
  double Progress(const Configuration& q, std::optional<double> s_prev = {}) const {
    return Attractor(q, s_prev).s;
  }

  /** gamma(s), s clamped into [0, L]. */
  Configuration At(double s) const;
  Configuration At(const GuidePoint& point) const;

  /** The joints of gamma(s*): a posture to start inverse kinematics from. */
  Eigen::VectorXd PreferredPosture(const Configuration& q,
                                   std::optional<double> s_prev = {}) const {
    return At(Attractor(q, s_prev)).joints;
  }

  /** How far V is below the remaining length on the guide, at worst: the largest (L - t) -
   V(gamma(t)) over samples t at most `step` apart, ends included. Zero up to rounding says that at
   no sample leaving the guide pays; between samples it is larger by (1 + w) step / 2 at most, since
   both terms are Lipschitz. What is near L says that V hardly sees the guide: the weight is too
   small. About L / step calls. */
  double LargestShortcut(double step) const;

  /** dV/dt = gradient . v for the velocities [v_WB; omega_WB; joint rates] of Integrate. By the
   envelope theorem it is w times the gradient of d(., gamma(s*)) at q, wherever s* is the only
   minimum and no part of d is singular there. Singular: root positions, orientations or joints of q
   and gamma(s*) equal (on the guide, all three), or orientations half a turn apart. That part of
   the answer is then zero: where they are equal, a subgradient of it. Where several s are minima
   the answer belongs to one of them, and -gradient still descends. */
  Eigen::VectorXd Gradient(const Configuration& q, std::optional<double> s_prev = {}) const;

 private:
  struct Curve;
  std::shared_ptr<const Curve> curve_;  // shared by copies: it never changes
};

}  // namespace cguide::planner
