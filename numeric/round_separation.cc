#include <algorithm>
#include <cmath>

#include "cguide/numeric/round_simplex_internal.h"

// Wrenches y that are to separate: which contact they drive, and how to leave it alone.
namespace cguide::numeric {

// Doubles of exact numbers say which contact, and decide signs but near zero.
DrivenContact FindDriven(const IntegerEquilibrium& e, const Integer3& y_f, const Integer3& y_m) {
  DrivenContact worst;
  double highest = 0;
  long scale = std::numeric_limits<long>::min();
  const DrivenFilter filter(e, y_f, y_m);
  for (std::size_t i = 0; i < e.contacts.size(); ++i) {
    const int contact = static_cast<int>(i);
    if (filter.IsFarFromDriven(contact)) continue;
    const IntegerCone& cone = e.cones[static_cast<std::size_t>(e.contacts[i].cone)];
    const Integer3 g = SeenAt(e, contact, y_f, y_m);
    long exponent;
    const Eigen::Vector3d seen = ToDoubles(g, &exponent);
    const double along = seen.dot(cone.n);
    const Eigen::Vector3d across = seen - along * cone.n;
    const double price = along + cone.mu * across.norm();
    // |seen| < 2, and seen and n are within 4 u of theirs: price is within 64 u (1 + mu).
    if (price < -1e-12 * (1 + cone.mu)) continue;
    if (IsNeverDriven(cone, g)) continue;
    const double value = std::max(price, 1e-300);
    if (worst.contact < 0 || std::ldexp(value, static_cast<int>(std::clamp(exponent - scale, -2000L,
                                                                           2000L))) > highest) {
      worst = {contact, across};
      highest = value, scale = exponent;
    }
  }
  return worst;
}

// y + e z: any e with y.v + e z.v > 0 will do; where z.v < 0, half of that.
bool ShiftIntoRoom(const IntegerEquilibrium& e, const SimplexEnd& found, Integer3* y_f,
                   Integer3* y_m) {
  if (!found.has_room) return false;
  Integer3 z_f, z_m;
  for (int k = 0; k < 3; ++k) {
    z_f[k] = CutToInteger(found.room[k], kFloatBits);
    // y_m of scaled arms: arm/length = (arm in units) 2^unit/length.
    z_m[k] =
        CutToInteger(found.room[k + 3] * std::ldexp(1.0 / found.length, e.unit), 2 * kFloatBits);
    z_f[k] <<= kFloatBits;
  }
  const auto bits = [](const mpz_class& x) {
    return static_cast<long>(mpz_sizeinbase(x.get_mpz_t(), 2));
  };
  const mpz_class gain = Dot(*y_f, e.f), loss = -Dot(z_f, e.f);
  // A y + B z with B loss < A gain.
  long shift = 0;
  if (loss > 0) {
    shift = bits(gain) - bits(loss) - 2;
  } else {
    for (int k = 0; k < 3; ++k) shift = std::max({shift, bits((*y_f)[k]), bits((*y_m)[k])});
  }
  const auto a = static_cast<unsigned>(std::max(-shift, 0L)),
             b = static_cast<unsigned>(std::max(shift, 0L));
  for (int k = 0; k < 3; ++k) {
    z_f[k] = ((*y_f)[k] << a) + (z_f[k] << b);
    z_m[k] = ((*y_m)[k] << a) + (z_m[k] << b);
  }
  if (Dot(z_f, e.f) <= 0 || !IsPolar(e, z_f, z_m)) return false;
  *y_f = std::move(z_f);
  *y_m = std::move(z_m);
  return true;
}

}  // namespace cguide::numeric
