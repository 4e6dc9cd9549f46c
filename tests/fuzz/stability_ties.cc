// Near ties of static stability.
//
// Flat stances: contacts p_i on one plane with normal w, all with the coefficient mu > 0 and the
// same cone K about w, not on one line. The weight f = -m g acts along the line c + t g, which
// meets the plane in q. Wrenches about q: admissible f_i at p_i balance iff sum f_i = f and the
// moments vanish. Their components along the plane say that q is the mean of the p_i with weights
// f_i.w, so q is in their hull and f in K; conversely f_i = lambda_i f with q = sum lambda_i p_i
// balances. So: interior where q is inside the hull and f inside K (all lambda_i > 0 are possible
// and the span is R^6), boundary where one of the two is on its boundary and the other not outside
// (a supporting line of the hull, or of the strictly convex K, gives a supporting wrench), else
// outside.
//
// The numbers of such a stance are few bits wide, or ("fine") as wide as doubles are on a plane
// across an axis; the centre of mass and the pull are then within some units of rounding of a tie.
//
// Bracketed stances: contacts on floors, slopes and walls, and two centres of mass at most 2^-30 m
// apart of which one is proved stable and the other unstable.
#include <optional>

#include "cguide/exact/equilibrium.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/stability.h"
#include "tests/fuzz/near_ties.h"
#include "tests/fuzz/twins.h"
#include "tests/numeric/stability_cases.h"
#include "tests/numeric/stability_exact.h"

namespace cguide::fuzz {
namespace {

using Eigen::Vector3d;
using numeric::Contact;

/** Corners of a convex polygon, counter-clockwise about the integer normal w, and points of it. */
struct FlatStance {
  Vector3d w;
  double mu = 0;
  std::vector<Vector3d> corners;
  std::vector<Contact> contacts;
};

/** Integer normals of integer length with two integer vectors that span their planes. */
struct Plane {
  Vector3d w, s, t;
  double length;
};

Plane RandomPlane(TieRng& rng) {
  static const Plane kPlanes[] = {
      {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 1},   {{0, 0, 1}, {1, 1, 0}, {-1, 1, 0}, 1},
      {{0, 0, 1}, {2, 1, 0}, {-1, 2, 0}, 1},  {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1},
      {{3, 0, 4}, {0, 1, 0}, {-4, 0, 3}, 5},  {{0, -3, 4}, {1, 0, 0}, {0, 4, 3}, 5},
      {{1, 2, 2}, {2, 1, -2}, {-2, 2, -1}, 3}};
  return kPlanes[Below(rng, 6) < 4 ? Below(rng, 4) : 4 + Below(rng, 3)];
}

// The unit normal must be a double multiple of w. Along an axis it is w; otherwise w c with c = 1 /
// length rounded to 48 bits, which times a number of at most 4 bits is exact: |n| is within 2^-45
// of 1, and that is stated as the error of the normal.
Contact ContactAt(const Vector3d& p, const Plane& plane, double mu) {
  Contact contact;
  const double c = std::round(std::ldexp(1 / plane.length, 48)) * 0x1p-48;
  contact.x_W = p;
  contact.n_W = plane.w * c;
  contact.normal_error = plane.length == 1 ? 0 : 0x1p-45;
  contact.distance = 0.02;
  contact.y_W = p - 0.02 * contact.n_W;
  contact.friction = mu;
  return contact;
}

FlatStance RandomFlatStance(TieRng& rng) {
  const Plane plane = RandomPlane(rng);
  FlatStance stance;
  stance.w = plane.w;
  stance.mu = 0.25 * (1 + Below(rng, 5));
  const Vector3d p0 = GridPoint(rng, 16, 16);
  const Vector3d s = (1 + Below(rng, 4)) / 16.0 * plane.s, t = (1 + Below(rng, 4)) / 16.0 * plane.t;
  stance.corners = {p0, p0 + s, p0 + s + t};
  if (Below(rng, 4) != 0) stance.corners.push_back(p0 + t);
  for (const Vector3d& p : stance.corners) {
    stance.contacts.push_back(ContactAt(p, plane, stance.mu));
  }
  for (int extra = Below(rng, 4); extra > 0; --extra) {  // on edges and inside
    const Vector3d p = p0 + Below(rng, 5) / 4.0 * s;
    stance.contacts.push_back(ContactAt(p, plane, stance.mu));
  }
  return stance;
}

// Points of a plane across an axis: any two doubles and the same third.
FlatStance RandomFineStance(TieRng& rng) {
  const int axis = Below(rng, 3), a = (axis + 1) % 3, b = (axis + 2) % 3;
  FlatStance stance;
  stance.w = Vector3d::Unit(axis);
  stance.mu = 0.2 + std::abs(AnyNumber(rng));
  const Vector3d p0 = AnyPoint(rng);
  const double width = 0.1 + 0.2 * std::abs(AnyNumber(rng));
  const auto at = [&](double x, double y) {
    Vector3d p = p0;
    p[a] += width * x;
    p[b] += width * y;
    return p;
  };
  // Counter-clockwise and convex with room for the small displacements.
  const double e = 0.2 * AnyNumber(rng), f = 0.2 * AnyNumber(rng);
  stance.corners = {p0, at(1 + e, e), at(1 + f, 1 + e)};
  if (Below(rng, 4) != 0) stance.corners.push_back(at(f, 1 + f));
  const Plane plane{stance.w, Vector3d::Unit(a), Vector3d::Unit(b), 1};
  for (const Vector3d& p : stance.corners) {
    stance.contacts.push_back(ContactAt(p, plane, stance.mu));
  }
  return stance;
}

enum class Place { kInside, kOn, kOutside };

Place PlaceOf(int sign) {
  return sign > 0 ? Place::kInside : sign < 0 ? Place::kOutside : Place::kOn;
}

Place Worse(Place a, Place b) { return std::max(a, b); }

/** The truth about the stored numbers, by the argument at the top of this file. */
Place Truth(const FlatStance& stance, const Vector3d& com, const Vector3d& gravity) {
  const Vector3q w = Lift(stance.w), c = Lift(com), g = Lift(gravity);
  const Rational down = exact::Dot(g, w);
  if (down >= 0) return Place::kOutside;
  const Rational mu = Lift(stance.mu);
  const Rational room = down * down * (1 + mu * mu) - exact::SquaredNorm(g) * exact::SquaredNorm(w);
  Place place = PlaceOf(sgn(room));
  const Rational along = exact::Dot(Vector3q(Lift(stance.corners[0]) - c), w) / down;
  const Vector3q q = c + exact::Scaled(along, g);
  for (std::size_t i = 0; i < stance.corners.size(); ++i) {
    const Vector3q p = Lift(stance.corners[i]);
    const Vector3q edge = Lift(stance.corners[(i + 1) % stance.corners.size()]) - p;
    const Rational side = exact::Dot(w, exact::Cross(edge, q - p));
    place = Worse(place, PlaceOf(sgn(side)));
  }
  return place;
}

Verdict VerdictOf(Place place) {
  return place == Place::kInside    ? Verdict::kHolds
         : place == Place::kOutside ? Verdict::kFails
                                    : Verdict::kUndecided;
}

struct FlatTie {
  Vector3d com;
  Vector3d gravity;
};

// A pull within the friction cone or, one time in three, on its boundary: -w + mu t has the slope
// mu exactly where t is an axis (only for normals along axes).
Vector3d Pull(TieRng& rng, const FlatStance& stance, bool* on_cone) {
  Vector3d g = -stance.w;
  *on_cone = stance.w.cwiseAbs().sum() == 1 && Below(rng, 3) == 0;
  int axis = 0;
  stance.w.cwiseAbs().maxCoeff(&axis);
  if (*on_cone) {
    g[(axis + 1 + Below(rng, 2)) % 3] += Below(rng, 2) == 0 ? stance.mu : -stance.mu;
  } else {
    // Slopes below mu: an eighth of a grid vector of length <= sqrt(2) in units of the normal's.
    const double slope = stance.mu * stance.w.norm() / 8;
    const double bits = std::ldexp(1.0, std::ilogb(slope));
    g += bits * GridPoint(rng, 2, 2);
  }
  return 8 * g;
}

FlatTie MakeFlatTie(TieRng& rng, const FlatStance& stance) {
  bool on_cone = false;
  FlatTie tie;
  tie.gravity = Pull(rng, stance, &on_cone);
  const auto n = stance.corners.size();
  const std::size_t i = rng() % n;
  const Vector3d &p = stance.corners[i], &next = stance.corners[(i + 1) % n];
  // On an edge or a corner of the hull; inside it where friction is the question.
  const bool both = Below(rng, 4) == 0;
  Vector3d q = p + Below(rng, 5) / 4.0 * (next - p);
  if (on_cone && !both) q = (2 * p + next + stance.corners[(i + 2) % n]) / 4;
  tie.com = q - (1 + Below(rng, 8)) / 64.0 * tie.gravity;
  tie.com += TinyStep(rng) * Vector3d(GridPoint(rng, 2, 4));
  if (on_cone) tie.gravity += TinyStep(rng) * Vector3d(GridPoint(rng, 2, 4));
  return tie;
}

FlatTie MakeFineTie(TieRng& rng, const FlatStance& stance) {
  const auto n = stance.corners.size();
  const std::size_t i = rng() % n;
  const Vector3d &p = stance.corners[i], &next = stance.corners[(i + 1) % n];
  const bool on_cone = Below(rng, 2) == 0;
  const Vector3d across = stance.w.cross(AnyPoint(rng)).normalized();
  const double slope = on_cone ? stance.mu : 0.9 * stance.mu * std::abs(AnyNumber(rng));
  const double far = std::ldexp(1.0, -53 + Below(rng, 8));  // some units of rounding or many
  FlatTie tie;
  tie.gravity = 9.81 * (slope * across - stance.w);
  if (on_cone) tie.gravity += 8 * far * AnyPoint(rng);
  const bool both = Below(rng, 4) == 0;
  Vector3d q = p + std::abs(AnyNumber(rng)) * (next - p);
  if (on_cone && !both) q = (2 * p + next + stance.corners[(i + 2) % n]) / 4;
  tie.com = q - 0.1 * std::abs(AnyNumber(rng)) * tie.gravity + far * AnyPoint(rng);
  return tie;
}

// Rounding may have undone a step, which leaves a tie; that the tie is near follows from the
// making.
std::string CheckFlat(const FlatStance& stance, const FlatTie& tie, long every,
                      numeric::StabilityWorkspace* workspace, Tally* tally) {
  numeric::StabilityQuery query;
  query.contacts = stance.contacts;
  query.com_W = tie.com;
  query.gravity_W = tie.gravity;
  query.mass = 50;
  const Verdict truth = VerdictOf(Truth(stance, tie.com, tie.gravity));
  ++tally->cases;
  tally->tied += truth == Verdict::kUndecided;
  const numeric::StabilityAnswer fast = TryStability(query, workspace);
  if (fast.verdict != Verdict::kUndecided) {
    ++tally->fast;
    if (fast.verdict != truth) return "a fast verdict is not the truth about a flat stance";
    if (!numeric::testing::IsProved(query, fast)) {
      return "a fast verdict is not proved by its witness";
    }
    return "";
  }
  // The exact stage takes milliseconds; a share of what doubles leave open is enough.
  if (tally->checked * every >= tally->cases) {
    ++tally->open;
    return "";
  }
  ++tally->checked;
  const numeric::SettledStability settled = Stability(query, workspace);
  const Verdict verdict = settled.answer.verdict;
  ++(settled.exact && verdict == truth ? tally->exact : tally->open);
  if (verdict != Verdict::kUndecided && verdict != truth) {
    return "a settled verdict is not the truth about a flat stance";
  }
  if (settled.exact && settled.exact->verdict != Verdict::kUndecided &&
      settled.exact->verdict != truth) {
    return "the exact twin's verdict is not the truth about a flat stance";
  }
  return "";
}

std::string CheckProved(const numeric::StabilityQuery& query,
                        const numeric::StabilityAnswer& answer, Tally* tally) {
  ++tally->cases;
  ++tally->fast;
  return numeric::testing::IsProved(query, answer) ? ""
                                                   : "a fast verdict is not proved by its witness";
}

// Bisects between a stable and an unstable centre of mass as far as doubles decide.
std::string CheckBracket(TieRng& rng, numeric::StabilityWorkspace* workspace, Tally* tally) {
  numeric::Rng draw(rng());
  numeric::testing::Stance stance = numeric::testing::RandomStance(1 + Below(rng, 4), draw);
  numeric::StabilityQuery query = stance.Query();
  query.com_W = stance.centroid + Vector3d(0, 0, 0.5);
  Vector3d stable = query.com_W;
  numeric::StabilityAnswer inner = TryStability(query, workspace);
  if (inner.verdict != Verdict::kHolds) return "";
  const Vector3d center = stable;
  for (int direction = 0; direction < 8; ++direction) {
    stable = center;
    Vector3d unstable = center + Vector3d(GridValue(rng, 8, 8), GridValue(rng, 8, 8), 0) * 8;
    query.com_W = unstable;
    numeric::StabilityAnswer outer = TryStability(query, workspace);
    if (outer.verdict != Verdict::kFails) continue;
    while ((unstable - stable).norm() > 0x1p-40) {
      query.com_W = (stable + unstable) / 2;
      const numeric::StabilityAnswer middle = TryStability(query, workspace);
      if (middle.verdict == Verdict::kUndecided) break;
      (middle.verdict == Verdict::kHolds ? stable : unstable) = query.com_W;
      (middle.verdict == Verdict::kHolds ? inner : outer) = middle;
    }
    if ((unstable - stable).norm() > kNearTie || stable == center) continue;
    query.com_W = stable;
    std::string wrong = CheckProved(query, inner, tally);
    query.com_W = unstable;
    if (wrong.empty()) wrong = CheckProved(query, outer, tally);
    if (!wrong.empty()) return wrong;
  }
  return "";
}

}  // namespace

std::string TiesOfStability(TieRng& rng, long every, Tally* tally) {
  numeric::StabilityWorkspace workspace;
  const int kind = Below(rng, 4);
  if (kind == 0) return CheckBracket(rng, &workspace, tally);
  if (kind == 1) return TiesOfStabilityCertificates(rng, tally);
  const bool fine = kind == 2;
  const FlatStance stance = fine ? RandomFineStance(rng) : RandomFlatStance(rng);
  for (int k = 0; k < 16; ++k) {
    const FlatTie tie = fine ? MakeFineTie(rng, stance) : MakeFlatTie(rng, stance);
    const std::string wrong = CheckFlat(stance, tie, every, &workspace, tally);
    if (!wrong.empty()) return wrong;
  }
  return "";
}

}  // namespace cguide::fuzz
