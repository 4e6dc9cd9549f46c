#include "tests/cases/stored_query.h"

#include "cguide/exact/linear_algebra.h"

namespace cguide::testing {

exact::EquilibriumQuery LiftStored(const numeric::StabilityQuery& query) {
  exact::EquilibriumQuery lifted;
  for (const numeric::Contact& c : query.contacts) {
    exact::ExactContact contact;
    contact.p = Lift(c.x_W) - exact::Scaled(Lift(c.radius), Lift(c.n_W));
    contact.cone = {Lift(c.n_W), Lift(c.friction)};
    contact.certain = c.certain;
    lifted.contacts.push_back(contact);
  }
  lifted.com = Lift(query.com_W);
  lifted.mass = Lift(query.mass);
  lifted.gravity = Lift(query.gravity_W);
  return lifted;
}

}  // namespace cguide::testing
