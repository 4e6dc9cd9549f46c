#include <cmath>

#include "cguide/numeric/proved_margins.h"

namespace cguide::numeric {
namespace {

// Nothing is admissible to a normal that is off by more than its own length.
constexpr double kAnyNormal = 2;

exact::ExactContact LiftContact(const Contact& contact) {
  exact::ExactContact lifted;
  const double normal_error = NormalError(contact);
  lifted.cone.mu = Lift(contact.friction);
  lifted.cone.w = Lift(contact.n_W);
  lifted.p = Lift(contact.x_W);
  lifted.error_p = Lift(contact.error);
  const bool is_point = contact.error == 0 && contact.radius == 0;
  if (is_point && contact.normal_error == 0) return lifted;
  if (is_point && contact.normal_error < 0 && contact.distance != 0) {
    const Vector3q x = Lift(contact.x_W), y = Lift(contact.y_W);
    for (int i = 0; i < 3; ++i) {
      lifted.cone.w[i] = contact.distance > 0 ? Rational(x[i] - y[i]) : Rational(y[i] - x[i]);
    }
    return lifted;
  }
  lifted.error_w = Lift(std::isfinite(normal_error) ? normal_error : kAnyNormal);
  const Rational radius = Lift(contact.radius);
  for (int i = 0; i < 3; ++i) lifted.p[i] -= radius * lifted.cone.w[i];
  lifted.error_p += radius * lifted.error_w;
  return lifted;
}

}  // namespace

LiftedQuery LiftCertain(const StabilityQuery& query) {
  LiftedQuery lifted;
  for (std::size_t i = 0; i < query.contacts.size(); ++i) {
    if (!query.contacts[i].certain) continue;
    lifted.query.contacts.push_back(LiftContact(query.contacts[i]));
    lifted.contact.push_back(static_cast<int>(i));
  }
  lifted.query.com = Lift(query.com_W);
  lifted.query.mass = Lift(query.mass);
  lifted.query.gravity = Lift(query.gravity_W);
  lifted.query.com_error = Lift(query.com_error);
  return lifted;
}

}  // namespace cguide::numeric
