#pragma once

#include "cguide/exact/equilibrium.h"
#include "cguide/numeric/round_cones_internal.h"

// The same stored contacts as rationals and as integers, for tests of the exact stage of stability.
namespace cguide::numeric::testing {

inline exact::EquilibriumQuery AsRationals(const StabilityQuery& query) {
  exact::EquilibriumQuery result;
  for (const Contact& c : query.contacts) {
    result.contacts.push_back({Lift(c.force_point_W()), {Lift(c.n_W), Lift(c.friction)}});
  }
  result.com = Lift(query.com_W);
  result.mass = Lift(query.mass);
  result.gravity = Lift(query.gravity_W);
  return result;
}

inline std::optional<IntegerEquilibrium> AsIntegers(const StabilityQuery& query) {
  ScaledContacts scaled;
  IntegerEquilibrium e;
  if (!ScaleContacts(query, &scaled) || !LiftEquilibrium(query, scaled, scaled.count, &e)) {
    return std::nullopt;
  }
  return e;
}

/** Whether the witness proves what the result says, boundaries included. */
inline bool IsProof(const exact::EquilibriumQuery& query, const exact::StabilityResult& result) {
  if (result.rank != exact::WrenchRank(query)) return false;
  if (result.verdict == Verdict::kHolds) return exact::CheckInteriorForces(query, result.forces);
  if (result.verdict == Verdict::kFails) {
    return exact::CheckSeparatingWrench(query, result.separator);
  }
  if (!exact::CheckForces(query, result.forces)) return false;
  if (result.reason == exact::StabilityReason::kRank) return result.rank < 6;
  Rational gain = 0;
  for (int k = 0; k < 3; ++k) gain += result.separator[k] * query.gravity[k];
  return result.reason == exact::StabilityReason::kBoundary && gain == 0 &&
         !result.separator.isZero() && exact::ArePolar(query, {result.separator});
}

}  // namespace cguide::numeric::testing
