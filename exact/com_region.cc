#include "cguide/exact/com_region.h"

#include <algorithm>
#include <limits>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Rational Norm1(const Vector3q& a) { return abs(a[0]) + abs(a[1]) + abs(a[2]); }

/** Checks balances of one query; what they share is computed once. */
class BalanceChecker {
 public:
  BalanceChecker(const EquilibriumQuery& query, const WrenchBasis& basis);

  bool has_basis() const { return has_basis_; }
  /** Whether the balance supplies the wrench v. */
  bool Holds(const DisplacedBalance& balance, const Vector6q& v) const;

 private:
  bool IsUsable(const ContactForce& force) const;
  Vector6q WrenchOf(const ContactForce& force) const;
  Rational Error(const ContactForce& force) const { return error_[force.contact] * Norm1(force.f); }
  bool PrepareBasis();

  const EquilibriumQuery& query_;
  const WrenchBasis& basis_;
  std::vector<std::optional<FrictionCone>> cones_;  // narrowed; none where not to be used
  std::vector<Rational> error_;                     // of the arm
  bool is_exact_ = true;
  bool has_basis_ = false;
  std::vector<Vector6q> wrenches_;  // of the basis
  std::vector<Rational> rho_;       // of its rows
  Rational kappa_ = 0;
};

BalanceChecker::BalanceChecker(const EquilibriumQuery& query, const WrenchBasis& basis)
    : query_(query), basis_(basis) {
  for (const ExactContact& contact : query.contacts) {
    error_.push_back(contact.error_p + query.com_error);
    cones_.emplace_back();
    if (!contact.certain) continue;
    cones_.back() = contact.error_w == 0 ? contact.cone : Narrowed(contact.cone, contact.error_w);
    is_exact_ = is_exact_ && error_.back() == 0 && contact.error_w == 0;
  }
  is_exact_ = is_exact_ && query.com_error == 0;
  has_basis_ = PrepareBasis();
}

bool BalanceChecker::IsUsable(const ContactForce& force) const {
  return force.contact >= 0 && force.contact < static_cast<int>(cones_.size()) &&
         cones_[force.contact] && IsAdmissible(*cones_[force.contact], force.f);
}

Vector6q BalanceChecker::WrenchOf(const ContactForce& force) const {
  Vector6q wrench;
  wrench.head(3) = force.f;
  wrench.tail(3) = Cross(query_.contacts[force.contact].p - query_.com, force.f);
  return wrench;
}

bool BalanceChecker::PrepareBasis() {
  const MatrixXq& R = basis_.inverse;
  if (basis_.columns.size() != 6 || R.rows() != 6 || R.cols() != 6) return false;
  Rational error = 0;
  for (const ContactForce& column : basis_.columns) {
    if (!IsUsable(column)) return false;
    wrenches_.push_back(WrenchOf(column));
    error += Error(column);
  }
  for (int i = 0; i < 6; ++i) {
    rho_.push_back(abs(R(i, 3)) + abs(R(i, 4)) + abs(R(i, 5)));
    Rational row = rho_.back() * error;
    for (int k = 0; k < 6; ++k) {
      row += abs(Rational((i == k ? 1 : 0) - Dot(R.row(i), wrenches_[k])));
    }
    kappa_ = std::max(kappa_, row);
  }
  return kappa_ < 1;
}

bool BalanceChecker::Holds(const DisplacedBalance& balance, const Vector6q& v) const {
  Vector6q rest = v;
  Rational error = 0;
  for (const ContactForce& force : balance.forces) {
    if (!IsUsable(force)) return false;
    rest -= WrenchOf(force);
    error += Error(force);
  }
  if (balance.base_weight.empty()) return is_exact_ && IsZero(rest);
  if (!has_basis_ || balance.base_weight.size() != 6) return false;
  Rational least = balance.base_weight[0];
  for (int k = 0; k < 6; ++k) {
    const Rational& weight = balance.base_weight[k];
    if (weight <= 0) return false;
    least = std::min(least, weight);
    for (int i = 0; i < 6; ++i) rest[i] -= weight * wrenches_[k][i];
    error += weight * Error(basis_.columns[k]);
  }
  for (int i = 0; i < 6; ++i) {
    const Rational moved = abs(Dot(basis_.inverse.row(i), rest)) + rho_[i] * error;
    if (moved >= (1 - kappa_) * least) return false;
  }
  return true;
}

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
  const BalanceChecker checker(query, evidence.basis);
  const Vector3q w = Scaled(-query.mass, query.gravity);
  const auto demand = [&w](const Vector3q& displacement) {
    Vector6q v;
    v.head(3) = w;
    v.tail(3) = Cross(displacement, w);
    return v;
  };
  ComRegion region;
  region.up = up;
  for (const DisplacedBalance& corner : evidence.corners) {
    if (Dot(corner.displacement, up) != 0) return std::nullopt;
    if (!checker.Holds(corner, demand(corner.displacement))) return std::nullopt;
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
