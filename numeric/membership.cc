#include "cguide/numeric/membership.h"

#include <algorithm>

namespace cguide::numeric {
namespace {

Membership TestContact(const std::vector<Contact>& contacts) {
  const bool sure = std::any_of(contacts.begin(), contacts.end(),
                                [](const Contact& contact) { return contact.certain; });
  if (sure) return {};
  const Verdict verdict = contacts.empty() ? Verdict::kFails : Verdict::kUndecided;
  return {verdict, Obstruction::kNoContact, {}};
}

}  // namespace

StabilityQuery PlacedQuery(const World& world, const GuideWorkspace& workspace) {
  StabilityQuery query;
  query.contacts = workspace.contacts;
  query.com_W = workspace.geometry.state.com_W;
  query.com_error = workspace.geometry.state.com_error;
  query.mass = world.tree().mass;
  query.gravity_W = world.model().gravity;
  query.generators = world.model().contact.generators;
  return query;
}

StabilityAnswer TestPlacedStability(const World& world, GuideWorkspace* workspace, Recall recall) {
  FindContacts(world, &workspace->geometry, &workspace->contacts);
  const StabilityQuery query = PlacedQuery(world, *workspace);
  return recall == Recall::kMemory ? TryStability(query, &workspace->memory, &workspace->stability)
                                   : TryStability(query, &workspace->stability);
}

Membership TestConfiguration(const World& world, const Configuration& q, Space space,
                             GuideWorkspace* workspace, Recall recall) {
  if (!WithinLimits(world.tree(), q)) return {Verdict::kFails, Obstruction::kLimits, {}};
  Place(world, q, &workspace->geometry);
  const FreeAnswer free = TestFree(world, &workspace->geometry);
  if (free.verdict != Verdict::kHolds) return {free.verdict, Obstruction::kCollision, free.first};
  if (space == Space::kFree) return {};
  if (world.model().require == GuideRequirement::kContact) {
    FindContacts(world, &workspace->geometry, &workspace->contacts);
    return TestContact(workspace->contacts);
  }
  const Verdict stable = TestPlacedStability(world, workspace, recall).verdict;
  if (stable == Verdict::kHolds) return {};
  return {stable, Obstruction::kUnstable, {}};
}

}  // namespace cguide::numeric
