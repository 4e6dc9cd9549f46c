#include "cguide/numeric/stability_ladder.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace cguide::numeric {
namespace {

Eigen::Vector3d ToDoubles(const Vector3q& v) {
  return {NearestDouble(v[0]), NearestDouble(v[1]), NearestDouble(v[2])};
}

/** For people and for the float margins. The errors are rounded up and hold for the doubles too. */
Contact Rounded(const exact::FoundContact& found, const Model& model) {
  Contact contact;
  contact.site = found.site;
  contact.body = found.body;
  contact.object = found.object;
  contact.x_W = ToDoubles(found.x);
  contact.y_W = ToDoubles(found.y);
  contact.n_W = ToDoubles(found.contact.cone.w).normalized();
  contact.radius = model.sites[found.site].radius;
  contact.distance = NearestDouble(found.distance);
  contact.friction = NearestDouble(found.contact.cone.mu);
  const double magnitude =
      contact.x_W.lpNorm<1>() + contact.y_W.lpNorm<1>() + std::abs(contact.distance);
  contact.error =
      RoundUp(found.error_x + found.error_y + found.error_distance) + 0x1p-52 * magnitude;
  contact.certain = found.contact.certain;
  return contact;
}

/** The largest error in metres of what the equilibrium is decided from. */
double WidthOf(const exact::EquilibriumQuery& query,
               const std::vector<exact::FoundContact>& contacts) {
  Rational width = query.com_error;
  for (const exact::FoundContact& found : contacts) {
    width = std::max({width, found.contact.error_p, found.error_x});
  }
  return RoundUp(width);
}

double WidthOf(const StabilityQuery& query) {
  double width = query.com_error;
  for (const Contact& contact : query.contacts) width = std::max(width, contact.error);
  return width;
}

std::string Reason(const exact::StabilityResult& result, const LadderedStability& ladder) {
  std::string text = exact::Describe(result);
  const bool sure = std::all_of(ladder.contacts.begin(), ladder.contacts.end(),
                                [](const Contact& contact) { return contact.certain; });
  if (!sure) text = "depends on contacts that may or may not be active";
  if (ladder.width == 0) return text;
  char known[64];
  std::snprintf(known, sizeof known, " (contacts and centre of mass known to %.1e m)",
                ladder.width);
  return text + known;
}

/** The sum of the forces of each contact, as a multiple of a direction with u.n = 1. */
std::vector<WitnessForce> SumForces(const exact::StabilityResult& result,
                                    const std::vector<Contact>& contacts) {
  std::vector<Vector3q> sums(contacts.size(), Vector3q(Vector3q::Zero()));
  for (const exact::ContactForce& force : result.forces) sums[force.contact] += force.f;
  std::vector<WitnessForce> forces;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Eigen::Vector3d f = ToDoubles(sums[i]);
    const double along = f.dot(contacts[i].n_W);
    if (along > 0) forces.push_back({static_cast<int>(i), f / along, along});
  }
  return forces;
}

void SetSeparator(const exact::StabilityResult& result, SeparatingWrench* separator) {
  Rational largest = 0;
  for (const Rational& x : result.separator) largest = std::max(largest, Rational(abs(x)));
  if (largest == 0) return;
  for (int i = 0; i < 6; ++i) {
    separator->y[i] = NearestDouble(Rational(result.separator[i] / largest));
  }
}

/** A proved tie of data without error. */
bool IsBoundary(const LadderedStability& ladder) {
  using Reason = exact::StabilityReason;
  return ladder.width == 0 && ladder.exact &&
         (ladder.exact->reason == Reason::kBoundary || ladder.exact->reason == Reason::kRank);
}

/** A proved tie says why: forces that balance, and at rank 6 the wrench that supports the cone. It
 is none of the contacts alone that are certain where others may be active. */
void ReportTie(LadderedStability* ladder) {
  const bool sure = std::all_of(ladder->contacts.begin(), ladder->contacts.end(),
                                [](const Contact& contact) { return contact.certain; });
  if (ladder->answer.verdict != Verdict::kUndecided || !sure || !IsBoundary(*ladder)) return;
  ladder->forces = SumForces(*ladder->exact, ladder->contacts);
  SetSeparator(*ladder->exact, &ladder->answer.separator);
}

/** No finer placement can change an undecided answer about data without error. */
bool IsFinal(const LadderedStability& ladder) {
  return ladder.answer.verdict != Verdict::kUndecided || ladder.width == 0;
}

LadderedStability FromStored(SettledStability settled, const StabilityQuery& query) {
  LadderedStability result;
  result.answer = std::move(settled.answer);
  result.rung = settled.stage == StabilityStage::kFast    ? StabilityRung::kFast
                : settled.stage == StabilityStage::kExact ? StabilityRung::kStored
                                                          : StabilityRung::kUndecided;
  result.reason = std::move(settled.reason);
  result.contacts.assign(query.contacts.begin(), query.contacts.end());
  result.forces.assign(result.answer.forces.begin(), result.answer.forces.end());
  result.width = WidthOf(query);
  result.exact = std::move(settled.exact);
  ReportTie(&result);
  return result;
}

}  // namespace

StabilityLadder::StabilityLadder(const World& world) : world_(&world) {
  if (world.model().contact.model == ContactModel::kSites) scene_.emplace(world.model());
}

LadderedStability StabilityLadder::DecideAt(const Configuration& q, int bits, int max_sides) const {
  Require(scene_.has_value(), "nearest-pair contacts have no exact twin");
  const Model& model = world_->model();
  const exact::RobotPlacement placement = exact::PlaceRobot(model.robot, q, bits);
  // Roots a little finer than the placement: their errors do not matter beside its own.
  const auto found = exact::FindContacts(*scene_, placement, {bits + 64});
  const exact::EquilibriumQuery query = exact::ContactEquilibrium(*scene_, placement, found);
  exact::StabilityResult decided = exact::DecideStability(query, {max_sides});
  LadderedStability result;
  for (const exact::FoundContact& contact : found) {
    result.contacts.push_back(Rounded(contact, model));
  }
  result.width = WidthOf(query, found);
  result.answer.verdict = decided.verdict;
  if (decided.verdict == Verdict::kUndecided) {
    result.reason = Reason(decided, result);
  } else {
    result.rung = bits > 106 ? StabilityRung::kBits256 : StabilityRung::kBits106;
    result.forces = SumForces(decided, result.contacts);
    SetSeparator(decided, &result.answer.separator);
  }
  result.exact = std::move(decided);
  ReportTie(&result);
  return result;
}

LadderedStability StabilityLadder::Decide(const Configuration& q, GuideWorkspace* workspace) const {
  FindContacts(*world_, &workspace->geometry, &workspace->contacts);
  const StabilityQuery query = PlacedQuery(*world_, *workspace);
  // Stored contacts with errors are worth no exact decision where better ones can be had.
  if (scene_ && WidthOf(query) > 0) {
    SettledStability fast;
    fast.answer = TryStability(query, &workspace->stability);
    if (fast.answer.verdict != Verdict::kUndecided) {
      fast.stage = StabilityStage::kFast;
      return FromStored(std::move(fast), query);
    }
  } else {
    LadderedStability result = FromStored(Stability(query, &workspace->stability), query);
    if (IsFinal(result) || !scene_) return result;
  }
  // What is left is mostly near the edge of the support, which the coarsest pyramids see as well as
  // any: the finest are kept for the last rung.
  LadderedStability result = DecideAt(q, 106, 8);
  if (result.answer.verdict == Verdict::kUndecided && !IsBoundary(result)) {
    result = DecideAt(q, 256, 64);
  }
  return result;
}

}  // namespace cguide::numeric
