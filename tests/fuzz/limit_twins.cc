#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/demand_limit.h"
#include "tests/fuzz/twins.h"

namespace cguide::fuzz {
namespace {

Vector3q GridVector(ByteStream& in) {
  const double x = in.NearGrid(), y = in.NearGrid(), z = in.NearGrid();
  return {Lift(x), Lift(y), Lift(z)};
}

exact::EquilibriumQuery Query(ByteStream& in) {
  exact::EquilibriumQuery query;
  const int count = in.Below(6);
  for (int i = 0; i < count; ++i) {
    exact::ExactContact contact;
    contact.p = GridVector(in);
    contact.cone.w = Vector3q::Zero();
    contact.cone.w[in.Below(3)] = in.Below(4) == 0 ? -1 : 1;
    if (in.Below(4) == 0) contact.cone.w = GridVector(in);
    contact.cone.mu = Lift(in.Below(5) / 4.0);
    if (i > 0 && in.Below(6) == 0) contact = query.contacts.front();
    query.contacts.push_back(std::move(contact));
  }
  query.com = GridVector(in);
  query.mass = in.Below(16);
  query.gravity = in.Below(4) == 0 ? GridVector(in) : Vector3q(0, 0, -10);
  return query;
}

exact::DemandFamily FamilyOf(ByteStream& in, const exact::EquilibriumQuery& query) {
  const Vector3q d = GridVector(in);
  switch (in.Below(3)) {
    case 0:
      return exact::AccelerationFamily(query, d);
    case 1:
      return exact::DisplacementFamily(query, d);
    default:
      return exact::ExtremeComFamily(query, GridVector(in), d);
  }
}

}  // namespace

std::string CheckLimits(ByteStream& in, bool thorough, Tally* tally) {
  const exact::EquilibriumQuery query = Query(in);
  exact::PyramidCone cone;
  exact::DemandFamily family;
  try {
    cone = exact::InscribedCone(query, 3 + in.Below(3));
    family = FamilyOf(in, query);
  } catch (const Error&) {
    ++tally->open;
    return "";
  }
  ++tally->cases;
  const exact::DemandLimit limit = numeric::FindDemandLimit(cone, family);
  ++(limit.basis == numeric::ProposeLimitBasis(cone, family) ? tally->fast : tally->exact);
  if (!exact::CheckDemandLimit(cone, family, limit)) return "a limit's proof does not check";
  if (!thorough) return "";
  ++tally->checked;
  const exact::DemandLimit twin = exact::FindDemandLimit(cone, family);
  if (twin.status != limit.status) return "twins disagree on the kind of a limit";
  if (twin.value != limit.value) return "twins disagree on a limit";
  return "";
}

}  // namespace cguide::fuzz
