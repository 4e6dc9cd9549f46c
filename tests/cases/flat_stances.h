#pragma once

#include <vector>

#include "cguide/numeric/stability.h"
#include "tests/fuzz/near_ties.h"

// Stances on one plane, whose stability is known from two signs, and near ties of it.
namespace cguide::testing {

/** Corners of a convex polygon, counter-clockwise about the integer normal w, and points of it. */
struct FlatStance {
  Eigen::Vector3d w;
  double mu = 0;
  std::vector<Eigen::Vector3d> corners;
  std::vector<numeric::Contact> contacts;
};

/** Numbers of few bits, on planes of many directions. */
FlatStance RandomFlatStance(fuzz::TieRng& rng);

/** Points of a plane across an axis: any two doubles and the same third. */
FlatStance RandomFineStance(fuzz::TieRng& rng);

struct FlatTie {
  Eigen::Vector3d com;
  Eigen::Vector3d gravity;
};

/** Within 2^-30 of the boundary, or on it: at an edge of the hull, at the friction cone, or both.
 */
FlatTie MakeFlatTie(fuzz::TieRng& rng, const FlatStance& stance);

/** Within some units of rounding, or many. */
FlatTie MakeFineTie(fuzz::TieRng& rng, const FlatStance& stance);

/** What is true of the stored numbers: kUndecided on the boundary. */
Verdict TruthAbout(const FlatStance& stance, const FlatTie& tie);

/** Refers to the stance. */
numeric::StabilityQuery QueryOf(const FlatStance& stance, const FlatTie& tie);

}  // namespace cguide::testing
