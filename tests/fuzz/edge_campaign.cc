#include "tests/fuzz/edge_campaign.h"

#include "cguide/exact/contact.h"
#include "cguide/verify/edge_audit.h"
#include "cguide/verify/sample_ladder.h"
#include "tests/fuzz/edge_parts.h"

namespace cguide::fuzz {
namespace {

using numeric::World;
using verify::EdgeFinding;

/** The exact twins about one instant of an edge, on its real placement of 128 bits. */
class Instant {
 public:
  Instant(const World& world, const Edge& edge, double s)
      : model_(world.model()),
        placement_(exact::PlaceRobot(world.model().robot, edge, Lift(s), 128)) {}

  Verdict Apart(const exact::PreparedModel& geometry, const numeric::Pair& pair) const {
    return pair.self ? BodyBodySeparation(geometry, placement_, pair.body, pair.other, 0).verdict
                     : BodyObjectSeparation(geometry, placement_, pair.body, pair.other, 0).verdict;
  }

  /** Contact or balance, as the model asks. */
  Verdict Supported() const {
    const exact::ContactScene scene(model_);
    const auto contacts = exact::FindContacts(scene, placement_);
    if (model_.require == GuideRequirement::kStability) {
      return DecideStability(ContactEquilibrium(scene, placement_, contacts)).verdict;
    }
    for (const auto& found : contacts) {
      if (found.contact.certain) return Verdict::kHolds;
    }
    return contacts.empty() ? Verdict::kFails : Verdict::kUndecided;
  }

 private:
  const Model& model_;
  exact::RobotPlacement placement_;
};

/** The kind of the first obstacle, which is the one that a case is about. */
std::string FirstPiece(const Model& model) {
  constexpr const char* kNames[] = {"box",  "sphere",    "cylinder", "capsule",
                                    "hull", "halfspace", "surface",  "solid"};
  return model.objects.empty() ? "" : kNames[model.objects[0].pieces[0].geometry.index()];
}

class Judge {
 public:
  Judge(const EdgeCase& given, std::uint64_t seed, const CampaignOptions& options, EdgeTally* tally)
      : case_(given), seed_(seed), options_(options), tally_(*tally), world_(given.model) {}

  std::string Run(TieRng& rng);

 private:
  Verdict Answer(const EdgeFinding& finding) const;
  std::string TestProved(const EdgeFinding& finding, TieRng& rng);
  std::string TestSamples(TieRng& rng);
  std::string TestRefuted(const EdgeFinding& finding);

  const EdgeCase& case_;
  std::uint64_t seed_;
  const CampaignOptions& options_;
  EdgeTally& tally_;
  World world_;
};

// Of collisions alone: also a mere claim that none occurs counts where one does.
Verdict Judge::Answer(const EdgeFinding& finding) const {
  if (!case_.collision_only) return VerdictOf(finding);
  const Verdict free = finding.collision.verdict;
  if (free != Verdict::kHolds || case_.truth == Verdict::kFails) return free;
  return VerdictOf(finding);
}

// Refusals name links and places, which differ from edge to edge.
std::string ReasonOf(const EdgeFinding& finding) {
  if (finding.collision.verdict != Verdict::kHolds) return "collision";
  if (finding.refusal.empty()) return finding.stability.reason;
  for (const char* what : {"keep apart", "outside the solid", "forces carry", "keeps contact"}) {
    if (finding.refusal.find(what) != std::string::npos) return "refused: " + std::string(what);
  }
  return "refused: " + finding.refusal;
}

std::string Judge::Run(TieRng& rng) {
  verify::EdgeAuditor auditor(world_);
  const EdgeFinding finding = auditor.Audit(0, case_.edge);
  const Verdict answer = Answer(finding);
  ++tally_.cases;
  tally_.kept += case_.truth == Verdict::kHolds;
  tally_.violated += case_.truth == Verdict::kFails;
  if (answer == Verdict::kUndecided) {
    ++tally_.undecided;
    ++tally_.reasons.try_emplace(ReasonOf(finding) + " (" + FirstPiece(case_.model) + ")", 0, seed_)
          .first->second.first;
    return "";
  }
  ++(answer == Verdict::kHolds ? tally_.proved : tally_.refuted);
  if (case_.truth != Verdict::kUndecided && answer != case_.truth) {
    return answer == Verdict::kHolds ? "an edge that leaves C_guide is proved"
                                     : "an edge that stays in C_guide is refuted";
  }
  if (case_.truth != Verdict::kUndecided && Below(rng, options_.share) != 0) return "";
  return answer == Verdict::kHolds ? TestProved(finding, rng) : TestRefuted(finding);
}

std::string Judge::TestProved(const EdgeFinding& finding, TieRng& rng) {
  if (!finding.proof) return "a proved edge has no proof";
  ++tally_.precise;
  check::Checker precise(world_.model(), {options_.precise_bits});
  const std::string refusal = precise.CheckEdge(case_.edge, *finding.proof);
  if (!refusal.empty()) return "a proof is refused at higher precision: " + refusal;
  return TestSamples(rng);
}

// The ladder is asked about doubles near the edge's real configuration, so that what it refutes is
// asked again of the twins at exactly s.
std::string Judge::TestSamples(TieRng& rng) {
  const verify::PreparedTwins twins(world_);
  verify::SampleLadder ladder(world_, twins);
  verify::StageCounts counts;
  for (int i = 0; i < options_.samples; ++i) {
    const double s = i < 2 ? i : test::Between(rng, 0, 1);
    ++tally_.samples;
    ladder.Place(Interpolate(case_.edge, s));
    for (const verify::PairFinding& pair : ladder.TestPairs(&counts)) {
      if (pair.verdict == Verdict::kHolds) continue;
      const Instant instant(world_, case_.edge, s);
      if (instant.Apart(twins.geometry, pair.pair) == Verdict::kFails) {
        return "a proved edge collides at s = " + std::to_string(s);
      }
    }
    const bool stability = case_.model.require == GuideRequirement::kStability;
    const Verdict verdict = ladder.TestStability(&counts).answer.verdict;
    const bool contact = !stability && !ladder.contacts().empty();
    if (verdict == Verdict::kHolds || contact) continue;
    if (Instant(world_, case_.edge, s).Supported() == Verdict::kFails) {
      return "a proved edge has no support at s = " + std::to_string(s);
    }
  }
  return "";
}

std::string Judge::TestRefuted(const EdgeFinding& finding) {
  if (finding.collision.verdict == Verdict::kFails) {
    const Instant instant(world_, case_.edge, finding.collision.s);
    const exact::PreparedModel geometry = exact::PrepareModel(world_.model());
    return instant.Apart(geometry, finding.collision.pair) == Verdict::kHolds
               ? "a pair that keeps apart is said to meet"
               : "";
  }
  const Instant instant(world_, case_.edge, finding.stability.s);
  return instant.Supported() == Verdict::kHolds ? "support is denied where there is some" : "";
}

}  // namespace

std::string JudgeEdge(const EdgeKind& kind, std::uint64_t seed, const CampaignOptions& options,
                      EdgeTally* tally) {
  TieRng rng(seed);
  const std::optional<EdgeCase> made = kind.make(rng);
  if (!made) {
    ++tally->unmade;
    return "";
  }
  std::string wrong = Judge(*made, seed, options, tally).Run(rng);
  tally->wrong += !wrong.empty();
  return wrong;
}

}  // namespace cguide::fuzz
