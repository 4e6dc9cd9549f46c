#pragma once

#include "cguide/numeric/wrench_cone.h"

// Rounding model of the certificates: |fl(a op b) - (a op b)| <= u |a op b|, u = 2^-53, round to
// nearest, contraction off. A sum of n products has an error of at most n u/(1 - n u) sum |a||b| in
// any order [Higham 2002, 3.1]. Scaled entries are below 1; underflow adds at most 2^-1074 an
// operation, which kTiny covers. Bounds are sums and products of fewer than 100 non-negative floats
// each: kUp makes up for their own rounding. NaN fails every test, since all are written so that
// only a true comparison proves something.
//
// Real columns a* and the real demand v* are positive multiples of the generators and the wrench
// asked about; the stored ones are within the errors of WrenchCone and WrenchDemand of them, entry
// by entry.
namespace cguide::numeric {

inline constexpr double kUnit = 0x1p-53;
inline constexpr double kUp = 1 + 256 * kUnit;
inline constexpr double kTiny = 0x1p-1000;

/** Bounds on the errors of the entries of a wrench, force and moment. */
struct EntryErrors {
  double force, moment;
  double operator[](int i) const { return i < 3 ? force : moment; }
};
inline EntryErrors ErrorsOf(const WrenchCone& cone) {
  return {cone.force_error(), cone.moment_error()};
}
inline EntryErrors ErrorsOf(const WrenchDemand& v) { return {v.force_error(), v.moment_error()}; }

}  // namespace cguide::numeric
