#include "cguide/exact/demand_limit.h"

#include <array>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/pyramids_internal.h"

namespace cguide::exact {
namespace {

Vector3q Weight(const EquilibriumQuery& query) { return Scaled(-query.mass, query.gravity); }

std::vector<WeightedForce> Positive(const std::vector<Rational>& x, std::size_t count) {
  std::vector<WeightedForce> forces;
  for (std::size_t j = 0; j < count; ++j) {
    if (x[j] != 0) forces.push_back({static_cast<int>(j), x[j]});
  }
  return forces;
}

/** Free variables are differences of two columns. */
std::vector<Rational> Differences(const std::vector<Rational>& x, std::size_t count) {
  std::vector<Rational> z;
  for (std::size_t j = count; j + 1 < x.size(); j += 2) z.push_back(x[j] - x[j + 1]);
  return z;
}

bool Supplies(const PyramidCone& cone, const std::vector<WeightedForce>& forces,
              const Vector6q& v) {
  Vector6q rest = v;
  for (const WeightedForce& force : forces) {
    if (force.generator < 0 || force.generator >= static_cast<int>(cone.wrenches.size()) ||
        force.weight <= 0) {
      return false;
    }
    for (int k = 0; k < 6; ++k) rest[k] -= force.weight * cone.wrenches[force.generator][k];
  }
  return IsZero(rest);
}

Vector6q Sum(const Vector6q& v, const DemandFamily& family, const std::vector<Rational>& z) {
  Vector6q sum = v;
  for (std::size_t k = 0; k < z.size(); ++k) {
    for (int i = 0; i < 6; ++i) sum[i] += z[k] * family.directions[k][i];
  }
  return sum;
}

Rational Objective(const DemandFamily& family, const std::vector<Rational>& z) {
  Rational sum = 0;
  for (std::size_t k = 0; k < z.size(); ++k) sum += family.objective[k] * z[k];
  return sum;
}

bool IsPolarTo(const PyramidCone& cone, const Vector6q& y) {
  for (const VectorXq& a : cone.wrenches) {
    if (Dot(y, a) > 0) return false;
  }
  return true;
}

}  // namespace

PyramidCone InscribedCone(const EquilibriumQuery& query, int sides) {
  internal::Generators generators = internal::InnerGenerators(query, sides);
  return {std::move(generators.forces), std::move(generators.wrenches)};
}

std::optional<PyramidCone> CircumscribedCone(const EquilibriumQuery& query, int sides) {
  auto wrenches = internal::OuterGenerators(query, sides);
  if (!wrenches) return std::nullopt;
  return PyramidCone{{}, std::move(*wrenches)};
}

DemandLimit FindDemandLimit(const PyramidCone& cone, const DemandFamily& family,
                            std::span<const int> start) {
  Require(family.directions.size() == family.objective.size(),
          "every direction needs its part of the objective");
  const std::size_t count = cone.wrenches.size();
  LinearProgram program;
  program.columns = cone.wrenches;
  program.b = family.v;
  program.c.assign(count, 0);
  for (std::size_t k = 0; k < family.directions.size(); ++k) {
    program.columns.push_back(-family.directions[k]);
    program.columns.push_back(family.directions[k]);
    program.c.push_back(family.objective[k]);
    program.c.push_back(-family.objective[k]);
  }
  const ProgramSolution solution = SolveLinearProgram(program, start);
  DemandLimit limit;
  limit.status = solution.status;
  limit.basis = solution.basis;
  if (solution.status == ProgramStatus::kInfeasible) {
    limit.y = solution.y;
    return limit;
  }
  limit.value = solution.value;
  limit.z = Differences(solution.x, count);
  limit.forces = Positive(solution.x, count);
  if (solution.status == ProgramStatus::kUnbounded) {
    limit.z_ray = Differences(solution.ray, count);
    limit.ray_forces = Positive(solution.ray, count);
  } else {
    limit.y = -solution.y;  // y.a >= 0 and y.(-D_k) = objective_k there
  }
  return limit;
}

bool CheckDemandLimit(const PyramidCone& cone, const DemandFamily& family,
                      const DemandLimit& limit) {
  const std::size_t n = family.directions.size();
  if (family.objective.size() != n) return false;
  const auto slopes_are = [&](bool objective) {
    for (std::size_t k = 0; k < n; ++k) {
      if (Dot(limit.y, family.directions[k]) != (objective ? family.objective[k] : Rational(0))) {
        return false;
      }
    }
    return true;
  };
  if (limit.status == ProgramStatus::kInfeasible) {
    return IsPolarTo(cone, limit.y) && slopes_are(false) && Dot(limit.y, family.v) > 0;
  }
  if (limit.z.size() != n || !Supplies(cone, limit.forces, Sum(family.v, family, limit.z))) {
    return false;
  }
  if (limit.status == ProgramStatus::kOptimal) {
    return IsPolarTo(cone, limit.y) && slopes_are(true) && -Dot(limit.y, family.v) == limit.value &&
           Objective(family, limit.z) == limit.value;
  }
  return limit.z_ray.size() == n && Objective(family, limit.z_ray) > 0 &&
         Supplies(cone, limit.ray_forces, Sum(Vector6q::Zero(), family, limit.z_ray));
}

DemandFamily AccelerationFamily(const EquilibriumQuery& query, const Vector3q& d) {
  DemandFamily family;
  family.v = Vector6q::Zero();
  family.v.head(3) = Weight(query);
  family.directions.push_back(Vector6q::Zero());
  family.directions[0].head(3) = Scaled(query.mass, d);
  family.objective = {1};
  return family;
}

DemandFamily DisplacementFamily(const EquilibriumQuery& query, const Vector3q& d) {
  DemandFamily family;
  family.v = Vector6q::Zero();
  family.v.head(3) = Weight(query);
  family.directions.push_back(Vector6q::Zero());
  family.directions[0].tail(3) = Cross(d, Weight(query));
  family.objective = {1};
  return family;
}

DemandFamily ExtremeComFamily(const EquilibriumQuery& query, const Vector3q& up,
                              const Vector3q& d) {
  Require(!IsZero(up), "a plane needs a normal");
  DemandFamily family;
  family.v = Vector6q::Zero();
  family.v.head(3) = Weight(query);
  for (const Vector3q& e : PlaneAxes(up)) {
    family.directions.push_back(Vector6q::Zero());
    family.directions.back().tail(3) = Cross(e, Weight(query));
    family.objective.push_back(Dot(d, e));
  }
  return family;
}

Vector3q DisplacementOf(const Vector3q& up, const std::vector<Rational>& z) {
  Require(z.size() == 2, "two coordinates make a displacement in a plane");
  const auto axes = PlaneAxes(up);
  return Scaled(z[0], axes[0]) + Scaled(z[1], axes[1]);
}

}  // namespace cguide::exact
