#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "cguide/exact/equilibrium.h"
#include "cguide/numeric/round_simplex_internal.h"
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
  columns.reserve(forces.size());
  for (const exact::ContactForce& force : forces) {
    const Eigen::Vector3d f(force.f[0].get_d(), force.f[1].get_d(), force.f[2].get_d());
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

// y in the metres of the query, each entry rounded to double, times a power of two that brings the
// largest near 1.
Vector6d ToDoubles(const Vector6q& y) {
  const auto bits = [](const mpz_class& x) {
    return static_cast<long>(mpz_sizeinbase(x.get_mpz_t(), 2));
  };
  long highest = std::numeric_limits<long>::min();
  for (const Rational& x : y) {
    if (x != 0) highest = std::max(highest, bits(x.get_num()) - bits(x.get_den()));
  }
  Vector6d rounded = Vector6d::Zero();
  for (int i = 0; i < 6; ++i) {
    if (y[i] == 0) continue;
    Rational x;
    if (highest >= 0) {
      mpq_div_2exp(x.get_mpq_t(), y[i].get_mpq_t(), static_cast<mp_bitcnt_t>(highest));
    } else {
      mpq_mul_2exp(x.get_mpq_t(), y[i].get_mpq_t(), static_cast<mp_bitcnt_t>(-highest));
    }
    rounded[i] = NearestDouble(x);
  }
  return rounded;
}

void Decline(std::string reason, SettledStability* settled) {
  settled->answer = StabilityAnswer{};
  settled->stage = StabilityStage::kUndecided;
  settled->reason = std::move(reason);
}

// The exact verdict holds or fails: does it survive the errors?
void Settle(const StabilityQuery& query, const exact::StabilityResult& result,
            StabilityWorkspace* workspace, SettledStability* settled) {
  const ScaledContacts& scaled = workspace->scratch->contacts;
  Balance& balance = workspace->scratch->balance;
  settled->stage = StabilityStage::kExact;
  settled->answer.verdict = result.verdict;
  const bool holds = result.verdict == Verdict::kHolds;
  bool survives = IsExact(query);
  if (holds && ToBalance(scaled, result.forces, &balance)) {
    survives |= ProveInterior(scaled, &balance);
    ReportBalance(scaled, balance, &settled->answer.forces);
  }
  if (!holds) {
    Vector6d y = ToDoubles(result.separator);
    settled->answer.separator.y = y;
    y.tail<3>() *= scaled.length;
    survives |= ProveOutside(scaled, y);
  }
  if (!survives) {
    Decline(std::string(holds ? "stable" : "unstable") +
                " as stored, but by less than the error of the contacts",
            settled);
  }
}

std::optional<exact::StabilityResult> DecideFromFloats(const IntegerEquilibrium& lifted, int count,
                                                       StabilityWorkspace* workspace) {
  SimplexEnd& end = workspace->scratch->end;
  if (end.count != count) {
    Vector6d y;
    int pivots = 0;
    SolveStability(workspace->scratch->contacts, count, &workspace->scratch->balance, &y, &pivots,
                   &end);
  }
  if (end.count != count) return std::nullopt;  // decided: only where fewer contacts are not
  return DecideBySimplex(lifted, end, workspace->scratch->exact.get());
}

// The exact verdict on the first `count` scaled contacts as they are stored. Over integers where
// that will do, on even ground by forces along the weight first; the twin's pyramids for the rest.
exact::StabilityResult DecideStored(const StabilityQuery& query, int count,
                                    StabilityWorkspace* workspace) {
  const ScaledContacts& scaled = workspace->scratch->contacts;
  if (!workspace->scratch->exact) workspace->scratch->exact = std::make_shared<RoundBuffers>();
  IntegerEquilibrium& lifted = workspace->scratch->exact->lifted;
  if (LiftEquilibrium(query, scaled, count, &lifted)) {
    std::optional<exact::StabilityResult> result;
    const bool even = IsEven(lifted);
    if (even) result = DecideByParallelForces(lifted);
    if (!result) result = DecideFromFloats(lifted, count, workspace);
    if (!result && !even) result = DecideByParallelForces(lifted);
    if (result) return *std::move(result);
  }
  return exact::DecideStability(LiftQuery(query, scaled, count));
}

void DecideExactly(const StabilityQuery& query, StabilityWorkspace* workspace,
                   SettledStability* settled) {
  const ScaledContacts& scaled = workspace->scratch->contacts;
  exact::StabilityResult result = DecideStored(query, scaled.num_certain, workspace);
  const bool depends = scaled.num_certain < scaled.count && result.verdict != Verdict::kHolds;
  // Where the certain contacts do not carry the robot, only a refutation with all of them counts.
  if (depends) result = DecideStored(query, scaled.count, workspace);
  if (depends && result.verdict != Verdict::kFails) {
    Decline("depends on contacts that may or may not be active", settled);
  } else if (result.verdict == Verdict::kUndecided) {
    Decline(exact::Describe(result), settled);
  } else {
    Settle(query, result, workspace, settled);
  }
  for (exact::ContactForce& force : result.forces) force.contact = scaled.index[force.contact];
  settled->exact = std::move(result);
}

}  // namespace

SettledStability Stability(const StabilityQuery& query, StabilityWorkspace* workspace) {
  SettledStability settled;
  settled.answer = TryStability(query, workspace);
  settled.stage = StabilityStage::kFast;
  if (settled.answer.verdict != Verdict::kUndecided) return settled;
  if (!ScaleContacts(query, &workspace->scratch->contacts)) {
    Decline("a number is not finite, or mass or gravity is zero", &settled);
    return settled;
  }
  for (const Contact& contact : query.contacts) {
    if (!contact.n_W.isZero(0)) continue;
    Decline("a contact has no normal", &settled);
    return settled;
  }
  DecideExactly(query, workspace, &settled);
  return settled;
}

}  // namespace cguide::numeric
