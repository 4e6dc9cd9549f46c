#include "cguide/exact/equilibrium.h"
#include "cguide/numeric/stability.h"
#include "tests/cases/stored_query.h"
#include "tests/fuzz/byte_contacts.h"
#include "tests/fuzz/twins.h"
#include "tests/numeric/stability_exact.h"

namespace cguide::fuzz {

std::string CheckStability(ByteStream& in, bool thorough, Tally* tally) {
  const int count = in.Below(9);
  const std::vector<numeric::Contact> contacts = PointContacts(in, count);
  numeric::StabilityQuery query;
  query.contacts = contacts;
  query.com_W = in.Point();
  query.mass = 50;
  ++tally->cases;
  numeric::StabilityWorkspace workspace;
  const numeric::StabilityAnswer fast = TryStability(query, &workspace);
  if (fast.verdict == Verdict::kUndecided) {
    ++tally->exact;
  } else {
    ++tally->fast;
    if (!numeric::testing::IsProved(query, fast))
      return "a fast verdict is not proved by its witness";
  }
  if (!thorough && fast.verdict != Verdict::kUndecided) return "";
  const exact::EquilibriumQuery lifted = testing::LiftStored(query);
  const exact::StabilityResult twin = exact::DecideStability(lifted);
  if (fast.verdict != Verdict::kUndecided && twin.verdict != Verdict::kUndecided &&
      fast.verdict != twin.verdict) {
    return "the exact twin answers differently";
  }
  if (twin.verdict == Verdict::kHolds && !exact::CheckInteriorForces(lifted, twin.forces)) {
    return "the exact twin's forces prove nothing";
  }
  if (twin.verdict == Verdict::kFails && !exact::CheckSeparatingWrench(lifted, twin.separator)) {
    return "the exact twin's wrench separates nothing";
  }
  tally->checked += thorough;
  const numeric::SettledStability settled = Stability(query, &workspace);
  const Verdict verdict = settled.answer.verdict;
  if (verdict == Verdict::kUndecided) {
    ++tally->open;
  } else if (twin.verdict != Verdict::kUndecided && verdict != twin.verdict) {
    return "the settled verdict is not the exact one";
  }
  return "";
}

}  // namespace cguide::fuzz
