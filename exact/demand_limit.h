#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cguide/exact/equilibrium.h"
#include "cguide/exact/linear_program.h"

namespace cguide::exact {

/** Forces whose positive combinations are the admissible ones of pyramids, and their wrenches (u,
 (p - com) x u) about the query's centre of mass. */
struct PyramidCone {
  std::vector<ContactForce> forces;
  std::vector<VectorXq> wrenches;
};

/** Inscribed pyramids (see InscribedPyramid) of the certain contacts, narrowed for their errors.
 Every force is admissible, so what such a cone supplies the revolution cones supply too.
 @throws Error unless sides >= 3 and no normal vanishes. */
PyramidCone InscribedCone(const EquilibriumQuery& query, int sides);

/** Circumscribed pyramids of all contacts, widened for their errors, at every arm the errors allow:
 a cone that holds every wrench the contacts can supply, so that its limits bound the revolution
 cones' from above as those of InscribedCone do from below. Wrenches alone, without forces. Nothing
 where the error of a normal is too large. */
std::optional<PyramidCone> CircumscribedCone(const EquilibriumQuery& query, int sides);

/** The demands v + sum_k z_k directions_k, z in R^n, and what is sought among those in the cone:
 the largest objective.z. */
struct DemandFamily {
  Vector6q v;
  std::vector<Vector6q> directions;
  std::vector<Rational> objective;
};

struct WeightedForce {
  int generator = -1;  ///< index into the cone's forces
  Rational weight;     ///< > 0
};

/** The outcome with its proof.

 kOptimal: forces supply v + D z, objective.z = value, and y with y.a <= 0 for every generator,
 y.D_k = objective_k, -y.v = value: every supplied demand has 0 >= y.(v + D z) = objective.z -
 value. kUnbounded (force closure is a case): forces supply v + D z; ray forces supply D z_ray,
 objective.z_ray > 0. kInfeasible: y.a <= 0 < y.v and y.D_k = 0, no demand of the family is in the
 cone. */
struct DemandLimit {
  ProgramStatus status = ProgramStatus::kInfeasible;
  Rational value = 0;
  std::vector<Rational> z, z_ray;
  std::vector<WeightedForce> forces, ray_forces;
  Vector6q y = Vector6q::Zero();
  std::vector<int> basis;  ///< a start for another of the kind
};

/** By SolveLinearProgram. @param start a basis as DemandLimit::basis reports it.
 @post CheckDemandLimit. @throws Error where sizes differ. */
DemandLimit FindDemandLimit(const PyramidCone& cone, const DemandFamily& family,
                            std::span<const int> start = {});

bool CheckDemandLimit(const PyramidCone& cone, const DemandFamily& family,
                      const DemandLimit& limit);

/** Gravity, inertia: m(a - g) acting at the centre of mass with a = z d, angular momentum about it
 constant: v = (-m g, 0), D = (m d, 0). The value is the largest acceleration in units of d. */
DemandFamily AccelerationFamily(const EquilibriumQuery& query, const Vector3q& d);

/** The centre of mass displaced by z d at rest: D = (0, d x (-m g)). The value is how far it can
 * go. */
DemandFamily DisplacementFamily(const EquilibriumQuery& query, const Vector3q& d);

/** The centre of mass displaced by z_1 e_1 + z_2 e_2, normal to `up`, as far as possible along d:
 the extreme point of the support region in that direction. */
DemandFamily ExtremeComFamily(const EquilibriumQuery& query, const Vector3q& up, const Vector3q& d);

/** The displacement that z stands for in an ExtremeComFamily. */
Vector3q DisplacementOf(const Vector3q& up, const std::vector<Rational>& z);

}  // namespace cguide::exact
