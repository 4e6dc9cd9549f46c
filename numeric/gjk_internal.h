#pragma once

#include <Eigen/Core>
#include <span>

#include "cguide/numeric/convex_internal.h"

namespace cguide::numeric {

/** Points of two cores and their difference. */
struct DifferencePoint {
  Eigen::Vector3d w;  ///< (c_A + a) - (c_B + b)
  Eigen::Vector3d a;  ///< of core A, relative to c_A
  Eigen::Vector3d b;  ///< of core B, relative to c_B
  int i = -1;         ///< index of the point of A, where A is given by points
  int j = -1;
};

/** What the iteration of Gilbert, Johnson and Keerthi [1988] proposes for the cores of two sets.
 Nothing here is certified: `v` becomes evidence through Gap, the points as members of both sets. */
struct GjkResult {
  Eigen::Vector3d v = Eigen::Vector3d::UnitX();  ///< near-closest point of A - B to 0, from B to A
  Eigen::Vector3d a = Eigen::Vector3d::Zero();   ///< its points, relative to c_A and c_B
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  bool overlap = false;    ///< the last simplex holds the origin up to rounding
  bool separated = false;  ///< stopped early: the bound asked for was reached along `v`
  int size = 0;            ///< of the simplex
  DifferencePoint simplex[4];
  int iterations = 0;
};

/** Runs until the distance of the cores is known to rounding, the cores overlap, or (v.w)/|v|, the
 lower bound of the core distance, exceeds `enough`. `v0` is a first guess of the direction. */
void Gjk(const Convex& a, const Convex& b, const Eigen::Vector3d& v0, double enough,
         GjkResult* result);

/** The unit normal of a simplex of two or three corners towards A, free of the cancellation in v
 near contact: e_1 x e_2, or e x (w_0 x e), where edges are differences within the two sets. Zero
 where there is none. A proposal for a direction of separation. */
Eigen::Vector3d SimplexNormal(const GjkResult& gjk);

/** Points, with their lanes where they are worth having; a view. */
struct PointSet {
  std::span<const Eigen::Vector3d> points;
  const PointLanes* lanes = nullptr;
};

/** Index of a point with the greatest computed n.p. */
int Farthest(const PointSet& set, const Eigen::Vector3d& n);

/** The same for the hulls of two non-empty sets of points. */
void Gjk(const PointSet& a, const PointSet& b, const Eigen::Vector3d& v0, double enough,
         GjkResult* result);

}  // namespace cguide::numeric
