#pragma once

#include <vector>

#include "cguide/exact/core/rational.h"
#include "cguide/numeric/stability.h"

// Checks of witnesses over Q, written from the definitions and sharing no code with the library.
namespace cguide::numeric::testing {

/** A real contact: the normal as any positive multiple w, force point p, mu. */
struct RealContact {
  Vector3q w;
  Vector3q p;
  Rational mu;
};

inline Rational Dot(const Vector3q& a, const Vector3q& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vector3q Cross(const Vector3q& a, const Vector3q& b) {
  Vector3q c;
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
  return c;
}

inline Vector3q Minus(const Vector3q& a, const Vector3q& b) {
  Vector3q c;
  for (int i = 0; i < 3; ++i) c[i] = a[i] - b[i];
  return c;
}

/** The stored contact taken at its word: normal direction n_W, no error. */
inline RealContact AsStored(const Contact& contact) {
  RealContact real{Lift(contact.n_W), Lift(contact.x_W), Lift(contact.friction)};
  const Rational r = Lift(contact.radius);
  for (int i = 0; i < 3; ++i) real.p[i] -= r * real.w[i];
  return real;
}

inline std::vector<RealContact> AsStored(std::span<const Contact> contacts) {
  std::vector<RealContact> real;
  for (const Contact& contact : contacts) real.push_back(AsStored(contact));
  return real;
}

/** u.w >= 0 and (u.w)^2 (1 + mu^2) >= |u|^2 |w|^2. */
inline bool IsAdmissible(const Vector3q& u, const RealContact& c) {
  const Rational along = Dot(u, c.w);
  return along >= 0 && along * along * (1 + c.mu * c.mu) >= Dot(u, u) * Dot(c.w, c.w);
}

/** Solves the square system in place; false where it is singular. */
inline bool SolveExactly(std::vector<std::vector<Rational>> m, std::vector<Rational>* x) {
  const std::size_t n = m.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    while (pivot < n && m[pivot][k] == 0) ++pivot;
    if (pivot == n) return false;
    std::swap(m[k], m[pivot]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k || m[i][k] == 0) continue;
      const Rational factor = m[i][k] / m[k][k];
      for (std::size_t j = k; j <= n; ++j) m[i][j] -= factor * m[k][j];
    }
  }
  x->resize(n);
  for (std::size_t k = 0; k < n; ++k) (*x)[k] = m[k][n] / m[k][k];
  return true;
}

/** Whether the witness proves that the wrench at `com` is interior: admissible forces, six base
 columns of full rank whose weights, solved for exactly, are positive. Frictionless contacts take
 the real normal as their force. */
inline bool ProvesInterior(const std::vector<RealContact>& contacts, const Vector3q& com,
                           const StabilityQuery& query, const ForceWitness& witness) {
  if (witness.size < 6) return false;
  std::vector<std::vector<Rational>> m(6, std::vector<Rational>(7));
  for (int i = 0; i < 3; ++i) m[i][6] = -Lift(query.mass) * Lift(query.gravity_W[i]);
  for (int k = 0; k < witness.size; ++k) {
    const WitnessForce& force = witness.force[k];
    const RealContact& c = contacts[force.contact];
    Vector3q u = Lift(force.u_W);
    if (c.mu == 0) u = c.w;  // a positive multiple is as good
    if (!IsAdmissible(u, c) || !(force.weight > 0)) return false;
    const Vector3q moment = Cross(Minus(c.p, com), u);
    for (int i = 0; i < 3; ++i) {
      if (k < 6) {
        m[i][k] = u[i];
        m[i + 3][k] = moment[i];
      } else {
        m[i][6] -= Lift(force.weight) * u[i];
        m[i + 3][6] -= Lift(force.weight) * moment[i];
      }
    }
  }
  std::vector<Rational> weight;
  if (!SolveExactly(m, &weight)) return false;
  for (const Rational& w : weight) {
    if (w <= 0) return false;
  }
  return true;
}

/** Whether y separates the wrench at `com` from the revolution cones of all the contacts. */
inline bool ProvesOutside(const std::vector<RealContact>& contacts, const Vector3q& com,
                          const StabilityQuery& query, const SeparatingWrench& separator) {
  const Vector3q f = Lift(Eigen::Vector3d(separator.y.head<3>()));
  const Vector3q m = Lift(Eigen::Vector3d(separator.y.tail<3>()));
  if (!(Dot(f, Lift(query.gravity_W)) < 0)) return false;
  for (const RealContact& c : contacts) {
    Vector3q g = Cross(m, Minus(c.p, com));
    for (int i = 0; i < 3; ++i) g[i] += f[i];
    const Rational along = Dot(g, c.w);
    if (along > 0) return false;
    if (along * along * (1 + c.mu * c.mu) < c.mu * c.mu * Dot(g, g) * Dot(c.w, c.w)) return false;
  }
  return true;
}

/** Checks whatever the answer claims for the stored numbers; undecided claims nothing. */
inline bool IsProved(const StabilityQuery& query, const StabilityAnswer& answer) {
  if (answer.verdict == Verdict::kUndecided) return true;
  const std::vector<RealContact> real = AsStored(query.contacts);
  const Vector3q com = Lift(query.com_W);
  return answer.verdict == Verdict::kHolds ? ProvesInterior(real, com, query, answer.forces)
                                           : ProvesOutside(real, com, query, answer.separator);
}

}  // namespace cguide::numeric::testing
