// Flat stances: contacts p_i on one plane with normal w, all with the coefficient mu > 0 and the
// same cone K about w, not on one line. The weight f = -m g acts along the line c + t g, which
// meets the plane in q. Wrenches about q: admissible f_i at p_i balance iff sum f_i = f and the
// moments vanish. Their components along the plane say that q is the mean of the p_i with weights
// f_i.w, so q is in their hull and f in K; conversely f_i = lambda_i f with q = sum lambda_i p_i
// balances. So: interior where q is inside the hull and f inside K (all lambda_i > 0 are possible
// and the span is R^6), boundary where one of the two is on its boundary and the other not outside
// (a supporting line of the hull, or of the strictly convex K, gives a supporting wrench), else
// outside.
#include "tests/cases/flat_stances.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "cguide/exact/linear_algebra.h"

namespace cguide::testing {
namespace {

using Eigen::Vector3d;
using fuzz::AnyNumber;
using fuzz::AnyPoint;
using fuzz::Below;
using fuzz::GridPoint;
using fuzz::TieRng;
using fuzz::TinyStep;
using numeric::Contact;

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

}  // namespace

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

namespace {

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

}  // namespace

Verdict TruthAbout(const FlatStance& stance, const FlatTie& tie) {
  const Place place = Truth(stance, tie.com, tie.gravity);
  return place == Place::kInside    ? Verdict::kHolds
         : place == Place::kOutside ? Verdict::kFails
                                    : Verdict::kUndecided;
}

namespace {

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

}  // namespace

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

numeric::StabilityQuery QueryOf(const FlatStance& stance, const FlatTie& tie) {
  numeric::StabilityQuery query;
  query.contacts = stance.contacts;
  query.com_W = tie.com;
  query.gravity_W = tie.gravity;
  query.mass = 50;
  return query;
}

}  // namespace cguide::testing
