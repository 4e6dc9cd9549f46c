#pragma once

#include "cguide/numeric/geometry_internal.h"

namespace cguide::numeric {

/** A site placed in W. */
struct PlacedSite {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  Eigen::Vector3d body_centre = Eigen::Vector3d::Zero();  ///< tells the sides of a sheet apart
  double radius = 0;
  double error = 0;  ///< of x
  int body = -1;
};

/** The closest point of the closed set (convex piece or triangle) of a candidate to z; z where it
 is inside. */
Eigen::Vector3d ClosestPoint(const Geometry& g, const SiteCandidate& owner,
                             const Eigen::Vector3d& z);

/** Whether some point of T (the piece of `owner`) within `seam` of y is strictly nearer to x than
 y: kFails for certain (it is), kHolds for certain (none is), else kUndecided. `error` bounds the
 errors of x, y, and |x - y|.

 Lemma. Let z(t) be the closest point of the closed convex T to x + t (y - x), t in [0, 1].
 Expanding squares, |z - x - t(y - x)|^2 = (1-t) |z-x|^2 + t |z-y|^2 - t(1-t) |x-y|^2, so z(t)
 minimises (1-t)|z-x|^2 + t|z-y|^2 over T. Adding the two inequalities for t < t' shows that |z(t) -
 y| does not increase and |z(t) - x| does not decrease with t. Let d(y, T) <= seam, and let t* be
 the smallest t with |z(t) - y| <= seam. If t* = 0, z(0) is the point of T nearest to x and lies in
 the ball. If 0 < t* < 1, |z(t*) - y| = seam by continuity, and any z of T in the ball has (1-t*)
 |z-x|^2 >= (1-t*) |z(t*)-x|^2 + t* (seam^2 - |z-y|^2) >= (1-t*) |z(t*)-x|^2. If t* = 1 the bound |z
 - x| >= |z(t) - x| of all t < 1 carries over. So min {|z-x| : z in T, |z-y| <= seam} = |z(t*) - x|,
 and bisection encloses it: every t with |z(t)-y| > seam gives a lower bound, every other t an upper
 bound. If y is in T the minimum is below |x-y| iff d(x, T) is: the segment from y to z(0) is in T
 and |. - x| is strictly convex along it. */
Verdict StaysClosest(const Geometry& g, const SiteCandidate& owner, const Eigen::Vector3d& x,
                     const Eigen::Vector3d& y, double seam, double error);

/** Whether no solid has a point of its inside within `seam` of c's y that is nearer to x. `error`
 bounds the error of y.

 Let z* be the point of the ball of radius seam about y on the way to x (x itself if it is nearer).
 If a point of the solid in the ball is nearer to x than y is, then either some triangle has such a
 point, which StaysClosest sees, or the cap {|z - y| <= seam, |z - x| < |x - y|}, which is connected
 and holds z*, meets the solid without meeting its surface, so that z* is in the solid: its winding
 number is asked. */
Verdict StaysOutsideSolids(const Geometry& g, const std::vector<SiteCandidate>& candidates,
                           const SiteCandidate& c, double seam, double error);

/** Where a skin applies, makes distances and normals of candidates that touch or have sunk in the
 signed ones: leaving boxes and hulls through their nearest face that no neighbour covers, triangles
 towards the side the body is on. */
void ApplySkin(const Geometry& g, const PlacedSite& site, double seam,
               std::vector<SiteCandidate>* candidates);

/** The contacts of one site, appended. None where it is deep inside a solid. `near` are the pieces
 * within reach. */
void FindSiteContacts(const World& world, int site, const PlacedSite& placed,
                      const std::vector<int>& near, Workspace::Scratch* scratch,
                      std::vector<Contact>* contacts);

/** One contact per body, the closest pair with all obstacles [Bouyarmane 2009, Def. 1]. */
void FindNearestContacts(const World& world, Workspace* workspace, std::vector<Contact>* contacts);

}  // namespace cguide::numeric
