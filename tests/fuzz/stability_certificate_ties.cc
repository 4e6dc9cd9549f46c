// Near ties of the certificates of static stability, at the scale of rounding. What the simplex
// proposes has more room than that as a rule, so the proposals are made here: separating wrenches
// on the boundary of a polar cone or normal to the wrench in question, and balances with a weight
// near zero, with a force on the boundary of its cone or with a nearly singular base, each moved by
// at most a few dozen times what rounding may move it. What a certificate accepts is checked over
// the rationals; what it refuses is counted apart, as nothing is claimed then.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "cguide/numeric/stability_contacts_internal.h"
#include "tests/fuzz/near_ties.h"
#include "tests/fuzz/twins.h"
#include "tests/numeric/stability_exact.h"

namespace cguide::fuzz {
namespace {

using Eigen::Vector3d;
using numeric::Contact;
using numeric::Generator;
using numeric::ScaledContacts;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kUnit = 0x1p-53;

/** In [-1, 1], of any size down to 2^-12. */
double AnySize(TieRng& rng) { return std::ldexp(AnyNumber(rng), -Below(rng, 12)); }

Vector3d UnitAcross(TieRng& rng, const Vector3d& n) { return n.cross(AnyPoint(rng)).normalized(); }

/** A point site with all bits of its numbers in use, its normal an axis or rounded to a unit one.
 */
Contact FineContact(TieRng& rng) {
  const Vector3d axis = Vector3d::Unit(Below(rng, 3));
  const bool exact = Below(rng, 2) == 0;
  Contact contact;
  contact.x_W = AnyPoint(rng);
  contact.n_W = exact ? axis : Vector3d(axis + 0.3 * AnyPoint(rng)).normalized();
  contact.normal_error = exact ? 0 : 0x1p-51;
  contact.distance = 0.02;
  contact.y_W = contact.x_W - 0.02 * contact.n_W;
  contact.friction = 0.2 + 0.8 * std::abs(AnyNumber(rng));
  return contact;
}

struct Question {
  std::vector<Contact> contacts;
  Vector3d com, gravity;

  numeric::StabilityQuery Query() const {
    numeric::StabilityQuery query;
    query.contacts = contacts;
    query.com_W = com;
    query.gravity_W = gravity;
    query.mass = 50;
    return query;
  }
};

// About arms r in the direction of n the wrench y = (f, m) sees g = f + m x r; g = t - mu n, t
// unit and normal to n, is on the boundary of the polar cone. Where |m| is much larger than |g|,
// cancellation in g is what must be allowed for.
std::string CheckSeparator(TieRng& rng, Tally* tally) {
  Question question{{FineContact(rng)}, AnyPoint(rng), {0, 0, -1}};
  ScaledContacts scaled;
  if (!ScaleContacts(question.Query(), &scaled)) return "a finite query was refused";
  const Contact& contact = question.contacts[0];
  const Vector3d n = contact.n_W, m = std::abs(AnySize(rng)) * AnyPoint(rng);
  const double size = std::abs(AnySize(rng));
  const Vector3d g = size * (UnitAcross(rng, n) - contact.friction * n);
  const bool tied_gain = Below(rng, 4) == 0;
  const double reach = kUnit * (512 * g.norm() + 128 * m.norm());
  Vector6d y;
  y << g - m.cross(scaled.arm(0)) + (tied_gain ? -size / 4 : AnySize(rng) * reach) * n, m;
  const Vector3d f = y.head<3>();
  question.gravity = tied_gain
                         ? Vector3d(UnitAcross(rng, f) + 16 * AnySize(rng) * kUnit * f.normalized())
                         : Vector3d(-f + 0.1 * f.norm() * AnyPoint(rng));
  const numeric::StabilityQuery query = question.Query();
  if (!ScaleContacts(query, &scaled)) return "a finite query was refused";
  if (!ProveOutside(scaled, y)) {
    ++tally->refused;
    return "";
  }
  ++tally->cases;
  ++tally->fast;
  numeric::SeparatingWrench separator;
  separator.y << f, m / scaled.length;  // a power of two
  return numeric::testing::ProvesOutside(numeric::testing::AsStored(question.contacts),
                                         Lift(question.com), query, separator)
             ? ""
             : "a separating wrench was accepted that separates nothing";
}

Generator MakeGenerator(const ScaledContacts& scaled, int contact, const Vector3d& u) {
  Generator generator;
  generator.contact = contact;
  generator.u = u;
  generator.wrench << u, scaled.arm(contact).cross(u);
  return generator;
}

enum class TieOf { kWeight, kForce, kBase };

/** Three contacts p_i that each carry the part lambda_i of f, and the centre of mass on the line of
 f through sum lambda_i p_i; at each the forces f + a t_i and f - a t_i. */
struct Tripod {
  Question question;
  Vector3d f;
  Vector3d t[3];
  double a = 0;
  double lambda[3];
};

Tripod MakeTripod(TieRng& rng, TieOf kind) {
  Tripod tripod;
  // Half of them so that sums cancel without a trace of the rounding in their terms.
  const bool plain = Below(rng, 2) == 0;
  tripod.f = Vector3d(0, 0, 1) + (plain ? 0 : 0.2) * AnyPoint(rng);
  tripod.a = kind == TieOf::kBase ? std::ldexp(1.0, -30 - Below(rng, 24))
                                  : std::ldexp(0.5, -Below(rng, 3));
  tripod.lambda[0] = kind == TieOf::kWeight ? AnySize(rng) * 0x1p-42 : 0.3;
  tripod.lambda[1] = 0.2 + 0.4 * std::abs(AnyNumber(rng));
  tripod.lambda[2] = 1 - tripod.lambda[0] - tripod.lambda[1];
  Vector3d q = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    Contact contact = FineContact(rng);
    const bool exact = contact.normal_error == 0;
    contact.n_W = exact ? Vector3d(0, 0, 1) : tripod.f.normalized();
    contact.friction += 0.8;
    tripod.t[i] = plain ? GridPoint(rng, 2, 2) : AnyPoint(rng);
    q += tripod.lambda[i] * contact.x_W;
    tripod.question.contacts.push_back(contact);
  }
  tripod.question.gravity = -tripod.f;
  tripod.question.com = q - AnyNumber(rng) * tripod.f;
  if (kind != TieOf::kForce) return tripod;
  // The coefficient of one contact such that one of its forces is just admissible, or just not.
  Contact& contact = tripod.question.contacts[Below(rng, 3)];
  const auto i = &contact - tripod.question.contacts.data();
  const Vector3d u = tripod.f + tripod.a * tripod.t[i];
  const double along = u.dot(contact.n_W), across = (u - along * contact.n_W).norm();
  contact.friction = across / along * (1 + 64 * AnySize(rng) * kUnit);
  return tripod;
}

numeric::Balance Propose(TieRng& rng, const Tripod& tripod, const ScaledContacts& scaled) {
  numeric::Balance balance;
  numeric::Matrix6d B;
  for (int k = 0; k < 6; ++k) {
    const int i = k / 2;
    const double sign = k % 2 == 0 ? 1 : -1;
    balance.base[k] = MakeGenerator(scaled, i, tripod.f + sign * tripod.a * tripod.t[i]);
    B.col(k) = balance.base[k].wrench;
  }
  balance.base_inverse = B.fullPivLu().inverse();
  Vector6d rest;
  rest << scaled.v_f, Vector3d::Zero();
  if (Below(rng, 2) == 0) {
    balance.num_extra = 1;
    balance.extra[0] = MakeGenerator(scaled, 1, tripod.f);
    balance.extra_weight[0] = 0.9 * tripod.lambda[1] * std::abs(AnyNumber(rng));
    rest -= balance.extra_weight[0] * balance.extra[0].wrench;
  }
  Eigen::Map<Vector6d>(balance.weight) = balance.base_inverse * rest;
  return balance;
}

std::string CheckBalance(TieRng& rng, Tally* tally) {
  const auto kind = static_cast<TieOf>(Below(rng, 3));
  const Tripod tripod = MakeTripod(rng, kind);
  const numeric::StabilityQuery query = tripod.question.Query();
  ScaledContacts scaled;
  if (!ScaleContacts(query, &scaled)) return "a finite query was refused";
  numeric::Balance balance = Propose(rng, tripod, scaled);
  if (!ProveInterior(scaled, &balance)) {
    ++tally->refused;
    return "";
  }
  ++tally->cases;
  ++tally->fast;
  numeric::ForceWitness witness;
  ReportBalance(scaled, balance, &witness);
  return numeric::testing::ProvesInterior(numeric::testing::AsStored(tripod.question.contacts),
                                          Lift(tripod.question.com), query, witness)
             ? ""
             : "a balance was accepted that proves nothing";
}

}  // namespace

std::string TiesOfStabilityCertificates(TieRng& rng, Tally* tally) {
  for (int k = 0; k < 8; ++k) {
    std::string wrong = CheckSeparator(rng, tally);
    if (wrong.empty()) wrong = CheckBalance(rng, tally);
    if (!wrong.empty()) return wrong;
  }
  return "";
}

}  // namespace cguide::fuzz
