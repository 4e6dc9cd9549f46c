// Near ties of static stability.
//
// Flat stances, whose truth tests/cases/flat_stances.cc derives. Every case that doubles leave open
// is asked of the exact stage, its verdict compared with the truth and its proof checked.
//
// The numbers of such a stance are few bits wide, or ("fine") as wide as doubles are on a plane
// across an axis; the centre of mass and the pull are then within some units of rounding of a tie.
// Each is also asked with the memory of those before it about the same stance.
//
// Bracketed stances: contacts on floors, slopes and walls, and two centres of mass at most 2^-30 m
// apart of which one is proved stable and the other unstable; between them, where doubles decline,
// the exact stage is asked and its proof checked.
#include <optional>

#include "cguide/exact/equilibrium.h"
#include "cguide/numeric/stability_memory.h"
#include "tests/cases/flat_stances.h"
#include "tests/cases/stored_query.h"
#include "tests/fuzz/near_ties.h"
#include "tests/fuzz/twins.h"
#include "tests/numeric/stability_cases.h"
#include "tests/numeric/stability_exact.h"

namespace cguide::fuzz {
namespace {

using Eigen::Vector3d;
using testing::FlatStance;
using testing::FlatTie;

/** Whether the result's witness proves what it says of the stored numbers. */
bool IsProof(const exact::EquilibriumQuery& query, const exact::StabilityResult& result) {
  if (result.verdict == Verdict::kHolds) return exact::CheckInteriorForces(query, result.forces);
  if (result.verdict == Verdict::kFails) {
    return exact::CheckSeparatingWrench(query, result.separator);
  }
  Rational gain = 0;
  for (int k = 0; k < 3; ++k) gain += result.separator[k] * query.gravity[k];
  return result.reason == exact::StabilityReason::kLadder ||
         (result.reason == exact::StabilityReason::kBoundary && gain == 0 &&
          exact::ArePolar(query, {result.separator}) && exact::CheckForces(query, result.forces));
}

// What doubles leave open. Counted where the exact stage's verdict can be compared with the truth:
// everywhere but where it stays undecided beside a tie.
std::string CheckExactStage(const numeric::StabilityQuery& query, Verdict truth, long every,
                            numeric::StabilityWorkspace* workspace, Tally* tally) {
  const numeric::SettledStability settled = Stability(query, workspace);
  if (!settled.exact) return "an open question was not asked of the exact stage";
  const exact::StabilityResult& result = *settled.exact;
  const exact::EquilibriumQuery lifted = testing::LiftStored(query);
  if (!IsProof(lifted, result)) return "the exact stage's witness proves nothing";
  const Verdict verdict = settled.answer.verdict;
  if (verdict != Verdict::kUndecided && verdict != truth) {
    return "a settled verdict is not the truth about a flat stance";
  }
  const bool decided =
      result.verdict != Verdict::kUndecided || result.reason == exact::StabilityReason::kBoundary;
  if (decided && result.verdict != truth) {
    return "the exact stage's verdict is not the truth about a flat stance";
  }
  if (decided) {
    ++tally->cases;
    ++tally->exact;
    tally->tied += truth == Verdict::kUndecided;
  } else {
    ++tally->open;
  }
  if (!SlowCheckIsDue(*tally, every)) return "";
  ++tally->checked;
  const exact::StabilityResult twin = exact::DecideStability(lifted);
  const bool agrees = twin.reason == exact::StabilityReason::kLadder ||
                      (twin.verdict == result.verdict && twin.reason == result.reason);
  return agrees ? "" : "the exact twin answers differently";
}

/** What the ties before it have taught proves no more about this one than is true. */
std::string CheckMemory(const numeric::StabilityQuery& query, Verdict truth,
                        numeric::StabilityMemory* memory, numeric::StabilityWorkspace* workspace) {
  const long before = memory->answered();
  const numeric::StabilityAnswer answer = TryStability(query, memory, workspace);
  if (answer.verdict == Verdict::kUndecided) return "";
  if (answer.verdict != truth) return "a verdict with memory is not the truth about a flat stance";
  if (memory->answered() == before) return "";
  return numeric::testing::IsProved(query, answer)
             ? ""
             : "a verdict from memory is not proved by its witness";
}

// Rounding may have undone a step, which leaves a tie; that the tie is near follows from the
// making.
std::string CheckFlat(const FlatStance& stance, const FlatTie& tie, long every,
                      numeric::StabilityMemory* memory, numeric::StabilityWorkspace* workspace,
                      Tally* tally) {
  const numeric::StabilityQuery query = QueryOf(stance, tie);
  const Verdict truth = TruthAbout(stance, tie);
  const std::string remembered = CheckMemory(query, truth, memory, workspace);
  if (!remembered.empty()) return remembered;
  const numeric::StabilityAnswer fast = TryStability(query, workspace);
  if (fast.verdict == Verdict::kUndecided) {
    return CheckExactStage(query, truth, every, workspace, tally);
  }
  ++tally->cases;
  ++tally->fast;
  if (fast.verdict != truth) return "a fast verdict is not the truth about a flat stance";
  return numeric::testing::IsProved(query, fast) ? ""
                                                 : "a fast verdict is not proved by its witness";
}

// Between a stable and an unstable centre of mass, where doubles decline: the proof tells.
std::string CheckMiddle(const numeric::StabilityQuery& query,
                        numeric::StabilityWorkspace* workspace, Tally* tally) {
  const numeric::SettledStability settled = Stability(query, workspace);
  if (!settled.exact) return "an open question was not asked of the exact stage";
  if (!IsProof(testing::LiftStored(query), *settled.exact))
    return "the exact stage's witness proves nothing";
  if (settled.exact->reason == exact::StabilityReason::kLadder) {
    ++tally->open;
    return "";
  }
  ++tally->cases;
  ++tally->exact;
  tally->tied += settled.exact->verdict == Verdict::kUndecided;
  return "";
}

std::string CheckProved(const numeric::StabilityQuery& query,
                        const numeric::StabilityAnswer& answer, Tally* tally) {
  ++tally->cases;
  ++tally->fast;
  return numeric::testing::IsProved(query, answer) ? ""
                                                   : "a fast verdict is not proved by its witness";
}

// Bisects between a stable and an unstable centre of mass as far as doubles decide.
std::string CheckBracket(TieRng& rng, numeric::StabilityWorkspace* workspace, Tally* tally) {
  numeric::Rng draw(rng());
  numeric::testing::Stance stance = numeric::testing::RandomStance(1 + Below(rng, 4), draw);
  numeric::StabilityQuery query = stance.Query();
  query.com_W = stance.centroid + Vector3d(0, 0, 0.5);
  Vector3d stable = query.com_W;
  numeric::StabilityAnswer inner = TryStability(query, workspace);
  if (inner.verdict != Verdict::kHolds) return "";
  const Vector3d center = stable;
  for (int direction = 0; direction < 8; ++direction) {
    stable = center;
    Vector3d unstable = center + Vector3d(GridValue(rng, 8, 8), GridValue(rng, 8, 8), 0) * 8;
    query.com_W = unstable;
    numeric::StabilityAnswer outer = TryStability(query, workspace);
    if (outer.verdict != Verdict::kFails) continue;
    while ((unstable - stable).norm() > 0x1p-40) {
      query.com_W = (stable + unstable) / 2;
      const numeric::StabilityAnswer middle = TryStability(query, workspace);
      if (middle.verdict == Verdict::kUndecided) break;
      (middle.verdict == Verdict::kHolds ? stable : unstable) = query.com_W;
      (middle.verdict == Verdict::kHolds ? inner : outer) = middle;
    }
    if ((unstable - stable).norm() > kNearTie || stable == center) continue;
    query.com_W = (stable + unstable) / 2;
    std::string wrong;
    if (TryStability(query, workspace).verdict == Verdict::kUndecided) {
      wrong = CheckMiddle(query, workspace, tally);
    }
    if (!wrong.empty()) return wrong;
    query.com_W = stable;
    wrong = CheckProved(query, inner, tally);
    query.com_W = unstable;
    if (wrong.empty()) wrong = CheckProved(query, outer, tally);
    if (!wrong.empty()) return wrong;
  }
  return "";
}

}  // namespace

std::string TiesOfStability(TieRng& rng, long every, Tally* tally) {
  numeric::StabilityWorkspace workspace;
  const int kind = Below(rng, 4);
  if (kind == 0) return CheckBracket(rng, &workspace, tally);
  if (kind == 1) return TiesOfStabilityCertificates(rng, tally);
  const bool fine = kind == 2;
  const FlatStance stance = fine ? testing::RandomFineStance(rng) : testing::RandomFlatStance(rng);
  numeric::StabilityMemory memory;
  for (int k = 0; k < 16; ++k) {
    const FlatTie tie =
        fine ? testing::MakeFineTie(rng, stance) : testing::MakeFlatTie(rng, stance);
    const std::string wrong = CheckFlat(stance, tie, every, &memory, &workspace, tally);
    if (!wrong.empty()) return wrong;
  }
  return "";
}

}  // namespace cguide::fuzz
