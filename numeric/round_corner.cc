#include <algorithm>
#include <cmath>
#include <utility>

#include "cguide/numeric/round_simplex_internal.h"

// Doubles stop near a tie with five columns that span the face of the cone next to v. Its normal y,
// over integers, has v on one side. Beyond the face y separates where it drives no cone; on this
// side of it v is a combination of the five and of any generator of the base behind the face, and
// where all six weights are positive and the six are independent, v is interior. Which generator,
// and which of y and -y looks out, doubles may say: either answer is proved by what it shows.
namespace cguide::numeric {
namespace {

using exact::StabilityResult;

/** y in doubles of scaled arms, the largest entry near 1. */
Vector6d Scaled(const IntegerEquilibrium& e, double length, const Integer6& y) {
  const long shift = std::ilogb(length) - e.unit;
  double significand[6];
  long exponent[6], highest = std::numeric_limits<long>::min();
  for (int k = 0; k < 6; ++k) {
    significand[k] = mpz_get_d_2exp(&exponent[k], y[k].get_mpz_t());
    if (k >= 3) exponent[k] += shift;
    if (y[k] != 0) highest = std::max(highest, exponent[k]);
  }
  Vector6d result;
  for (int k = 0; k < 6; ++k) {
    const long relative = y[k] == 0 ? 0 : std::max(exponent[k] - highest, -2000L);
    result[k] = std::ldexp(significand[k], static_cast<int>(relative));
  }
  return result;
}

/** The generator of the base farthest behind y, which is turned so that the base is behind. */
int TurnOutwards(const IntegerEquilibrium& e, const SimplexEnd& found, Integer6* y) {
  Vector6d seen = Scaled(e, found.length, *y);
  double price[6], sum = 0;
  for (int k = 0; k < 6; ++k) sum += price[k] = seen.dot(found.base[k].wrench);
  if (sum > 0) {
    for (mpz_class& z : *y) mpz_neg(z.get_mpz_t(), z.get_mpz_t());
    for (double& x : price) x = -x;
  }
  return static_cast<int>(std::min_element(std::begin(price), std::end(price)) - price);
}

std::optional<StabilityResult> FailBy(const IntegerEquilibrium& e, const SimplexEnd& found,
                                      const Integer6& y) {
  Integer3 y_f{y[0], y[1], y[2]}, y_m{y[3], y[4], y[5]};
  if (FindDriven(e, y_f, y_m).contact >= 0 && !ShiftIntoRoom(e, found, &y_f, &y_m)) {
    return std::nullopt;
  }
  StabilityResult result;
  result.verdict = Verdict::kFails;
  result.separator = ToMetres(e, y_f, y_m);
  return result;
}

std::optional<StabilityResult> HoldBy(const IntegerEquilibrium& e, const Generator& behind,
                                      RoundBuffers* b) {
  if (!SetColumn(e, behind, &b->column[5])) return std::nullopt;
  for (int k = 0; k < 3; ++k) b->v.a[k] = e.f[k], b->v.a[k + 3] = 0;
  if (!b->five.Solve(b->column[5].wrench, b->v, &b->x, &b->determinant)) return std::nullopt;
  for (const mpz_class& x : b->x) {
    if (x <= 0) return std::nullopt;
  }
  StabilityResult result;
  result.verdict = Verdict::kHolds;
  result.forces.reserve(6);
  for (int k = 0; k < 6; ++k) AppendForce(e, b->column[k], b->x[k], b->determinant, &result);
  return result;
}

}  // namespace

std::optional<StabilityResult> DecideAtCorner(const IntegerEquilibrium& e, const SimplexEnd& found,
                                              RoundBuffers* buffers) {
  const IntegerWrench* columns[5];
  int count = 0;
  for (int k = 0; k < 6; ++k) {
    if (k == found.direction_row) continue;
    if (!SetColumn(e, found.column[k], &buffers->column[count])) return std::nullopt;
    columns[count] = &buffers->column[count].wrench;
    ++count;
  }
  if (!buffers->five.Factor(columns)) return std::nullopt;
  Integer6& y = buffers->y;
  buffers->five.SetNormal(&y);
  const int behind = TurnOutwards(e, found, &y);
  const int side = sgn(mpz_class(y[0] * e.f[0] + y[1] * e.f[1] + y[2] * e.f[2]));
  std::optional<StabilityResult> result;
  if (side > 0) result = FailBy(e, found, y);
  if (side < 0) result = HoldBy(e, found.base[behind], buffers);
  if (result) result->rank = 6;
  return result;
}

}  // namespace cguide::numeric
