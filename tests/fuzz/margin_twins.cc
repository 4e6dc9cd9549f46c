#include <algorithm>
#include <cmath>

#include "cguide/exact/com_region_search.h"
#include "cguide/numeric/proved_acceleration.h"
#include "cguide/numeric/proved_margins.h"
#include "tests/cases/stored_query.h"
#include "tests/fuzz/byte_contacts.h"
#include "tests/fuzz/twins.h"

namespace cguide::fuzz {
namespace {

using exact::Enclosure;

bool Overlap(const Enclosure& a, const Enclosure& b) {
  return !std::isnan(a.lo + b.lo) && a.lo <= a.hi && b.lo <= b.hi && a.lo <= b.hi && b.lo <= a.hi;
}

/** Against the region of the exact twin and the verdict. */
std::string CheckMargin(const numeric::StabilityQuery& query, bool thorough,
                        numeric::StabilityWorkspace* workspace, Tally* tally) {
  const numeric::ProvedComMargin claim = ProveComMargin(query, {}, workspace);
  const exact::ComRegionEvidence& evidence = claim.proof.evidence;
  const bool floats = !evidence.corners.empty() && !evidence.corners.front().base_weight.empty();
  ++(floats ? tally->fast : tally->exact);
  const exact::EquilibriumQuery& lifted = claim.proof.lifted.query;
  const Vector3q up = Lift(Eigen::Vector3d(-query.gravity_W));
  if (!CheckComRegion(lifted, up, evidence)) return "a region's evidence does not check";
  const Verdict verdict = TryStability(query, workspace).verdict;
  if (verdict == Verdict::kHolds && claim.com_m.hi <= 0) return "stable without a margin";
  // Nothing is refuted by the absence of what only may be a contact, which supports no margin.
  const bool all_certain = std::all_of(query.contacts.begin(), query.contacts.end(),
                                       [](const numeric::Contact& c) { return c.certain; });
  if (all_certain && verdict == Verdict::kFails && claim.com_m.lo > 0) {
    return "unstable with a margin";
  }
  if (!thorough) return "";
  ++tally->checked;
  const auto twin = CheckComRegion(lifted, up, exact::SearchComRegion(lifted, up));
  if (!twin) return "the exact twin's evidence does not check";
  return Overlap(claim.com_m, exact::MarginBounds(*twin)) ? "" : "twins disagree on com_m";
}

std::string CheckGradient(const numeric::StabilityQuery& query,
                          numeric::StabilityWorkspace* workspace) {
  const auto claim = ProveComMarginGradient(query, {}, workspace);
  if (!claim) return "";
  const auto box = CheckMarginGradient(claim->lifted.query, claim->evidence);
  if (!box || !Overlap(box->com_m, claim->com_m)) return "a gradient's evidence does not check";
  // com_m is 1-Lipschitz in the centre of mass, moved across gravity.
  for (std::size_t k = 0; k < 3; ++k) {
    if (!Overlap(claim->com_W[k], {-1, 1})) return "a gradient steeper than 1";
  }
  return "";
}

std::string CheckAcceleration(const numeric::StabilityQuery& query, const Eigen::Vector3d& d,
                              numeric::StabilityWorkspace* workspace) {
  numeric::AccelerationOptions options;
  options.sides = 5;
  const numeric::ProvedAcceleration claim = ProveLargestAcceleration(query, d, options);
  const exact::EquilibriumQuery& lifted = claim.lifted.query;
  if (!CheckDemandLimit(InscribedCone(lifted, options.sides), claim.family, claim.inner)) {
    return "the lower limit's proof does not check";
  }
  const auto outer = CircumscribedCone(lifted, options.sides);
  if (claim.outer && (!outer || !CheckDemandLimit(*outer, claim.family, *claim.outer))) {
    return "the upper limit's proof does not check";
  }
  if (claim.largest.lo > claim.largest.hi) return "an empty enclosure of an acceleration";
  const bool stands = TryStability(query, workspace).verdict == Verdict::kHolds;
  return stands && claim.largest.hi <= 0 ? "stable, but no acceleration can be carried" : "";
}

}  // namespace

std::string CheckMargins(ByteStream& in, bool thorough, Tally* tally) {
  const int count = in.Below(7);
  const std::vector<numeric::Contact> contacts = PointContacts(in, count);
  numeric::StabilityQuery query;
  query.contacts = contacts;
  query.com_W = in.Point();
  query.mass = 50;
  const int asked = in.Below(4);
  const Eigen::Vector3d d = in.Point();
  numeric::StabilityWorkspace workspace;
  ++tally->cases;
  std::string wrong = CheckMargin(query, thorough, &workspace, tally);
  if (wrong.empty() && asked == 1) wrong = CheckGradient(query, &workspace);
  if (wrong.empty() && asked == 2 && !d.isZero()) wrong = CheckAcceleration(query, d, &workspace);
  return wrong;
}

}  // namespace cguide::fuzz
