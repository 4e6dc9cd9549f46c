#pragma once

#include "cguide/exact/equilibrium.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {

/** Adds the corners of the rectangle p +- a +- b with normal w. */
inline void AddRectangle(const Vector3q& p, const Vector3q& a, const Vector3q& b, const Vector3q& w,
                         const Rational& mu, EquilibriumQuery* query) {
  for (const int i : {-1, 1}) {
    for (const int j : {-1, 1}) {
      ExactContact contact;
      contact.p = p + Scaled(i, a) + Scaled(j, b);
      contact.cone = {w, mu};
      query->contacts.push_back(contact);
    }
  }
}

inline EquilibriumQuery Weighing(const Vector3q& com) {
  EquilibriumQuery query;
  query.com = com;
  query.mass = 58;
  query.gravity = {0, 0, Rational(-981, 100)};
  return query;
}

/** A foot of half sizes a, b at the origin of a level floor. */
inline EquilibriumQuery Foot(const Rational& a, const Rational& b, const Rational& mu,
                             const Vector3q& com) {
  EquilibriumQuery query = Weighing(com);
  AddRectangle({0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, 1}, mu, &query);
  return query;
}

}  // namespace cguide::exact
