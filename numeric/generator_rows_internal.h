#pragma once

#include <span>
#include <vector>

#include "cguide/exact/core/rational.h"
#include "cguide/exact/core/wrench.h"
#include "cguide/numeric/friction.h"
#include "cguide/numeric/wide_integer_internal.h"

namespace cguide::numeric {

/** An exact coordinate of a generator: m[0] 2^e[0] + m[1] 2^e[1], |m| < 2^106. */
struct ExactCoordinate {
  Int128 m[2] = {0, 0};
  int e[2] = {0, 0};
};
using ExactWrench = ExactCoordinate[6];
/** (u, p x u), or the doubles. @throws Error unless finite. */
void Decompose(const AppliedForce& generator, ExactWrench* wrench);
void Decompose(const Vector6d& generator, ExactWrench* wrench);

VectorXq ExactRow(const AppliedForce& generator);
VectorXq ExactRow(const Vector6d& generator);

bool IsZeroGenerator(const AppliedForce& g);
bool IsZeroGenerator(const Vector6d& g);

/** Generators in two forms for the signs of 6 x 6 determinants: both multiply rows and columns by
 positive factors (and the doubles shear the moments), which leaves every sign as it is. */
struct GeneratorRows {
  std::vector<int> nonzero;  ///< indices of the generators that are not zero

  // Integers: row i of the matrix is a_i 2^(-row_exponent[i]), column k of that 2^(-low[k]).
  std::vector<int> row_exponent;
  int low[6] = {};
  int bits[6] = {};  ///< of column k: every integer is below 2^bits[k] in size
  /** Every integer is below 2^(64 words - 4) in size; 0 where that would need too many. */
  int words = 0;

  // Doubles, of length at most 1, each within `error` of the exact row; then the unit vectors that
  // stand for coordinates left out.
  std::vector<Vector6d> rows;
  double error = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< moments are about it
  Vector6d column_scale = Vector6d::Ones();
  /** What the double determinant of six rows differs from the exact one by, at most. */
  double determinant_error = 0;

  /** The normal in the space of the generators of one in that of the rows. */
  Vector6d Unscaled(const Vector6d& y) const;
};

constexpr int kMaxEntryWords = 4;

template <typename Generator>
void FillScales(std::span<const Generator> generators, GeneratorRows* rows);

/** Moments about the centroid of the points where `shear`, otherwise about the origin. */
void FillRows(std::span<const AppliedForce> generators, bool shear, GeneratorRows* rows);
void FillRows(std::span<const Vector6d> generators, bool shear, GeneratorRows* rows);

/** Row i at result[6 i]. Zero generators stay zero. */
template <int E, typename Generator>
void FillIntegers(std::span<const Generator> generators, const GeneratorRows& rows,
                  std::vector<Wide<E>>* result) {
  result->assign(6 * generators.size(), Wide<E>{});
  for (const int i : rows.nonzero) {
    ExactWrench wrench;
    Decompose(generators[i], &wrench);
    for (int k = 0; k < 6; ++k) {
      Wide<E>& entry = (*result)[6 * static_cast<std::size_t>(i) + k];
      const int shift = rows.row_exponent[i] + rows.low[k];
      for (int t = 0; t < 2; ++t) {
        if (wrench[k].m[t] != 0) entry += Shifted<E>(wrench[k].m[t], wrench[k].e[t] - shift);
      }
    }
  }
}

}  // namespace cguide::numeric
