#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cguide/exact/com_region.h"

namespace cguide::exact {

/** Forces that balance the robot displaced by balance.displacement while the moment `twist` w acts
 too, w = -m g: they supply (w, d x w + twist w). */
struct TwistedBalance {
  Rational twist;  ///< m
  DisplacedBalance balance;
};

/** y with y.a <= 0 for every admissible wrench a once contact `contact` is moved by `shift`, which
 is along one axis of W. */
struct MovedSeparator {
  int contact = -1;
  Vector3q shift;  ///< m
  Vector6q y;
};

struct MarginGradientEvidence {
  ComRegionEvidence region;  ///< in the plane normal to gravity
  Vector6q pole;             ///< z.a > 0 for every admissible a != 0
  std::vector<TwistedBalance> twisted;
  std::vector<MovedSeparator> moved;
};

using EnclosedVector = std::array<Enclosure, 3>;  ///< component by component, in W

/** How com_m changes per metre as the centre of mass or a contact's point is moved. */
struct MarginGradientBox {
  Enclosure com_m;
  EnclosedVector com;
  std::vector<EnclosedVector> contact;  ///< one a contact
};

/** Encloses the generalised gradient of com_m (MarginBounds) in the centre of mass and in the
 points where contact forces act; normals and friction are kept. Every limit of difference quotients
 of com_m along a line of displacements, taken at points that tend to the query's, is the product of
 that direction with a member of the boxes; where com_m is differentiable they hold its gradient. At
 a kink the boxes hold all sides, so they are wide.

 Let v(d) = (w, d x w), S the region of balanced d, and O the set of all (h, y, f) with y.a <= 0 on
 the wrench cone, h = w x y_m, |h| = 1, admissible f with wrench sum v(m h), y.v(m h) = 0: all lines
 that bind, with all forces where the disc touches them. The members are h -> -h for the CoM and
 f_k x y_m for contact k. Why: com_m is the least, over directions, of the largest r with v(r h) in
 the cone (where 0 is outside S: minus the least |d|). The envelope theorem for convex programs
 whose data depend on a parameter [Bonnans, Shapiro 2000, Thm 4.24] gives the derivative of each by
 its multipliers and solutions; these are bounded, as the cone is pointed and S has an interior, and
 vary upper semicontinuously, so that the mean value theorem carries the bound over to com_m. There
 d = m h is the point that is touched, where S, which holds the disc, has one supporting line.

 How O is enclosed, with lo <= m <= hi of one sign:
 h: d.h <= m for corners d in S. Where 0 is inside, h points to where the corners' polygon is within
 hi of 0; where not, p.h <= hi for its nearest point p. Then corners d with d.h <= hi, and outer
 bounds m h.h_j <= b_j, narrow the angle from either side.
 y: h determines y_m but for k = y_m.w, and a twisted balance shows twist k <= m - h.d.
 f: room s_k of the pole on contact k, z.a >= s_k n.u, gives n.f_k <= z.v(m h)/s_k; so does the
 wrench of the line that binds, which most contacts have room to. f_k x y_m: if y' is polar with
 contact k moved by e, y'_m.(e x f_k) <= -y'.v(m h), and y_m.(e x f_k) is at most |e| |y_m - y'_m|
 |f_k| more; that is asked at both ends of k.
 @throws Error where CheckComRegion does, and where the query states errors: the gradient is that of
 the contacts as given.
 @return nothing where a piece of the evidence does not check or com_m may be 0 or infinite. */
std::optional<MarginGradientBox> CheckMarginGradient(const EquilibriumQuery& query,
                                                     const MarginGradientEvidence& evidence);

}  // namespace cguide::exact
