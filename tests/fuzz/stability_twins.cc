#include "cguide/exact/equilibrium.h"
#include "cguide/numeric/stability.h"
#include "tests/fuzz/twins.h"
#include "tests/numeric/stability_exact.h"

namespace cguide::fuzz {
namespace {

using numeric::Contact;

Contact PointContact(ByteStream& in) {
  Contact contact;
  contact.x_W = in.Point();
  const int axis = in.Below(3);
  contact.n_W = Eigen::Vector3d::Unit(axis) * (in.Below(5) == 0 ? -1.0 : 1.0);
  contact.normal_error = 0;
  contact.distance = 0.02;
  contact.y_W = contact.x_W - 0.02 * contact.n_W;
  contact.friction = 0.25 * in.Below(5);
  contact.certain = in.Below(8) != 0;
  return contact;
}

/** The exact query that the stored numbers pose. */
exact::EquilibriumQuery Lifted(const numeric::StabilityQuery& query) {
  exact::EquilibriumQuery lifted;
  for (const Contact& c : query.contacts) {
    exact::ExactContact contact;
    contact.p = Lift(c.x_W);
    contact.cone = {Lift(c.n_W), Lift(c.friction)};
    contact.certain = c.certain;
    lifted.contacts.push_back(contact);
  }
  lifted.com = Lift(query.com_W);
  lifted.mass = Lift(query.mass);
  lifted.gravity = Lift(query.gravity_W);
  return lifted;
}

}  // namespace

std::string CheckStability(ByteStream& in, bool thorough, Tally* tally) {
  std::vector<Contact> contacts;
  const int count = in.Below(9);
  for (int i = 0; i < count; ++i) contacts.push_back(PointContact(in));
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
  const exact::EquilibriumQuery lifted = Lifted(query);
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
