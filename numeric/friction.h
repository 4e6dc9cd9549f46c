#pragma once

#include <Eigen/Core>
#include <vector>

#include "cguide/numeric/stability.h"

namespace cguide::numeric {

using Vector6d = Eigen::Matrix<double, 6, 1>;

enum class Pyramid {
  kInscribed,      ///< edges on the revolution cone
  kCircumscribed,  ///< faces touching the revolution cone
};

/** Edges of an n-sided friction pyramid of the contact, with u.n = 1: n + rho t_j, rho = mu, or
 mu/cos(pi/n) where circumscribed, t_j at equal angles counter-clockwise about n. The first t is the
 projection of the world axis least aligned with n (the first of equals); circumscribed edges stand
 half a side off. mu = 0 gives n alone. Plain floats, no bounds; appended to `edges`.
 @throws Error unless sides >= 3. */
void AppendPyramid(const Contact& contact, int sides, Pyramid kind,
                   std::vector<Eigen::Vector3d>* edges);

/** The wrenches (u, (p - c) x u) of the pyramids of all the query's contacts (query.generators
 sides, certain and possible ones alike), moments about the centre of mass, in W (N, N m per unit
 u). */
std::vector<Vector6d> WrenchGenerators(const StabilityQuery& query, Pyramid kind);

/** v = (-m g, 0): the wrench the contacts must supply, moments about the centre of mass. */
Vector6d RequiredWrench(const StabilityQuery& query);

}  // namespace cguide::numeric
