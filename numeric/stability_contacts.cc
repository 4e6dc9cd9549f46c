#include <algorithm>
#include <cmath>
#include <limits>

#include "cguide/numeric/stability_contacts_internal.h"

namespace cguide::numeric {
namespace {

constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;  // u: half an ulp of 1
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Beyond this the normal is not known well enough to be worth a force.
constexpr double kUsableNormalError = 0.1;

// The coefficient mu' <= mu for which n + mu' t (t unit, normal to n) makes an angle with every
// unit vector within `error` of n whose cosine is at least f(mu), f(m) = 1/sqrt(1 + m^2): it
// suffices that f(mu') >= f(mu) + error. |f'(m)| = m/(1 + m^2)^(3/2) rises and then falls, so on
// [mu', mu] with mu' >= mu/2 it is at least (mu/2)/(1 + mu^2)^(3/2), and mu' = mu - error 2 (1 +
// mu^2)^(3/2)/mu will do while that is at least mu/2. The certificate checks the angle again, so
// rounding here is harmless.
double ReducedFriction(double mu, double root, double error) {
  const double step = error * 2 * root * root * root;
  return step <= 0.5 * mu * mu ? mu - step / mu : 0;
}

// Stores contact i of the query at slot k, arms not scaled yet; false where it is not finite.
//
// The force point x - r n takes a product and a difference, the arm one more difference; every
// operand is at most S = |x|_inf + r + |c|_inf up to relative 2u, so each component is within 3.1 u
// S and the vector within 5.4 u S of the stored numbers' arm. The real arm differs from that by the
// errors of x, of r n and of c.
bool Store(const StabilityQuery& query, int i, int k, ScaledContacts* c) {
  const Contact& contact = query.contacts[i];
  const Eigen::Vector3d r = contact.force_point_W() - query.com_W;
  const double magnitude = contact.x_W.lpNorm<Eigen::Infinity>() + contact.radius +
                           query.com_W.lpNorm<Eigen::Infinity>();
  const double normal_error = NormalError(contact);
  double error = contact.error + query.com_error + 6 * kUnit * magnitude;
  if (contact.radius > 0) error += contact.radius * normal_error;
  c->rx[k] = r[0], c->ry[k] = r[1], c->rz[k] = r[2];
  c->nx[k] = contact.n_W[0], c->ny[k] = contact.n_W[1], c->nz[k] = contact.n_W[2];
  c->true_mu[k] = contact.friction;
  c->normal_error[k] = normal_error;
  c->arm_error[k] = error * (1 + 64 * kUnit);
  c->index[k] = i;
  return r.allFinite() && contact.n_W.allFinite() && std::isfinite(magnitude) &&
         contact.radius >= 0 && contact.friction >= 0 && std::isfinite(contact.friction) &&
         contact.error >= 0 && query.com_error >= 0;
}

double LargestArm(const ScaledContacts& c) {
  double largest = 0;
  for (int k = 0; k < c.count; ++k) {
    largest = std::max({largest, std::abs(c.rx[k]), std::abs(c.ry[k]), std::abs(c.rz[k])});
  }
  return largest;
}

// Powers of two divide exactly.
void ScaleArms(double length, ScaledContacts* c) {
  c->length = length;
  const double inverse = 1 / length;
  for (int k = 0; k < c->count; ++k) {
    c->rx[k] *= inverse, c->ry[k] *= inverse, c->rz[k] *= inverse;
    c->arm_error[k] *= inverse;
  }
}

bool IsUsable(const Contact& contact) {
  return contact.certain && NormalError(contact) <= kUsableNormalError;
}

// The wrench to be balanced; false where it is none.
bool SetDirection(const StabilityQuery& query, ScaledContacts* c) {
  const double g = query.gravity_W.lpNorm<Eigen::Infinity>();
  if (!(g > 0) || !std::isfinite(g) || !query.gravity_W.allFinite()) return false;
  if (!(query.mass > 0) || !std::isfinite(query.mass)) return false;
  if (!query.com_W.allFinite()) return false;
  const int exponent = std::ilogb(g);
  for (int j = 0; j < 3; ++j) c->v_f[j] = std::ldexp(-query.gravity_W[j], -exponent);
  c->v_scale = std::ldexp(query.mass, exponent);
  return true;
}

void ReduceFriction(ScaledContacts* c) {
  double mu = -1, root = 1;
  for (int k = 0; k < c->count; ++k) {
    if (c->true_mu[k] != mu) {
      mu = c->true_mu[k];
      root = std::sqrt(1 + mu * mu);
    }
    c->mu[k] = ReducedFriction(mu, root, c->normal_error[k] + 32 * kUnit);
  }
}

}  // namespace

void Resize(int n, ScaledContacts* c) {
  for (auto* v : {&c->rx, &c->ry, &c->rz, &c->nx, &c->ny, &c->nz, &c->mu, &c->true_mu,
                  &c->normal_error, &c->arm_error}) {
    v->resize(n);
  }
  c->index.resize(n);
  c->count = n;
}

// With w = x - y stored and w* real, |w - w*| <= 2e and |w*| >= |d| - e: the directions of two
// vectors a, b differ by at most 2|a - b|/(|a| + |b|) <= 4e/(2|d| - 4e).
double NormalError(const Contact& contact) {
  if (contact.normal_error >= 0) return contact.normal_error;
  const double room = std::abs(contact.distance) - 2 * contact.error;
  if (!(room > 0)) return kInfinity;
  return (2 * contact.error / room) * (1 + 8 * kUnit) + 16 * kUnit;
}

bool ScaleContacts(const StabilityQuery& query, ScaledContacts* c) {
  if (!SetDirection(query, c)) return false;
  const int n = static_cast<int>(query.contacts.size());
  Resize(n, c);
  int front = 0, back = n;
  for (int i = 0; i < n; ++i) {
    if (!Store(query, i, IsUsable(query.contacts[i]) ? front++ : --back, c)) return false;
  }
  c->num_certain = front;
  ReduceFriction(c);
  // 2^(e+1) > largest: scaled components are below 1.
  const double largest = LargestArm(*c);
  ScaleArms(largest > 0 ? std::ldexp(1.0, std::ilogb(largest) + 1) : 1, c);
  return true;
}

bool ScaleSome(const StabilityQuery& query, std::span<const int> which, double length,
               ScaledContacts* c) {
  if (!SetDirection(query, c)) return false;
  Resize(static_cast<int>(which.size()), c);
  for (int k = 0; k < c->count; ++k) {
    if (!IsUsable(query.contacts[which[k]]) || !Store(query, which[k], k, c)) return false;
  }
  c->num_certain = c->count;
  if (!(LargestArm(*c) < length)) return false;
  ReduceFriction(c);
  ScaleArms(length, c);
  return true;
}

}  // namespace cguide::numeric
