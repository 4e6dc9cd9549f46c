#pragma once

#include <optional>

#include "cguide/numeric/five_columns_internal.h"
#include "cguide/numeric/round_cones_internal.h"

// Pieces of the simplex over integers: round_simplex.cc tells what it does.
namespace cguide::numeric {

constexpr int kFloatBits = 60;   // of columns that doubles found, after the point
constexpr int kColumnBits = 92;  // of those made over the integers

/** An admissible force and its wrench. */
struct Column {
  int contact = -1;
  Integer3 u;
  IntegerWrench wrench;
};

/** round_columns.cc: the force of a generator, which doubles think admissible, cut to 60 bits after
 the point; where that is not admissible, the extreme force in its direction. False where it is of
 no contact. */
bool SetColumn(const IntegerEquilibrium& e, const Generator& generator, Column* column);

/** w/|w| + mu t/|t| for t the part of `across` across w, a little inwards; w where that fails. */
void SetExtremeColumn(const IntegerEquilibrium& e, int contact, const Eigen::Vector3d& across,
                      Column* column);

/** x 2^bits, bits <= 120, cut to an integer; 0 where that is too large for a proposal. */
mpz_class CutToInteger(double x, int bits);

/** round_separation.cc: the contact that y drives most, and where. */
struct DrivenContact {
  int contact = -1;  ///< -1: y drives none, which is proved
  Eigen::Vector3d across = Eigen::Vector3d::Zero();
};
DrivenContact FindDriven(const IntegerEquilibrium& e, const Integer3& y_f, const Integer3& y_m);

/** Where y.v > 0 but y drives contacts by next to nothing: adds a multiple of the z that doubles
 found room with, if that leaves y.v > 0 and then drives none. False, and y as it was, otherwise. */
bool ShiftIntoRoom(const IntegerEquilibrium& e, const SimplexEnd& found, Integer3* y_f,
                   Integer3* y_m);

/** round_forces.cc: appends weight/denominator of the column, in newtons. */
void AppendForce(const IntegerEquilibrium& e, const Column& column, const mpz_class& weight,
                 const mpz_class& denominator, exact::StabilityResult* result);

/** round_corner.cc: decides near ties where the columns that doubles ended with are the right ones;
 nothing otherwise. Rank 6 alone. */
std::optional<exact::StabilityResult> DecideAtCorner(const IntegerEquilibrium& e,
                                                     const SimplexEnd& found,
                                                     RoundBuffers* buffers);

/** Of the exact stage: what GMP has allocated is used again. */
struct RoundBuffers {
  IntegerEquilibrium lifted;
  FiveColumns five;
  Column column[6];
  IntegerWrench v;
  Integer6 y, x;
  mpz_class determinant;
};

}  // namespace cguide::numeric
