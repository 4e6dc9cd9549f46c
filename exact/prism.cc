#include "cguide/exact/prism.h"

#include <cmath>
#include <numbers>

#include "cguide/exact/core/error.h"

namespace cguide::exact {
namespace {

using Direction = std::array<Rational, 2>;

std::vector<Vector3q> Extrude(const std::vector<Direction>& rim, const Cylinder& cylinder) {
  const Rational radius = Lift(cylinder.radius), half = Lift(cylinder.length) / 2;
  std::vector<Vector3q> corners;
  for (const Rational& z : {Rational(-half), half}) {
    for (const Direction& c : rim) {
      corners.push_back({Rational(radius * c[0]), Rational(radius * c[1]), z});
    }
  }
  return corners;
}

}  // namespace

std::vector<Direction> RationalDirections(int sides) {
  Require(sides >= 8 && sides <= 4096 && sides % 4 == 0,
          "a prism needs a multiple of 4 between 8 and 4096 sides");
  std::vector<Direction> result(static_cast<std::size_t>(sides));
  const int quarter = sides / 4;
  for (int k = 0; k < quarter; ++k) {
    const double tangent = std::tan(std::numbers::pi * k / sides);
    const Rational t(Lift(std::ldexp(std::round(std::ldexp(tangent, 20)), -20)));
    const Rational norm = 1 + t * t, x = (1 - t * t) / norm, y = 2 * t / norm;
    result[k] = {x, y};
    result[k + quarter] = {Rational(-y), x};
    result[k + 2 * quarter] = {Rational(-x), Rational(-y)};
    result[k + 3 * quarter] = {y, Rational(-x)};
  }
  return result;
}

std::vector<Vector3q> InscribedPrism(const Cylinder& cylinder, int sides) {
  return Extrude(RationalDirections(sides), cylinder);
}

std::vector<Vector3q> CircumscribedPrism(const Cylinder& cylinder, int sides) {
  const std::vector<Direction> touch = RationalDirections(sides);
  std::vector<Direction> rim;
  for (std::size_t k = 0; k < touch.size(); ++k) {
    // The tangents u.x = 1 and v.x = 1 meet in (u + v)/(1 + u.v).
    const Direction &u = touch[k], &v = touch[(k + 1) % touch.size()];
    const Rational scale = 1 + u[0] * v[0] + u[1] * v[1];
    rim.push_back({Rational((u[0] + v[0]) / scale), Rational((u[1] + v[1]) / scale)});
  }
  return Extrude(rim, cylinder);
}

}  // namespace cguide::exact
