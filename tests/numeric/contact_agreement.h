#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "cguide/exact/contact.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/stability.h"
#include "cguide/numeric/world.h"

// When a contact in floats and one over the rationals may be the same.
namespace cguide::numeric::testing {

inline bool Within(const Eigen::Vector3d& a, const Vector3q& b, const Rational& error) {
  return exact::SquaredNorm(Lift(a) - b) <= error * error;
}

/** The unit vector of an exact contact, up to 2^-80. */
inline Vector3q Unit(const exact::FoundContact& c) {
  const Vector3q& w = c.contact.cone.w;
  return exact::Scaled(1 / exact::SqrtUp(exact::SquaredNorm(w), 90), w);
}

/** Whether both may describe one local closest point: site, y, distance and normal agree within the
 errors that each side states. */
inline bool AgreeOnPoint(const Contact& fast, const exact::FoundContact& slow) {
  if (fast.site != slow.site || fast.body != slow.body) return false;
  const Rational error = Lift(fast.error);
  if (!Within(fast.x_W, slow.x, error + slow.error_x)) return false;
  if (!Within(fast.y_W, slow.y, error + slow.error_y)) return false;
  if (abs(Lift(fast.distance) - slow.distance) > error + slow.error_distance) return false;
  const double bound = NormalError(fast);
  if (!(bound < 2)) return true;
  const Rational length = exact::SqrtDown(exact::SquaredNorm(slow.contact.cone.w));
  if (slow.contact.error_w >= length) return true;
  const Rational slack = 2 * slow.contact.error_w / length + Lift(0x1p-79);
  return Within(fast.n_W, Unit(slow), Lift(bound) + slack);
}

/** Friction as well. */
inline bool Agree(const Contact& fast, const exact::FoundContact& slow) {
  return Lift(fast.friction) == slow.contact.cone.mu && AgreeOnPoint(fast, slow);
}

/** What of two lists contradicts the other, or an empty string. Every exact contact is at least
 possible in the float list. Every certain float contact is a certain exact one, whose friction may
 be larger: that of owners which rounding cannot tell apart is the smallest. */
inline std::string Disagreement(const std::vector<Contact>& fast,
                                const std::vector<exact::FoundContact>& slow) {
  for (const exact::FoundContact& c : slow) {
    if (std::none_of(fast.begin(), fast.end(), [&](const Contact& f) { return Agree(f, c); })) {
      return "doubles have no contact where there is one";
    }
  }
  for (const Contact& f : fast) {
    const auto backs = [&](const exact::FoundContact& c) {
      return c.contact.certain && Lift(f.friction) <= c.contact.cone.mu && AgreeOnPoint(f, c);
    };
    if (f.certain && std::none_of(slow.begin(), slow.end(), backs)) {
      return "a certain contact is none of the exact ones";
    }
  }
  return "";
}

}  // namespace cguide::numeric::testing
