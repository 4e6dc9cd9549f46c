#include "cguide/exact/cone.h"
#include "cguide/exact/core/error.h"
#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/cone_membership.h"
#include "tests/fuzz/twins.h"

namespace cguide::fuzz {
namespace {

using exact::Membership;
using Vector6d = numeric::WrenchCone::Vector6d;

/** Generators on a grid: pyramids at points, lone forces, copies, multiples and sums of earlier
 * ones. */
std::vector<AppliedForce> Forces(ByteStream& in, int most) {
  std::vector<AppliedForce> forces;
  const int groups = in.Below(6);
  for (int g = 0; g < groups && static_cast<int>(forces.size()) < most; ++g) {
    const Eigen::Vector3d p = in.Point();
    const int kind = in.Below(5), axis = in.Below(3);
    if (kind < 3) {
      const double sign = in.Below(4) == 0 ? -1 : 1, mu = 0.25 * (1 + in.Below(4));
      for (int k = 0; k < 4; ++k) {
        Eigen::Vector3d u;
        u[axis] = sign;
        u[(axis + 1) % 3] = k & 1 ? mu : -mu;
        u[(axis + 2) % 3] = k & 2 ? mu : -mu;
        forces.push_back({p, u});
      }
    } else if (kind == 3 || forces.empty()) {
      forces.push_back({p, in.Point()});
    } else {
      AppliedForce copy = forces[static_cast<std::size_t>(in.Byte()) % forces.size()];
      copy.u *= std::ldexp(1.0, in.Below(9) - 4);
      forces.push_back(copy);
    }
  }
  return forces;
}

/** A demand: a vertical load near a grid point, a sum of generators, or anything. */
AppliedForce Demand(ByteStream& in, const std::vector<AppliedForce>& forces) {
  const int kind = in.Below(4);
  if (kind == 0 && !forces.empty()) {
    const AppliedForce& a = forces[static_cast<std::size_t>(in.Byte()) % forces.size()];
    return {a.p, a.u * (1 + in.Below(3))};
  }
  if (kind == 1) return {in.Point(), in.Point()};
  return {in.Point(), Eigen::Vector3d(0, 0, 1 + in.Below(4))};
}

}  // namespace

std::string CheckCone(ByteStream& in, bool thorough, Tally* tally) {
  const bool as_wrenches = in.Below(4) == 0;
  std::vector<AppliedForce> forces = Forces(in, 40);
  AppliedForce demand = Demand(in, forces);
  numeric::WrenchCone cone;
  std::optional<numeric::WrenchDemand> v;
  if (as_wrenches) {
    std::vector<Vector6d> wrenches;
    for (const AppliedForce& a : forces) {
      Vector6d w;
      w << a.u, a.p;
      if (in.Below(8) == 0) w[in.Below(6)] = in.Wild();
      wrenches.push_back(w);
    }
    Vector6d w;
    w << demand.u, demand.p;
    cone = numeric::WrenchCone::OfWrenches(wrenches);
    v = numeric::WrenchDemand(w);
  } else {
    if (in.Below(16) == 0) demand.p[in.Below(3)] = in.Wild();
    cone = numeric::WrenchCone::OfForces(forces);
    v = numeric::WrenchDemand(demand);
  }
  ++tally->cases;
  numeric::ConeWorkspace workspace;
  if (!cone.is_finite() || !v->is_finite()) {
    ++tally->open;
    try {
      ConeMembership(cone, *v, &workspace);
      return "a number that is not finite was accepted";
    } catch (const Error&) {
      return "";
    }
  }
  const numeric::ConeAnswer answer = ConeMembership(cone, *v, &workspace);
  ++(answer.stage == numeric::ConeStage::kFast ? tally->fast : tally->exact);
  const exact::ConeMembership proof = ExactProof(cone, *v, answer);
  if (proof.where != answer.where) return "the proof is of another answer";
  if (!exact::CheckConeMembership(cone.ExactColumns(), v->Exact(), proof)) {
    return "the answer's proof is not valid";
  }
  numeric::ConeBatch batch(cone);
  for (int i = 0; i < 2; ++i) {
    if (batch.Membership(*v).where != answer.where) return "a batch answers differently";
  }
  if (!thorough) return "";
  ++tally->checked;
  const auto twin = exact::DecideConeMembership(cone.ExactColumns(), v->Exact());
  if (twin.where != answer.where) return "the exact twin answers differently";
  const auto program = exact::DecideConeMembershipByQp(cone.ExactColumns(), v->Exact());
  return program.where == answer.where ? "" : "quadratic programming answers differently";
}

std::string CheckFacets(ByteStream& in, bool thorough, Tally* tally) {
  const std::vector<AppliedForce> forces = Forces(in, 20);
  ++tally->cases;
  const numeric::CertifiedDual dual = numeric::CertifiedFacets(forces);
  ++(dual.counters.exact_sides == 0 ? tally->fast : tally->exact);
  const exact::HalfspaceCone ours = numeric::ExactFacets(forces, dual);
  exact::GeneratorCone generators{6, {}, {}};
  const numeric::WrenchCone cone = numeric::WrenchCone::OfForces(forces);
  for (const VectorXq& a : cone.ExactColumns()) generators.rays.push_back(a);
  const exact::HalfspaceCone twin = exact::FacetsOf(generators);
  if (!(ours == twin)) return "the certified facets are not the exact ones";
  if (!thorough) return "";
  ++tally->checked;
  const exact::GeneratorCone back = exact::GeneratorsOf(ours);
  return back == exact::Minimal(generators) ? "" : "the facets do not give the generators back";
}

}  // namespace cguide::fuzz
