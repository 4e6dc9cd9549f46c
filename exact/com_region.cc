#include "cguide/exact/com_region.h"

#include <algorithm>
#include <limits>

#include "cguide/exact/balance_checker_internal.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/** Geometry in the plane normal to up. */
Rational Turn(const ComRegion& region, const Vector3q& a, const Vector3q& b) {
  return Dot(region.up, Cross(a, b));
}

Rational SquaredDistanceFromSegment(const Vector3q& p, const Vector3q& a, const Vector3q& b) {
  const Vector3q edge = b - a, to = p - a;
  const Rational along = Dot(to, edge), squared = SquaredNorm(edge);
  if (along <= 0 || squared == 0) return SquaredNorm(to);
  if (along >= squared) return SquaredNorm(p - b);
  return SquaredNorm(to) - along * along / squared;
}

/** Whether the corners go round the point, each step by less than half a turn. */
bool GoesRound(const ComRegion& region, const Vector3q& point) {
  const std::size_t n = region.inner.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3q a = region.inner[i] - point, b = region.inner[(i + 1) % n] - point;
    if (Turn(region, a, b) <= 0) return false;
  }
  return n >= 3;
}

double LowerMargin(const ComRegion& region) {
  const std::vector<Vector3q>& corners = region.inner;
  if (corners.empty()) return -kInfinity;
  const bool inside = GoesRound(region, Vector3q::Zero());
  std::optional<Rational> least;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3q &a = corners[i], &b = corners[(i + 1) % corners.size()];
    // The distance from the line, or from the segment.
    const Rational squared = inside ? Rational(SquaredNorm(Cross(a, b)) / SquaredNorm(b - a))
                                    : SquaredDistanceFromSegment(Vector3q::Zero(), a, b);
    if (!least || squared < *least) least = squared;
  }
  return inside ? RoundDown(SqrtDown(*least)) : RoundDown(-SqrtUp(*least));
}

double UpperMargin(const ComRegion& region) {
  double hi = kInfinity;
  for (const DisplacementBound& bound : region.outer) {
    const Rational squared = SquaredNorm(bound.h);
    if (squared == 0) {
      if (bound.b < 0) return -kInfinity;
      continue;
    }
    const Rational ratio = bound.b * bound.b / squared;
    hi = std::min(hi, bound.b < 0 ? RoundUp(-SqrtDown(ratio)) : RoundUp(SqrtUp(ratio)));
  }
  return hi;
}

/** The part of a convex polygon with h.d <= b. */
std::vector<Vector3q> Clipped(const std::vector<Vector3q>& polygon,
                              const DisplacementBound& bound) {
  std::vector<Vector3q> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3q &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const Rational before = Dot(bound.h, a) - bound.b, after = Dot(bound.h, b) - bound.b;
    if (before <= 0) result.push_back(a);
    if ((before < 0 && after > 0) || (before > 0 && after < 0)) {
      result.push_back(a + Scaled(before / (before - after), b - a));
    }
  }
  return result;
}

/** Whether doubles say that the bound cuts nothing off. A wrong answer leaves the part too large,
 which is on the safe side. */
bool SeemsToHold(const std::vector<Vector3q>& polygon, const DisplacementBound& bound) {
  return std::all_of(polygon.begin(), polygon.end(), [&](const Vector3q& p) {
    double sum = -NearestDouble(bound.b);
    for (int k = 0; k < 3; ++k) sum += NearestDouble(bound.h[k]) * NearestDouble(p[k]);
    return sum < 0;
  });
}

/** How far S reaches, squared, beyond side i in the wedge of the centre; nothing where not bounded.
 S beyond the polygon lies in these wedges, as every segment from the centre to a point of S leaves
 the polygon through a side; and the distance from a side is convex, hence largest at corners. */
std::optional<Rational> SquaredGapBeside(const ComRegion& region, std::size_t i,
                                         const Vector3q& centre) {
  const Rational kFar = 4096;
  const std::size_t n = region.inner.size(), m = region.outer.size();
  const Vector3q &a = region.inner[i], &b = region.inner[(i + 1) % n];
  const Vector3q far_a = centre + Scaled(kFar, a - centre);
  const Vector3q far_b = centre + Scaled(kFar, b - centre);
  std::vector<Vector3q> beyond{a, far_a, far_b, b};
  for (std::size_t j = 0; j < m; ++j) {  // those of the same place in the order are likely to cut
    const DisplacementBound& bound = region.outer[(i * m / n + j) % m];
    if (!SeemsToHold(beyond, bound)) beyond = Clipped(beyond, bound);
  }
  Rational gap = 0;
  for (const Vector3q& p : beyond) {
    // A corner on the far side shows that the bounds do not close the wedge before it.
    if (Turn(region, far_b - far_a, p - far_a) <= 0) return std::nullopt;
    gap = std::max(gap, SquaredDistanceFromSegment(p, a, b));
  }
  return gap;
}

}  // namespace

std::optional<ComRegion> CheckComRegion(const EquilibriumQuery& query, const Vector3q& up,
                                        const ComRegionEvidence& evidence) {
  Require(query.mass > 0, "the mass must be positive");
  Require(!IsZero(query.gravity), "gravity must not vanish");
  Require(!IsZero(up), "a plane needs a normal");
  for (const ExactContact& contact : query.contacts) {
    Require(!IsZero(contact.cone.w), "a contact normal must not vanish");
    Require(contact.cone.mu >= 0, "a friction coefficient must not be negative");
    Require(contact.error_p >= 0 && query.com_error >= 0, "an error bound must not be negative");
  }
  const internal::BalanceChecker checker(query, evidence.basis);
  const Vector3q w = Scaled(-query.mass, query.gravity);
  ComRegion region;
  region.up = up;
  for (const DisplacedBalance& corner : evidence.corners) {
    if (Dot(corner.displacement, up) != 0) return std::nullopt;
    if (!checker.Holds(corner, internal::DemandAt(query, corner.displacement))) return std::nullopt;
    region.inner.push_back(corner.displacement);
  }
  if (!ArePolar(query, evidence.separators)) return std::nullopt;
  for (const Vector6q& y : evidence.separators) {
    const Vector3q y_f = y.head(3), y_m = y.tail(3), h = Cross(w, y_m);
    region.outer.push_back({h - Scaled(Dot(h, up) / SquaredNorm(up), up), Rational(-Dot(y_f, w))});
  }
  if (evidence.closure) {
    if (evidence.closure->base_weight.empty()) return std::nullopt;
    if (!checker.Holds(*evidence.closure, Vector6q::Zero())) return std::nullopt;
    region.whole_plane = true;
  }
  return region;
}

Enclosure MarginBounds(const ComRegion& region) {
  if (region.whole_plane) return {kInfinity, kInfinity};
  return {LowerMargin(region), UpperMargin(region)};
}

double RegionGap(const ComRegion& region) {
  if (region.whole_plane || region.inner.empty()) return kInfinity;
  Vector3q centre = Vector3q::Zero();
  for (const Vector3q& corner : region.inner) centre += corner;
  centre = Scaled(Rational(1, static_cast<long>(region.inner.size())), centre);
  if (!GoesRound(region, centre)) return kInfinity;
  Rational gap = 0;
  for (std::size_t i = 0; i < region.inner.size(); ++i) {
    const auto beside = SquaredGapBeside(region, i, centre);
    if (!beside) return kInfinity;
    gap = std::max(gap, *beside);
  }
  return RoundUp(SqrtUp(gap));
}

}  // namespace cguide::exact
