#include <algorithm>
#include <cmath>
#include <utility>

#include "cguide/exact/equilibrium.h"
#include "cguide/numeric/stability_contacts_internal.h"

namespace cguide::numeric {
namespace {

// Point sites whose numbers carry no error: p = x, and w = x - y (or n where it is said to be
// exact).
bool IsExact(const Contact& contact) {
  return contact.error == 0 && contact.radius == 0 && contact.normal_error <= 0;
}

bool IsExact(const StabilityQuery& query) {
  return query.com_error == 0 &&
         std::all_of(query.contacts.begin(), query.contacts.end(),
                     [](const Contact& contact) { return IsExact(contact); });
}

exact::ExactContact LiftContact(const Contact& contact) {
  exact::ExactContact lifted;
  lifted.p = Lift(contact.force_point_W());
  lifted.cone.mu = Lift(contact.friction);
  lifted.cone.w = Lift(contact.n_W);
  if (IsExact(contact) && contact.normal_error < 0 && contact.distance != 0) {
    const Vector3q x = Lift(contact.x_W), y = Lift(contact.y_W);
    for (int i = 0; i < 3; ++i) {
      lifted.cone.w[i] = contact.distance > 0 ? Rational(x[i] - y[i]) : Rational(y[i] - x[i]);
    }
  }
  return lifted;
}

// The first `count` scaled contacts, so that indices agree.
exact::EquilibriumQuery LiftQuery(const StabilityQuery& query, const ScaledContacts& scaled,
                                  int count) {
  exact::EquilibriumQuery lifted;
  for (int i = 0; i < count; ++i) {
    lifted.contacts.push_back(LiftContact(query.contacts[scaled.index[i]]));
  }
  lifted.com = Lift(query.com_W);
  lifted.mass = Lift(query.mass);
  lifted.gravity = Lift(query.gravity_W);
  return lifted;
}

Generator ToGenerator(const ScaledContacts& scaled, int contact, const Eigen::Vector3d& u) {
  Generator generator;
  generator.contact = contact;
  generator.u = u;
  const Eigen::Vector3d r = scaled.arm(contact);
  generator.wrench << u, r[1] * u[2] - r[2] * u[1], r[2] * u[0] - r[0] * u[2],
      r[0] * u[1] - r[1] * u[0];
  return generator;
}

// Six of the forces as a base, by elimination with the largest pivots, the rest as extra columns.
bool ToBalance(const ScaledContacts& scaled, const std::vector<exact::ContactForce>& forces,
               Balance* balance) {
  std::vector<std::pair<Generator, double>> columns;
  for (const exact::ContactForce& force : forces) {
    const Eigen::Vector3d f(NearestDouble(force.f[0]), NearestDouble(force.f[1]),
                            NearestDouble(force.f[2]));
    const double along = f.dot(scaled.normal(force.contact));
    if (!(along > 0)) continue;
    columns.emplace_back(ToGenerator(scaled, force.contact, f / along), along / scaled.v_scale);
  }
  if (columns.size() < 6 || columns.size() > 12) return false;
  Matrix6d& inverse = balance->base_inverse;
  inverse.setIdentity();
  for (int row = 0; row < 6; ++row) {
    const auto pivot = [&](const auto& column) {
      return std::abs(inverse.row(row).dot(column.first.wrench));
    };
    const auto best = std::max_element(columns.begin(), columns.end(),
                                       [&](auto& a, auto& b) { return pivot(a) < pivot(b); });
    if (!(pivot(*best) > 0)) return false;
    const Vector6d alpha = inverse * best->first.wrench;
    const Eigen::Matrix<double, 1, 6> pivot_row = inverse.row(row) / alpha[row];
    for (int k = 0; k < 6; ++k) {
      if (k != row) inverse.row(k) -= alpha[k] * pivot_row;
    }
    inverse.row(row) = pivot_row;
    balance->base[row] = best->first;
    balance->weight[row] = best->second;
    columns.erase(best);
  }
  balance->num_extra = 0;
  for (const auto& [generator, weight] : columns) {
    balance->extra[balance->num_extra] = generator;
    balance->extra_weight[balance->num_extra++] = weight;
  }
  return true;
}

// y in the metres of the query, scaled to a largest entry near 1, which is exact up to rounding to
// double.
Vector6d ToDoubles(const Vector6q& y) {
  Rational largest = 0;
  for (const Rational& x : y) largest = std::max(largest, Rational(abs(x)));
  Vector6d rounded;
  for (int i = 0; i < 6; ++i) rounded[i] = NearestDouble(Rational(y[i] / largest));
  return rounded;
}

SettledStability Undecided(std::string reason) {
  SettledStability settled;
  settled.reason = std::move(reason);
  return settled;
}

SettledStability Settle(const StabilityQuery& query, const exact::StabilityResult& result,
                        StabilityWorkspace* workspace) {
  const ScaledContacts& scaled = workspace->scratch->contacts;
  Balance& balance = workspace->scratch->balance;
  SettledStability settled;
  settled.stage = StabilityStage::kExact;
  settled.answer.verdict = result.verdict;
  bool survives = IsExact(query);
  if (result.verdict == Verdict::kHolds) {
    const bool fits = ToBalance(scaled, result.forces, &balance);
    if (fits && ProveInterior(scaled, &balance)) survives = true;
    if (fits) ReportBalance(scaled, balance, &settled.answer.forces);
  } else {
    settled.answer.separator.y = ToDoubles(result.separator);
    Vector6d y = settled.answer.separator.y;
    y.tail<3>() *= scaled.length;
    if (ProveOutside(scaled, y)) survives = true;
  }
  if (survives) return settled;
  return Undecided(result.verdict == Verdict::kHolds
                       ? "stable as stored, but by less than the error of the contacts"
                       : "unstable as stored, but by less than the error of the contacts");
}

}  // namespace

SettledStability Stability(const StabilityQuery& query, StabilityWorkspace* workspace) {
  SettledStability settled;
  settled.answer = TryStability(query, workspace);
  settled.stage = StabilityStage::kFast;
  if (settled.answer.verdict != Verdict::kUndecided) return settled;
  ScaledContacts& scaled = workspace->scratch->contacts;
  if (!ScaleContacts(query, &scaled))
    return Undecided("a number is not finite or mass or gravity is zero");
  for (const Contact& contact : query.contacts) {
    if (contact.n_W.isZero(0)) return Undecided("a contact has no normal");
  }
  exact::StabilityResult result =
      exact::DecideStability(LiftQuery(query, scaled, scaled.num_certain));
  const bool more = scaled.num_certain < scaled.count;
  if (result.verdict != Verdict::kHolds && more) {
    // The certain contacts do not carry the robot; only a refutation with all of them counts now.
    result = exact::DecideStability(LiftQuery(query, scaled, scaled.count));
    if (result.verdict != Verdict::kFails) {
      return Undecided("depends on contacts that may or may not be active");
    }
  }
  if (result.verdict == Verdict::kUndecided) return Undecided(exact::Describe(result));
  return Settle(query, result, workspace);
}

}  // namespace cguide::numeric
