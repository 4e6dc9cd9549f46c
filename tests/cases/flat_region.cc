#include "tests/cases/flat_region.h"

#include <algorithm>
#include <cmath>

#include "cguide/exact/linear_algebra.h"

namespace cguide::testing {
namespace {

using exact::Cross;
using exact::Dot;
using exact::Scaled;
using exact::SquaredNorm;

/** A side from corner `from` to corner `to`, seen from the displacement 0. */
struct Side {
  std::size_t from, to;
  Rational t;        ///< of the point nearest to 0, in [0, 1]
  Vector3q nearest;  ///< that point
  Rational room;     ///< > 0: 0 is strictly on the inner side of its line
  Vector3q inward;   ///< normal to the line and to up
};

Side SideOf(const FlatRegion& region, std::size_t i) {
  Side side;
  side.from = i;
  side.to = (i + 1) % region.corners.size();
  const Vector3q &a = region.corners[side.from], &b = region.corners[side.to];
  const Vector3q edge = b - a;
  side.t = exact::IsZero(edge) ? Rational(0) : Rational(-Dot(a, edge) / SquaredNorm(edge));
  side.t = std::clamp(side.t, Rational(0), Rational(1));
  side.nearest = a + Scaled(side.t, edge);
  side.inward = Cross(region.up, edge);
  side.room = -Dot(side.inward, a);
  return side;
}

std::vector<Side> SidesOf(const FlatRegion& region) {
  std::vector<Side> sides;
  for (std::size_t i = 0; i < region.corners.size(); ++i) sides.push_back(SideOf(region, i));
  return sides;
}

bool HoldsZero(const std::vector<Side>& sides) {
  const bool flat = sides.size() < 3;
  return std::all_of(sides.begin(), sides.end(), [&](const Side& side) {
    return flat ? exact::IsZero(side.nearest) : side.room >= 0;
  });
}

/** The distance of 0 from a side whose line has it on the inner side; squared. */
Rational SquaredRoom(const Side& side) {
  const Rational norm = SquaredNorm(side.inward);
  return norm == 0 ? Rational(0) : Rational(side.room * side.room / norm);
}

struct Binding {
  bool is_inside = false;
  Rational squared;         ///< com_m is +- its root
  std::vector<Side> sides;  ///< that attain it
};

Binding BindingSides(const FlatRegion& region) {
  const std::vector<Side> sides = SidesOf(region);
  Binding binding;
  binding.is_inside = HoldsZero(sides);
  for (const Side& side : sides) {
    const Rational squared = binding.is_inside ? SquaredRoom(side) : SquaredNorm(side.nearest);
    if (!binding.sides.empty() && squared > binding.squared) continue;
    if (binding.sides.empty() || squared < binding.squared) binding.sides.clear();
    binding.squared = squared;
    binding.sides.push_back(side);
  }
  return binding;
}

bool Encloses(const exact::Enclosure& box, const RootMultiple& root) {
  return SignOfDifference(box.lo, root) <= 0 && SignOfDifference(box.hi, root) >= 0;
}

bool HoldsVector(const exact::EnclosedVector& box, const Rational& scale, const Vector3q& n) {
  const Rational norm = SquaredNorm(n);
  for (std::size_t k = 0; k < 3; ++k) {
    const RootMultiple component{scale * n[static_cast<Eigen::Index>(k)], 1 / norm};
    if (!Encloses(box[k], component)) return false;
  }
  return true;
}

}  // namespace

int SignOfDifference(double x, const RootMultiple& root) {
  if (std::isinf(x)) return x > 0 ? 1 : -1;
  const Rational lifted = Lift(x);
  const int left = sgn(lifted), right = sgn(root.b) == 0 ? 0 : sgn(root.a);
  if (left != right) return left > right ? 1 : -1;
  const Rational difference = lifted * lifted - root.a * root.a * root.b;
  return left * sgn(difference);
}

std::optional<FlatRegion> RegionOf(const FlatStance& stance, const FlatTie& tie) {
  const Vector3q w = Lift(stance.w), g = Lift(tie.gravity), c = Lift(tie.com);
  const Rational mu = Lift(stance.mu), down = Dot(g, w);
  const Rational room = down * down * (1 + mu * mu) - SquaredNorm(g) * SquaredNorm(w);
  if (down >= 0 || room < 0) return std::nullopt;
  FlatRegion region;
  region.up = -g;
  for (const Eigen::Vector3d& corner : stance.corners) {
    const Vector3q d = Lift(corner) - c;
    region.corners.push_back(d - Scaled(Dot(d, g) / SquaredNorm(g), g));
  }
  return region;
}

std::string JudgeComMargin(const std::optional<FlatRegion>& region, const exact::Enclosure& com_m) {
  if (!region) return com_m.lo == -HUGE_VAL ? "" : "a margin without a region";
  const Binding binding = BindingSides(*region);
  const RootMultiple truth{binding.is_inside ? 1 : -1, binding.squared};
  return Encloses(com_m, truth) ? "" : "com_m is not in its enclosure";
}

std::string JudgeRegion(const std::optional<FlatRegion>& region, const exact::ComRegion& claim,
                        double gap) {
  if (claim.whole_plane) return "a bounded region is said to be the plane";
  if (!region) return claim.inner.empty() ? "" : "a corner of a region that is not";
  for (const Vector3q& corner : claim.inner) {
    FlatRegion seen = *region;
    for (Vector3q& c : seen.corners) c -= corner;
    if (!HoldsZero(SidesOf(seen))) return "an inner corner is outside";
  }
  for (const exact::DisplacementBound& bound : claim.outer) {
    for (const Vector3q& corner : region->corners) {
      if (Dot(bound.h, corner) > bound.b) return "an outer line cuts the region";
    }
  }
  if (claim.inner.size() < 3) return "";
  for (const Vector3q& corner : region->corners) {
    FlatRegion seen{region->up, claim.inner};
    for (Vector3q& c : seen.corners) c -= corner;
    const Binding binding = BindingSides(seen);
    if (!binding.is_inside && SignOfDifference(gap, {1, binding.squared}) < 0) {
      return "a corner is farther from the inner polygon than the gap";
    }
  }
  return "";
}

std::string JudgeGradient(const FlatRegion& region, const exact::EnclosedVector& com,
                          const std::vector<exact::EnclosedVector>& contact) {
  const Binding binding = BindingSides(region);
  for (const Side& side : binding.sides) {
    const Vector3q n = binding.is_inside ? side.inward : side.nearest;
    if (exact::IsZero(n)) return "a gradient where com_m is 0";
    if (!HoldsVector(com, 1, n)) return "the gradient in the centre of mass is not in its box";
    if (!HoldsVector(contact[side.from], -(1 - side.t), n) ||
        !HoldsVector(contact[side.to], -side.t, n)) {
      return "a contact's gradient is not in its box";
    }
  }
  return "";
}

}  // namespace cguide::testing
