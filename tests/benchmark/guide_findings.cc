#include "tests/benchmark/guide_findings.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "cguide/numeric/margins.h"
#include "cguide/numeric/sampled_edge.h"

namespace cguide::benchmark {
namespace {

using numeric::Contact;

constexpr double kScan = 1e-4;  // of s: gaps in a violation shorter than this are not seen
constexpr int kLooks = 64;      // samples of a violation for its depth
constexpr int kSides = 12;      // of the pyramids that forces are measured with

struct Stretch {
  double first = 0;
  double last = 0;
};

/** The stretch around s on which `bad` holds: scanned outwards, its ends bisected. */
Stretch StretchAround(double s, const std::function<bool(double)>& bad) {
  const auto end = [&](double step, double limit) {
    double in = s, out = s;
    do {
      in = out;
      if (in == limit) return in;
      out = step > 0 ? std::min(limit, in + step) : std::max(limit, in + step);
    } while (bad(out));
    for (int i = 0; i < 40; ++i) {
      const double middle = in + 0.5 * (out - in);
      (bad(middle) ? in : out) = middle;
    }
    return in;
  };
  return {end(-kScan, 0), end(kScan, 1)};
}

Model Changed(Model model, double epsilon_factor, double friction_factor) {
  model.contact.epsilon *= epsilon_factor;
  for (Object& object : model.objects) object.friction *= friction_factor;
  return model;
}

std::string Reason(const verify::EdgeFinding& finding) {
  if (finding.collision.verdict != Verdict::kHolds) return "two bodies are too near to tell";
  return finding.refusal.empty() ? finding.stability.reason : "the checker: " + finding.refusal;
}

double Gap(const Contact& contact) { return contact.distance - contact.radius; }

}  // namespace

struct GuideJudge::State {
  explicit State(const Model& model)
      : world(model),
        raised(Changed(model, 1.1, 1.1)),
        wide(Changed(model, 2, 1)),
        auditor(world),
        collision(world),
        stability(world),
        raised_stability(raised),
        look(world),
        wide_look(wide) {}

  bool Meets(const Edge& edge, double s, const numeric::Pair& pair, double* depth);
  bool Unstable(const Edge& edge, double s);
  EdgeFault MeasurePenetration(const Edge& edge, const verify::EdgeCollision& found);
  EdgeFault MeasureBalance(const Edge& edge, double s);
  double MissingBand(const Edge& edge, double s);
  void JudgeFaults(const Edge& edge, EdgeJudgement* judgement);

  numeric::World world, raised, wide;
  verify::EdgeAuditor auditor;
  verify::EdgeWorkspace collision;
  verify::StabilityEdgeWorkspace stability, raised_stability;
  numeric::GuideWorkspace look, wide_look;
};

GuideJudge::GuideJudge(const Model& model) : state_(std::make_unique<State>(model)) {}
GuideJudge::~GuideJudge() = default;
const numeric::World& GuideJudge::world() const { return state_->world; }

EdgeJudgement GuideJudge::Judge(const Edge& edge) {
  EdgeJudgement judgement;
  const verify::EdgeFinding finding = state_->auditor.Audit(0, edge);
  judgement.verdict = VerdictOf(finding);
  if (judgement.verdict == Verdict::kUndecided) judgement.reason = Reason(finding);
  judgement.within_limits = numeric::WithinLimits(state_->world.tree(), edge.from) &&
                            numeric::WithinLimits(state_->world.tree(), edge.to);
  if (judgement.verdict == Verdict::kFails) state_->JudgeFaults(edge, &judgement);
  return judgement;
}

bool GuideJudge::FailsSampled(const Edge& edge, double step) {
  const int count = numeric::SampleCount(edge, step);
  for (int i = 0; i <= count; ++i) {
    const Configuration q = Interpolate(edge, static_cast<double>(i) / count);
    const auto answer = TestConfiguration(state_->world, q, numeric::Space::kGuide, &state_->look);
    if (answer.verdict == Verdict::kFails) return true;
  }
  return false;
}

// The audit stops at a collision; whether balance is lost as well is asked here.
void GuideJudge::State::JudgeFaults(const Edge& edge, EdgeJudgement* judgement) {
  const auto free = DecideEdgeCollision(world, edge, {}, &collision);
  if (free.verdict == Verdict::kFails) {
    judgement->faults.push_back(MeasurePenetration(edge, free));
  }
  const auto stable = DecideEdgeStability(world, edge, {}, &stability);
  if (stable.verdict != Verdict::kFails) return;
  EdgeFault fault = MeasureBalance(edge, stable.s);
  const auto still = DecideEdgeStability(raised, edge, {}, &raised_stability);
  fault.hard = still.verdict == Verdict::kFails;
  judgement->faults.push_back(fault);
}

bool GuideJudge::State::Meets(const Edge& edge, double s, const numeric::Pair& pair,
                              double* depth) {
  Place(world, Interpolate(edge, s), &look.geometry);
  const auto clearance = PairClearance(world, pair, INFINITY, &look.geometry);
  if (clearance.overlap) *depth = std::max(*depth, clearance.depth);
  return clearance.overlap;
}

// More contact and more friction cure no collision: every penetration is hard.
EdgeFault GuideJudge::State::MeasurePenetration(const Edge& edge,
                                                const verify::EdgeCollision& found) {
  EdgeFault fault{Fault::kPenetration, true, found.s};
  const auto bad = [&](double s) { return Meets(edge, s, found.pair, &fault.depth); };
  const Stretch stretch = StretchAround(found.s, bad);
  fault.length = stretch.last - stretch.first;
  for (int i = 0; i <= kLooks; ++i) bad(stretch.first + fault.length * i / kLooks);
  return fault;
}

bool GuideJudge::State::Unstable(const Edge& edge, double s) {
  Place(world, Interpolate(edge, s), &look.geometry);
  return TestPlacedStability(world, &look).verdict == Verdict::kFails;
}

EdgeFault GuideJudge::State::MeasureBalance(const Edge& edge, double witness) {
  EdgeFault fault{Fault::kLostContact, false, witness};
  const Stretch stretch = StretchAround(witness, [&](double s) { return Unstable(edge, s); });
  fault.length = stretch.last - stretch.first;
  double worst = witness;
  for (int i = -1; i <= kLooks; ++i) {
    const double s = i < 0 ? witness : stretch.first + fault.length * i / kLooks;
    if (!Unstable(edge, s) && i >= 0) continue;
    const auto margin =
        numeric::FindComMargin(PlacedQuery(world, look), {1e-6, 60}, &look.stability);
    if (-margin.hi > fault.com_short) {
      fault.com_short = -margin.hi;
      worst = s;
    }
    fault.depth = std::max(fault.depth, MissingBand(edge, s));
  }
  if (!std::isfinite(fault.depth)) fault.kind = Fault::kLostBalance;
  Unstable(edge, worst);
  numeric::StabilityQuery query = PlacedQuery(world, look);
  query.generators = kSides;
  fault.force_short = std::max(0.0, -ForceMargin(query) * query.mass * query.gravity_W.norm());
  return fault;
}

/** By how much epsilon would have to grow for balance at s, at most by epsilon; else infinite. */
double GuideJudge::State::MissingBand(const Edge& edge, double s) {
  Place(wide, Interpolate(edge, s), &wide_look.geometry);
  FindContacts(wide, &wide_look.geometry, &wide_look.contacts);
  auto& contacts = wide_look.contacts;
  std::sort(contacts.begin(), contacts.end(),
            [](const Contact& a, const Contact& b) { return Gap(a) < Gap(b); });
  numeric::StabilityQuery query = PlacedQuery(wide, wide_look);
  for (std::size_t n = 1; n <= contacts.size(); ++n) {
    const double missing = Gap(contacts[n - 1]) - world.model().contact.epsilon;
    if (missing <= 0) continue;
    query.contacts = std::span(contacts).first(n);
    if (TryStability(query, &wide_look.stability).verdict == Verdict::kHolds) return missing;
  }
  return INFINITY;
}

}  // namespace cguide::benchmark
