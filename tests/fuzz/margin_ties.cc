// Near ties of the margins: flat stances (tests/cases/flat_region.h, flat_acceleration.h).
//
// com_m, the region and the gradient: the centre of mass is over a side or corner of the hull, or
// beside it, and the pull on the friction cone or beside it, where the region becomes empty. For
// the gradient, which is not stated where com_m may be 0: the centre of mass is as far from two
// sides that are at right angles, or where the nearest point of the region passes from a side to a
// corner. Accelerations: their limit by friction is that by the hull, or the robot stands at the
// edge of balance already.
#include <cmath>

#include "cguide/exact/com_region_search.h"
#include "cguide/numeric/proved_acceleration.h"
#include "cguide/numeric/proved_margins.h"
#include "tests/cases/flat_acceleration.h"
#include "tests/cases/flat_region.h"
#include "tests/fuzz/near_ties.h"
#include "tests/fuzz/twins.h"

namespace cguide::fuzz {
namespace {

using Eigen::Vector3d;
using testing::FlatRegion;
using testing::FlatStance;
using testing::FlatTie;

/** Of its points one or two: the hull is a point or a segment. */
FlatStance Thinned(TieRng& rng, FlatStance stance) {
  const std::size_t kept = 1 + rng() % 2;
  stance.corners.resize(kept);
  stance.contacts.resize(kept);
  return stance;
}

/** Half of the pulls of flat ties are on the friction cone or beside it, where the exact twin has
 to search: one in eight is enough. */
FlatTie AnyTie(TieRng& rng, const FlatStance& stance, bool fine) {
  const double cosine = 1 / std::hypot(1, stance.mu);
  const bool any = Below(rng, 4) == 0;
  for (;;) {
    FlatTie tie = fine ? MakeFineTie(rng, stance) : MakeFlatTie(rng, stance);
    const double along = -tie.gravity.dot(stance.w) / (tie.gravity.norm() * stance.w.norm());
    if (any || along > cosine + 1e-6) return tie;
  }
}

FlatStance AnyStance(TieRng& rng, bool fine) {
  return fine ? testing::RandomFineStance(rng) : testing::RandomFlatStance(rng);
}

/** Evidence that floats proposed has corners by weights on a basis; what has none counts as the
 exact twin's. */
void CountStage(const exact::ComRegionEvidence& evidence, Tally* tally) {
  const bool floats = !evidence.corners.empty() && !evidence.corners.front().base_weight.empty();
  ++(floats ? tally->fast : tally->exact);
}

std::string CheckRegionTie(TieRng& rng, const FlatStance& stance, const FlatTie& tie, long every,
                           numeric::StabilityWorkspace* workspace, Tally* tally) {
  const numeric::StabilityQuery query = QueryOf(stance, tie);
  const std::optional<FlatRegion> region = RegionOf(stance, tie);
  ++tally->cases;
  tally->tied += TruthAbout(stance, tie) == Verdict::kUndecided;
  std::string wrong;
  if (Below(rng, 4) == 0) {
    const numeric::ProvedSupportRegion claim = ProveSupportRegion(query, {}, workspace);
    CountStage(claim.proof.evidence, tally);
    wrong = claim.whole_plane || (claim.is_empty && region)
                ? "a region of the wrong kind"
                : JudgeRegion(region, claim.proof.region, claim.gap);
  } else {
    const numeric::ProvedComMargin claim = ProveComMargin(query, {}, workspace);
    CountStage(claim.proof.evidence, tally);
    wrong = JudgeComMargin(region, claim.com_m);
    if (wrong.empty()) wrong = JudgeRegion(region, claim.proof.region, HUGE_VAL);
  }
  if (!wrong.empty() || !SlowCheckIsDue(*tally, every)) return wrong;
  ++tally->checked;
  const numeric::LiftedQuery lifted = numeric::LiftCertain(query);
  const Vector3q up = Lift(Vector3d(-tie.gravity));
  const auto twin = CheckComRegion(lifted.query, up, exact::SearchComRegion(lifted.query, up));
  if (!twin) return "the exact twin's evidence does not check";
  wrong = JudgeRegion(region, *twin, exact::RegionGap(*twin));
  if (wrong.empty()) wrong = JudgeComMargin(region, exact::MarginBounds(*twin));
  return wrong.empty() ? "" : "the exact twin: " + wrong;
}

// At the right angle of a flat stance's second corner: on its bisector, or out along a side.
FlatTie KinkTie(TieRng& rng, const FlatStance& stance) {
  const Vector3d& corner = stance.corners[1];
  const Vector3d s = corner - stance.corners[0], t = stance.corners[2] - corner;
  const double reach = (1 + Below(rng, 7)) / 16.0;
  FlatTie tie;
  tie.gravity = -8 * stance.w;
  tie.com = Below(rng, 2) == 0 ? Vector3d(corner + reach * (t * (s.norm() / t.norm()) - s))
                               : Vector3d(corner + reach * s);
  tie.com += GridValue(rng, 4, 4) * stance.w + TinyStep(rng) * GridPoint(rng, 2, 4);
  return tie;
}

std::string CheckKink(const FlatStance& stance, const FlatTie& tie,
                      numeric::StabilityWorkspace* workspace, Tally* tally) {
  const numeric::StabilityQuery query = QueryOf(stance, tie);
  const auto claim = ProveComMarginGradient(query, {}, workspace);
  if (!claim) {
    ++tally->open;
    return "";
  }
  ++tally->cases;
  CountStage(claim->evidence.region, tally);
  const std::optional<FlatRegion> region = RegionOf(stance, tie);
  if (!region) return "a gradient without a region";
  const std::string wrong = JudgeComMargin(region, claim->com_m);
  return wrong.empty() ? JudgeGradient(*region, claim->com_W, claim->contact_W) : wrong;
}

// Over the hull's side where the acceleration along an axis is as large as friction lets it be.
FlatTie PushTie(TieRng& rng, const FlatStance& stance, Vector3d* d) {
  FlatTie tie = MakeFlatTie(rng, stance);
  *d = GridPoint(rng, 4, 2);
  if (stance.w.cwiseAbs().sum() != 1 || Below(rng, 4) == 0) return tie;
  int axis = 0;
  stance.w.cwiseAbs().maxCoeff(&axis);
  *d = Vector3d::Unit((axis + 1 + Below(rng, 2)) % 3) * (Below(rng, 2) == 0 ? 1 : -1);
  tie.gravity = -8 * stance.w;
  const std::size_t i = rng() % stance.corners.size();
  const Vector3d side = stance.corners[(i + 1) % stance.corners.size()] - stance.corners[i];
  const double height = (1 + Below(rng, 8)) / 8.0;
  tie.com = stance.corners[i] + Below(rng, 5) / 4.0 * side + height * (stance.w + stance.mu * *d) +
            TinyStep(rng) * GridPoint(rng, 2, 4);
  return tie;
}

std::string CheckPush(TieRng& rng, const FlatStance& stance, Tally* tally) {
  Vector3d d;
  const FlatTie tie = PushTie(rng, stance, &d);
  if (d.isZero()) return "";
  numeric::AccelerationOptions options;
  options.sides = 3 + Below(rng, 6);
  const numeric::StabilityQuery query = QueryOf(stance, tie);
  const numeric::ProvedAcceleration claim = ProveLargestAcceleration(query, d, options);
  ++tally->cases;
  ++tally->exact;
  const exact::PyramidCone inner = InscribedCone(claim.lifted.query, options.sides);
  if (!CheckDemandLimit(inner, claim.family, claim.inner)) return "a limit's proof does not check";
  return testing::FlatAcceleration(stance, tie, d).Judge(claim);
}

}  // namespace

std::string TiesOfMargins(TieRng& rng, long every, Tally* tally) {
  numeric::StabilityWorkspace workspace;
  const bool fine = Below(rng, 3) == 0;
  const FlatStance stance = AnyStance(rng, fine), thin = Thinned(rng, stance);
  std::string wrong;
  for (int k = 0; k < 8 && wrong.empty(); ++k) {
    const FlatStance& asked = k == 0 ? thin : stance;
    wrong = CheckRegionTie(rng, asked, AnyTie(rng, asked, fine), every, &workspace, tally);
  }
  for (int k = 0; k < 2 && wrong.empty() && !fine; ++k) {
    wrong = CheckKink(stance, KinkTie(rng, stance), &workspace, tally);
  }
  for (int k = 0; k < 2 && wrong.empty(); ++k) wrong = CheckPush(rng, stance, tally);
  return wrong;
}

}  // namespace cguide::fuzz
