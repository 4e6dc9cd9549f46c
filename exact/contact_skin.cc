#include <algorithm>

#include "cguide/exact/contact_internal.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact::internal {
namespace {

Rational Depth(const Candidate& c, int bits, bool upper) {
  const Root root = RootOf(c.squared, bits);
  if (c.sign > 0) return c.inset - (upper ? root.lo : root.hi);
  return c.inset + (upper ? root.hi : root.lo);
}

/** The plane n.z = b as a way out of the set, n outward. */
Candidate PlaneExit(const Candidate& from, const PlacedSite& site, const Vector3q& n,
                    const Rational& b) {
  Candidate c = from;
  const Rational height = Dot(n, site.x) - b, nn = SquaredNorm(n);
  c.sign = height < 0 ? -1 : 1;
  c.squared = height * height / nn;
  c.inset = 0;
  c.w = n;
  c.y = site.x - Scaled(height / nn, n);
  c.error_w = 0;
  c.error_y = c.error_d = site.error;
  c.flat = true;
  return c;
}

bool SamePlane(const Candidate& a, const Candidate& b) {
  return a.y == b.y && IsZero(Cross(a.w, b.w)) && Dot(a.w, b.w) > 0;
}

/** The ways out of a box, cylinder or hull that x touches or is in. */
std::vector<Candidate> Exits(const Candidate& c, const PlacedSite& site, int bits) {
  const ConvexSet& set = *c.set;
  std::vector<Candidate> exits;
  const auto add = [&](const Vector3q& n, const Rational& b) {
    const Candidate exit = PlaneExit(c, site, n, b);
    const bool known = std::any_of(exits.begin(), exits.end(),
                                   [&](const Candidate& other) { return SamePlane(other, exit); });
    if (!known) exits.push_back(exit);
  };
  if (set.kind == SetKind::kPoints) {
    for (const auto& f : set.faces) {
      const Vector3q& a = set.points[f[0]];
      const Vector3q n = Cross(set.points[f[1]] - a, set.points[f[2]] - a);
      if (!IsZero(n)) add(n, Dot(n, a));
    }
    return exits;
  }
  for (int k = set.kind == SetKind::kBox ? 0 : 2; k < 3; ++k) {
    for (const int side : {-1, 1}) {
      const Vector3q n = Scaled(Rational(side), set.X.R.col(k));
      add(n, Dot(n, set.X.p) + set.half[k]);
    }
  }
  if (set.kind == SetKind::kBox) return exits;
  // The mantle: d = |radial part| - R.
  const Vector3q l = Transformed(set.X.R.transpose(), site.x - set.X.p);
  Candidate mantle = c;
  mantle.w = Transformed(set.X.R, Vector3q{l[0], l[1], Rational(0)});
  mantle.sign = 1;
  mantle.squared = SquaredNorm(mantle.w);
  mantle.inset = set.half[0];
  mantle.flat = true;
  mantle.error_w = mantle.error_d = site.error;
  if (mantle.squared == 0) return exits;  // on the axis: every way is as good
  const Root root = RootOf(mantle.squared, bits);
  mantle.y = site.x + Scaled((set.half[0] - root.hi) / root.hi, mantle.w);
  mantle.error_y = site.error + set.half[0] * (DirectionError(mantle.w, site.error) +
                                               (root.hi - root.lo) / root.hi);
  exits.push_back(mantle);
  return exits;
}

struct SkinQuestion {
  const ContactSets& sets;
  const PlacedSite& site;
  const RobotPlacement& placement;
  const SeamRules& rules;
  const std::vector<Candidate>& all;

  /** Whether nothing rises above an exit. */
  Verdict Uncovered(const Candidate& exit) const {
    Verdict verdict = Verdict::kHolds;
    for (const Candidate& other : all) {
      if (other.set == exit.set) continue;
      const Verdict one = StaysFlat(*other.set, exit, rules);
      if (one == Verdict::kFails) return one;
      if (one == Verdict::kUndecided) verdict = one;
    }
    return verdict;
  }

  /** Exits nearest first; those that are covered, or too deep to be in the band, left out. */
  void Leave(const Candidate& c, const Rational& skin, std::vector<Candidate>* result) const {
    std::vector<Candidate> open;
    for (Candidate& exit : Exits(c, site, rules.bits)) {
      if (exit.SurelyNotAbove(site.radius - skin)) continue;
      const Verdict uncovered = Uncovered(exit);
      if (uncovered == Verdict::kFails) continue;
      exit.doubtful = uncovered == Verdict::kUndecided;
      open.push_back(exit);
    }
    std::stable_sort(open.begin(), open.end(), [&](const Candidate& a, const Candidate& b) {
      return Depth(a, rules.bits, false) < Depth(b, rules.bits, false);
    });
    if (open.empty()) return;
    const Rational nearest = Depth(open[0], rules.bits, true) + 2 * site.error;
    const bool alone = open.size() == 1 || nearest < Depth(open[1], rules.bits, false);
    if (alone && !open[0].doubtful) {
      result->push_back(open[0]);
      return;
    }
    for (Candidate& exit : open) {
      exit.doubtful = true;
      // Outside near an edge the normal may be any between those of the faces.
      if (!exit.SurelyBelow(0) && open.size() > 1) exit.error_w = 2 * SqrtUp(SquaredNorm(exit.w));
      result->push_back(exit);
    }
  }

  /** The side of a triangle's plane that holds the body's shapes down to the skin: 1, -1, or 0. */
  int BodySide(const Vector3q& a, const Vector3q& n, const Rational& skin) const {
    const Rational nn = SquaredNorm(n);
    bool above = true, below = true, any = false;
    for (int link : sets.model.robot.bodies[site.body].links) {
      for (const ConvexBracket& shape : sets.links[link]) {
        const ConvexBracket placed = Moved(shape, placement.links[link]);
        const Rational reach = placed.radius + placed.error - skin;
        for (const Vector3q& p : placed.outer().points) {
          const Rational height = Dot(n, p - a);
          above = above && CompareWithRoot(height, reach, nn) == Sign::kPositive;
          below = below && CompareWithRoot(-height, reach, nn) == Sign::kPositive;
          any = true;
        }
      }
    }
    return !any || above == below ? 0 : above ? 1 : -1;
  }

  /** Whether the foot of x on the plane of the triangle is in the triangle: 1 for every true x, -1
   for none, else 0. */
  int FootInTriangle(const ConvexSet& set, const Vector3q& n) const {
    int result = 1;
    for (int k = 0; k < 3; ++k) {
      const Vector3q &from = set.points[k], &to = set.points[(k + 1) % 3];
      const Vector3q inward = Cross(n, to - from);
      const Rational room = Dot(inward, site.x - from), nn = SquaredNorm(inward);
      if (CompareWithRoot(room, -site.error, nn) == Sign::kNegative) return -1;
      if (CompareWithRoot(room, site.error, nn) == Sign::kNegative) result = 0;
    }
    return result;
  }

  void TakeSide(const Candidate& c, const Rational& skin, std::vector<Candidate>* result) const {
    const ConvexSet& set = *c.set;
    const Vector3q n = Cross(set.points[1] - set.points[0], set.points[2] - set.points[0]);
    const bool thin = IsZero(n);
    const int foot = thin ? 0 : FootInTriangle(set, n);
    if ((thin || foot < 0) && c.SurelyAbove(0)) {  // beside it, not behind it
      result->push_back(c);
      return;
    }
    const int side = thin ? 0 : BodySide(set.points[0], n, skin);
    Candidate exit = c;
    if (side != 0 && foot > 0) {
      const Vector3q out = Scaled(Rational(side), n);
      exit = PlaneExit(c, site, out, Dot(out, set.points[0]));
      exit.flat = !exit.SurelyAbove(0);
    } else {
      // On the rim of a sheet within errors, or of a body astride it: either side, any normal.
      exit.doubtful = true;
      exit.error_w = 2 * SqrtUp(SquaredNorm(exit.w));
    }
    result->push_back(exit);
    if (!exit.doubtful || exit.squared == 0) return;
    exit.sign = -1;
    exit.flat = true;
    result->push_back(exit);
  }
};

}  // namespace

void ApplySkin(const ContactSets& sets, const PlacedSite& site, const RobotPlacement& placement,
               const SeamRules& rules, std::vector<Candidate>* candidates) {
  const SkinQuestion ask{sets, site, placement, rules, *candidates};
  std::vector<Candidate> result;
  for (const Candidate& c : *candidates) {
    const Rational skin = sets.Skin(site.body, c.set->object);
    if (skin == 0) {
      result.push_back(c);
    } else if (c.set->kind == SetKind::kTriangle) {
      if (c.SurelyNotBelow(skin + site.error)) {
        result.push_back(c);
      } else {
        ask.TakeSide(c, skin, &result);
      }
    } else if (c.SurelyAbove(0)) {
      result.push_back(c);
    } else if (c.set->kind == SetKind::kHalfspace || c.set->radius != 0) {
      result.push_back(c);
      result.back().flat = true;
    } else {
      ask.Leave(c, skin, &result);
    }
  }
  *candidates = std::move(result);
}

}  // namespace cguide::exact::internal
