// Near ties of cones: the case moves a wrench off a face of the cone. The truth about it is read
// from the facets that exact::FacetsOf finds once per stance, over the integers.
#include <algorithm>

#include "cguide/exact/cone.h"
#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/cone_membership.h"
#include "tests/cases/wrench_sets.h"
#include "tests/fuzz/near_ties.h"
#include "tests/fuzz/twins.h"

namespace cguide::fuzz {
namespace {

using exact::Membership;
using Vector6d = numeric::WrenchCone::Vector6d;
using Integers = std::array<mpz_class, 6>;

// v times its common denominator: the sign of an inner product does not change with that.
Integers Scaled(const VectorXq& v) {
  mpz_class denominator = 1;
  for (int i = 0; i < 6; ++i) {
    mpz_lcm(denominator.get_mpz_t(), denominator.get_mpz_t(), v[i].get_den_mpz_t());
  }
  Integers result;
  for (int i = 0; i < 6; ++i) {
    result[i] = v[i].get_num() * (denominator / v[i].get_den());
  }
  return result;
}

int SignOfDot(const Integers& a, const Integers& b) {
  mpz_class sum = 0;
  for (int i = 0; i < 6; ++i) mpz_addmul(sum.get_mpz_t(), a[i].get_mpz_t(), b[i].get_mpz_t());
  return sgn(sum);
}

/** The facets and equations of a cone, ready for signs. */
struct Walls {
  std::vector<Integers> facets;
  std::vector<Integers> equations;

  explicit Walls(const exact::HalfspaceCone& cone) {
    for (const VectorXq& h : cone.facets) facets.push_back(Scaled(h));
    for (const VectorXq& e : cone.equations) equations.push_back(Scaled(e));
  }

  Membership Where(const VectorXq& wrench) const {
    const Integers v = Scaled(wrench);
    bool boundary = !equations.empty();
    for (const Integers& e : equations) {
      if (SignOfDot(e, v) != 0) return Membership::kOutside;
    }
    for (const Integers& h : facets) {
      const int sign = SignOfDot(h, v);
      if (sign > 0) return Membership::kOutside;
      boundary |= sign == 0;
    }
    return boundary ? Membership::kBoundary : Membership::kInterior;
  }
};

exact::GeneratorCone Lifted(const std::vector<VectorXq>& rays) { return {6, rays, {}}; }

VectorXq LiftWrench(const Vector6d& w) {
  VectorXq v(6);
  for (int i = 0; i < 6; ++i) v[i] = Lift(w[i]);
  return v;
}

/** Generators with few bits: sums with small weights are exact in doubles. */
struct Stance {
  std::vector<Vector6d> wrenches;
  std::vector<AppliedForce> forces;  ///< the same, where they are forces at points
};

Vector6d WrenchOf(const AppliedForce& a) {
  Vector6d w;
  w << a.u, a.p[1] * a.u[2] - a.p[2] * a.u[1], a.p[2] * a.u[0] - a.p[0] * a.u[2],
      a.p[0] * a.u[1] - a.p[1] * a.u[0];
  return w;
}

// Pyramids at points of the grid of sixteenths: two feet, hands on walls. Coplanar points and equal
// friction give facets with many generators.
Stance PyramidStance(TieRng& rng, int most) {
  Stance stance;
  const int points = 2 + Below(rng, most);
  const bool flat = Below(rng, 2) == 0;
  for (int k = 0; k < points; ++k) {
    Eigen::Vector3d p = GridPoint(rng, 16, 16);
    const int axis = flat || k < 2 ? 2 : Below(rng, 3);
    if (flat) p[2] = 0;
    const double mu = 0.25 * (1 + Below(rng, 4));
    const double sign = axis == 2 || Below(rng, 2) == 0 ? 1 : -1;
    for (int i = 0; i < 4; ++i) {
      Eigen::Vector3d u;
      u[axis] = sign;
      u[(axis + 1) % 3] = i & 1 ? mu : -mu;
      u[(axis + 2) % 3] = i & 2 ? mu : -mu;
      stance.forces.push_back({p, u});
      stance.wrenches.push_back(WrenchOf(stance.forces.back()));
    }
  }
  return stance;
}

// Wrenches in general position on one side of a plane, each number a multiple of 2^-10.
Stance LooseStance(TieRng& rng, int count) {
  Stance stance;
  for (int k = 0; k < count; ++k) {
    Vector6d w;
    for (int i = 0; i < 6; ++i) w[i] = GridValue(rng, 1024, 1024);
    w[2] = std::abs(w[2]) + 0.25;
    stance.wrenches.push_back(w);
  }
  return stance;
}

std::vector<VectorXq> ExactWrenches(const Stance& stance) {
  std::vector<VectorXq> rays;
  for (const Vector6d& w : stance.wrenches) rays.push_back(LiftWrench(w));
  return rays;
}

/** A point of the boundary of the cone, exact in doubles. */
Vector6d BoundaryPoint(TieRng& rng, const Stance& stance, const std::vector<Integers>& rays,
                       const Walls& walls) {
  const Integers& wall = walls.facets[rng() % walls.facets.size()];
  const bool sparse = Below(rng, 2) == 0;  // of a face of the facet, as a rule
  Vector6d v = Vector6d::Zero();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (SignOfDot(wall, rays[i]) != 0 || (sparse && Below(rng, 2) == 0)) continue;
    v += (1 + Below(rng, 15)) / 8.0 * stance.wrenches[i];
  }
  return v;
}

/** A step from the boundary: into the cone, away from it, or anywhere. */
Vector6d Direction(TieRng& rng, const Stance& stance) {
  Vector6d d = Vector6d::Zero();
  if (Below(rng, 3) == 0) {
    for (int i = 0; i < 6; ++i) d[i] = GridValue(rng, 8, 8);
  } else {
    for (const Vector6d& w : stance.wrenches) d += w;
  }
  const double length = d.norm();
  return length > 0 ? Vector6d(d / length) : Vector6d::Unit(2);
}

struct NearTie {
  Vector6d at;  ///< exactly on the boundary
  Vector6d v;   ///< the case, as rounded
};

NearTie MakeNearTie(TieRng& rng, const Stance& stance, const std::vector<Integers>& rays,
                    const Walls& walls) {
  NearTie tie;
  tie.at = BoundaryPoint(rng, stance, rays, walls);
  tie.v = tie.at + tie.at.norm() * TinyStep(rng) * Direction(rng, stance);
  return tie;
}

bool IsNear(const NearTie& tie, const Walls& walls) {
  return !tie.v.isZero(0) && walls.Where(LiftWrench(tie.at)) == Membership::kBoundary &&
         (tie.v - tie.at).norm() <= kNearTie * tie.v.norm();
}

std::string CheckAnswer(const numeric::WrenchCone& cone, const std::vector<VectorXq>& rays,
                        const numeric::WrenchDemand& demand, Membership truth, bool thorough,
                        numeric::ConeWorkspace* workspace, Tally* tally) {
  const numeric::ConeAnswer answer = ConeMembership(cone, demand, workspace);
  ++tally->cases;
  tally->tied += truth == Membership::kBoundary;
  ++(answer.stage == numeric::ConeStage::kFast ? tally->fast : tally->exact);
  if (answer.where != truth) return "the answer is not that of the exact facets";
  const exact::ConeMembership proof = ExactProof(cone, demand, answer);
  if (proof.where != truth || !exact::CheckConeMembership(rays, demand.Exact(), proof)) {
    return "the answer's proof is not valid";
  }
  if (!thorough) return "";
  ++tally->checked;
  if (exact::DecideConeMembership(rays, demand.Exact()).where != truth) {
    return "the exact twin answers differently";
  }
  return exact::DecideConeMembershipByQp(rays, demand.Exact()).where == truth
             ? ""
             : "quadratic programming answers differently";
}

// The stances of tests/cases/wrench_sets, with their demands as forces at points: centres of mass
// on an edge or a vertex of the support, or 2^-30 m to 2^-40 m beside it.
std::string TiesOfStances(TieRng& rng, long every, Tally* tally) {
  numeric::ConeWorkspace workspace;
  for (const testing::TieCase& tie : testing::TieCases(10, rng)) {
    const auto cone = numeric::WrenchCone::OfForces(tie.set.generators);
    const std::vector<VectorXq> rays = cone.ExactColumns();
    const Walls walls(exact::FacetsOf(Lifted(rays)));
    if (walls.facets.empty() && walls.equations.empty()) continue;
    const numeric::WrenchDemand demand(tie.demand);
    const std::string wrong = CheckAnswer(cone, rays, demand, walls.Where(demand.Exact()),
                                          SlowCheckIsDue(*tally, every), &workspace, tally);
    if (!wrong.empty()) return tie.name + ": " + wrong;
  }
  return "";
}

}  // namespace

std::string TiesOfCones(TieRng& rng, long every, Tally* tally) {
  const int kind = Below(rng, 16);
  if (kind == 0) return TiesOfStances(rng, every, tally);
  const Stance stance = kind < 12 ? PyramidStance(rng, 4) : LooseStance(rng, 6 + Below(rng, 8));
  const std::vector<VectorXq> columns = ExactWrenches(stance);
  const Walls walls(exact::FacetsOf(Lifted(columns)));
  if (walls.facets.empty()) return "";
  std::vector<Integers> rays;
  for (const VectorXq& column : columns) rays.push_back(Scaled(column));
  const bool as_forces = !stance.forces.empty() && Below(rng, 2) == 0;
  const auto cone = as_forces ? numeric::WrenchCone::OfForces(stance.forces)
                              : numeric::WrenchCone::OfWrenches(stance.wrenches);
  numeric::ConeWorkspace workspace;
  for (int k = 0; k < 128; ++k) {
    const NearTie tie = MakeNearTie(rng, stance, rays, walls);
    if (!IsNear(tie, walls)) continue;
    const std::string wrong =
        CheckAnswer(cone, columns, numeric::WrenchDemand(tie.v), walls.Where(LiftWrench(tie.v)),
                    SlowCheckIsDue(*tally, every), &workspace, tally);
    if (!wrong.empty()) return wrong;
  }
  return "";
}

std::string TiesOfFacets(TieRng& rng, long every, Tally* tally) {
  const Stance stance =
      Below(rng, 4) == 0 ? PyramidStance(rng, 1) : LooseStance(rng, 6 + Below(rng, 3));
  const std::vector<VectorXq> columns = ExactWrenches(stance);
  const Walls walls(exact::FacetsOf(Lifted(columns)));
  if (walls.facets.empty()) return "";
  std::vector<Integers> rays;
  for (const VectorXq& column : columns) rays.push_back(Scaled(column));
  for (int k = 0; k < 32; ++k) {
    const NearTie tie = MakeNearTie(rng, stance, rays, walls);
    if (!IsNear(tie, walls)) continue;
    // The wrench near the face becomes one generator more, anywhere among them.
    std::vector<Vector6d> wrenches = stance.wrenches;
    exact::GeneratorCone generators = Lifted(columns);
    const auto place = static_cast<std::ptrdiff_t>(rng() % (wrenches.size() + 1));
    wrenches.insert(wrenches.begin() + place, tie.v);
    generators.rays.insert(generators.rays.begin() + place, LiftWrench(tie.v));
    const numeric::CertifiedDual dual = numeric::CertifiedFacets(wrenches);
    ++tally->cases;
    tally->tied += tie.v == tie.at;
    ++(dual.counters.exact_sides == 0 ? tally->fast : tally->exact);
    const exact::HalfspaceCone ours = numeric::ExactFacets(wrenches, dual);
    if (!(ours == exact::FacetsOf(generators)))
      return "the certified facets are not the exact ones";
    if (!SlowCheckIsDue(*tally, every)) continue;
    ++tally->checked;
    if (!(exact::GeneratorsOf(ours) == exact::Minimal(generators))) {
      return "the facets do not give the generators back";
    }
  }
  return "";
}

}  // namespace cguide::fuzz
