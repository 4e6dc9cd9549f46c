#include "cguide/verify/sampled_audit.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/margins.h"
#include "cguide/numeric/sampled_edge.h"
#include "cguide/verify/sample_ladder.h"

namespace cguide::verify {
namespace {

using numeric::Obstruction;
using numeric::World;

/** Bodies and objects in contact. */
using Touching = std::set<std::pair<int, int>>;

// What the samples of one edge showed.
struct EdgeAudit {
  long samples = 0;
  StageCounts collision;
  StageCounts stability;
  Extreme clearance, contact_gap, com_margin, force_margin;
  long contacts_made = 0, contacts_broken = 0;
  std::optional<Touching> first, last;  ///< at its first and its last sample
  std::vector<Violation> violations;
};

/** Adds to `count` how many of `these` are not among `others`. */
void CountOthers(const Touching& these, const Touching& others, long* count) {
  for (const auto& pair : these) *count += others.count(pair) == 0;
}

void KeepSmallest(double value, const Instant& at, const numeric::Pair& pair, Extreme* extreme) {
  if (extreme->known && !(value < extreme->value)) return;
  *extreme = {true, value, at, pair};
}

void KeepLargest(double value, const Instant& at, Extreme* extreme) {
  if (extreme->known && !(value > extreme->value)) return;
  *extreme = {true, value, at, {}};
}

bool SameKind(const Violation& a, const Violation& b) {
  return a.kind == b.kind && a.verdict == b.verdict && a.pair == b.pair;
}

// Joins the sample's findings to violations that were open at the sample before it.
void JoinViolations(std::vector<Violation> found, double s, double spacing, double previous_s,
                    std::vector<Violation>* all) {
  for (Violation& v : found) {
    auto open = std::find_if(all->rbegin(), all->rend(), [&](const Violation& w) {
      return SameKind(v, w) && w.s_last == previous_s;
    });
    if (open == all->rend()) {
      v.length = spacing;
      all->push_back(std::move(v));
      continue;
    }
    open->s_last = s;
    ++open->samples;
    open->length += spacing;
    const bool deeper = v.depth < 0 ? open->depth >= 0 : open->depth >= 0 && v.depth > open->depth;
    if (deeper) {
      open->depth = v.depth;
      open->s_worst = s;
      open->separator = v.separator;
    }
  }
}

class EdgeAuditor {
 public:
  EdgeAuditor(const World& world, SampleLadder* ladder) : world_(world), ladder_(*ladder) {}

  EdgeAudit Audit(const Edge& edge, int index, int first, int count) {
    const double spacing = count == 0 ? 0 : Distance(edge.from, edge.to) / count;
    double previous_s = -1;
    for (int i = first; i <= count; ++i) {
      const double s = count == 0 ? 0 : static_cast<double>(i) / count;
      AuditSample(Interpolate(edge, s), {index, s}, spacing, previous_s);
      previous_s = s;
    }
    return std::move(result_);
  }

 private:
  void AuditSample(const Configuration& q, const Instant& at, double spacing, double previous_s) {
    ++result_.samples;
    found_.clear();
    ladder_.Place(q);
    if (!numeric::WithinLimits(world_.tree(), q)) Report(at, Obstruction::kLimits, Verdict::kFails);
    AuditPairs(at);
    AuditContacts(at);
    JoinViolations(std::move(found_), at.s, spacing, previous_s, &result_.violations);
  }

  Violation& Report(const Instant& at, Obstruction kind, Verdict verdict) {
    Violation v;
    v.kind = kind;
    v.verdict = verdict;
    v.edge = at.edge;
    v.s_first = v.s_last = v.s_worst = at.s;
    v.samples = 1;
    found_.push_back(v);
    return found_.back();
  }

  void AuditPairs(const Instant& at) {
    const auto pairs = ladder_.TestPairs(&result_.collision);
    for (const PairFinding& finding : pairs) {
      Violation& v = Report(at, Obstruction::kCollision, finding.verdict);
      v.pair = finding.pair;
      v.depth = finding.depth;
      KeepSmallest(-finding.depth, at, finding.pair, &result_.clearance);
    }
    const double cutoff =
        result_.clearance.known ? std::max(0.0, result_.clearance.value) : INFINITY;
    const auto nearest = ladder_.NearestPair(cutoff);
    if (nearest) KeepSmallest(nearest->depth, at, nearest->pair, &result_.clearance);
  }

  void AuditContacts(const Instant& at) {
    const bool only_contact = world_.model().require == GuideRequirement::kContact;
    const numeric::LadderedStability settled = ladder_.TestStability(&result_.stability);
    const numeric::StabilityAnswer& stable = settled.answer;
    NoteContacts();
    double gap = INFINITY;
    for (const numeric::Contact& contact : ladder_.contacts()) {
      gap = std::min(gap, contact.distance - contact.radius);
    }
    if (std::isfinite(gap)) KeepLargest(gap, at, &result_.contact_gap);
    if (only_contact) {
      const bool sure = std::any_of(ladder_.contacts().begin(), ladder_.contacts().end(),
                                    [](const numeric::Contact& c) { return c.certain; });
      const bool none = ladder_.contacts().empty();
      if (!sure) Report(at, Obstruction::kNoContact, none ? Verdict::kFails : Verdict::kUndecided);
      return;
    }
    const double margin = ladder_.ComMargin();
    KeepSmallest(margin, at, {}, &result_.com_margin);
    KeepSmallest(ladder_.ForceMargin(), at, {}, &result_.force_margin);
    if (stable.verdict == Verdict::kHolds) return;
    Violation& v = Report(at, Obstruction::kUnstable, stable.verdict);
    v.depth = std::isfinite(margin) ? std::max(0.0, -margin) : -1;
    v.separator = stable.separator;
    v.reason = settled.reason;
  }

  void NoteContacts() {
    Touching now;
    for (const numeric::Contact& c : ladder_.contacts()) now.emplace(c.body, c.object);
    if (!result_.first) result_.first = now;
    if (result_.last) {
      CountOthers(now, *result_.last, &result_.contacts_made);
      CountOthers(*result_.last, now, &result_.contacts_broken);
    }
    result_.last = std::move(now);
  }

  const World& world_;
  SampleLadder& ladder_;
  EdgeAudit result_;
  std::vector<Violation> found_;
};

void Merge(const EdgeAudit& edge, SampledAudit* all) {
  ++all->edges_done;
  all->samples += edge.samples;
  all->collision.Add(edge.collision);
  all->stability.Add(edge.stability);
  all->contacts_made += edge.contacts_made;
  all->contacts_broken += edge.contacts_broken;
  const auto smallest = [](const Extreme& e, Extreme* x) {
    if (e.known) KeepSmallest(e.value, e.at, e.pair, x);
  };
  smallest(edge.clearance, &all->clearance);
  smallest(edge.com_margin, &all->com_margin);
  smallest(edge.force_margin, &all->force_margin);
  if (edge.contact_gap.known) {
    KeepLargest(edge.contact_gap.value, edge.contact_gap.at, &all->contact_gap);
  }
  for (const Violation& v : edge.violations) {
    all->violations.push_back(v);
    if (v.verdict == Verdict::kFails) all->verdict = Verdict::kFails;
    if (v.verdict == Verdict::kUndecided && all->verdict == Verdict::kHolds) {
      all->verdict = Verdict::kUndecided;
    }
  }
}

}  // namespace

void StageCounts::Add(const StageCounts& other) {
  fast += other.fast;
  exact += other.exact;
  bits_106 += other.bits_106;
  bits_256 += other.bits_256;
  undecided += other.undecided;
}

SampledAudit AuditSamples(const World& world, const Path& path,
                          const SampledAuditOptions& options) {
  CheckPath(path, world.model().robot);
  Require(options.step > 0, "the sampling step must be positive");
  SampledAudit all;
  all.step = options.step;
  all.edges = std::max(1, static_cast<int>(path.waypoints.size()) - 1);
  const PreparedTwins twins(world);
  std::vector<EdgeAudit> edges(static_cast<std::size_t>(all.edges));
  std::vector<char> done(edges.size(), 0);
  tbb::enumerable_thread_specific<SampleLadder> ladders([&] { return SampleLadder(world, twins); });
  std::mutex progress;
  int finished = 0;
  const auto audit_edge = [&](int i) {
    if (options.interrupt && *options.interrupt) return;
    const auto at = static_cast<std::size_t>(i);
    const bool lone = path.waypoints.size() == 1;
    const Edge edge{path.waypoints[at], path.waypoints[lone ? at : at + 1]};
    const int count = lone ? 0 : numeric::SampleCount(edge, options.step);
    // The end of an edge is the start of the next one and is tested once.
    edges[at] = EdgeAuditor(world, &ladders.local()).Audit(edge, i, i == 0 ? 0 : 1, count);
    done[at] = 1;
    const std::lock_guard lock(progress);
    if (options.on_progress) options.on_progress(++finished, all.edges);
  };
  tbb::task_arena arena(std::max(1, options.threads));
  arena.execute([&] { tbb::parallel_for(0, all.edges, audit_edge); });
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (!done[i]) continue;
    Merge(edges[i], &all);
    if (i == 0 || !done[i - 1] || !edges[i].first || !edges[i - 1].last) continue;
    CountOthers(*edges[i].first, *edges[i - 1].last, &all.contacts_made);
    CountOthers(*edges[i - 1].last, *edges[i].first, &all.contacts_broken);
  }
  all.done = std::move(done);
  for (std::size_t i = 1; i < path.waypoints.size(); ++i) {
    all.length += Distance(path.waypoints[i - 1], path.waypoints[i]);
  }
  if (all.edges_done < all.edges && all.verdict == Verdict::kHolds) {
    all.verdict = Verdict::kUndecided;
  }
  return all;
}

}  // namespace cguide::verify
