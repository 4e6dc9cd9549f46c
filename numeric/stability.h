#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/contact.h"

namespace cguide::numeric {

/** Static stability of one placed configuration (DESIGN part 2, [Bouyarmane 2009, Def. 2]): can
 admissible contact forces balance gravity at the centre of mass? */
struct StabilityQuery {
  std::span<const Contact> contacts;
  Eigen::Vector3d com_W = Eigen::Vector3d::Zero();
  double com_error = 0;  ///< bound on the error of com_W (m)
  double mass = 0;       ///< kg
  Eigen::Vector3d gravity_W{0, 0, -9.81};
  int generators = 4;  ///< sides of the inscribed pyramids that are tried
};

/** Balance found in floats: weights on 6 generators, and the margin by which the proof went
 * through. */
struct ForceWitness {
  std::vector<int> contact;          ///< per generator: index into the query's contacts
  std::vector<Eigen::Vector3d> u_W;  ///< generator direction (not unit), admissible
  std::vector<double> weight;        ///< > 0
};

/** A wrench direction y with y.(u, p x u) <= 0 for every admissible u of every contact that may be
 active, and y.v > 0, moments about the centre of mass. */
struct SeparatingWrench {
  Eigen::Matrix<double, 6, 1> y = Eigen::Matrix<double, 6, 1>::Zero();
};

struct StabilityAnswer {
  Verdict verdict = Verdict::kUndecided;
  ForceWitness forces;         ///< filled where kHolds
  SeparatingWrench separator;  ///< filled where kFails
};

/** Per-thread scratch; keeps the last bases and separators as first guesses. */
struct StabilityWorkspace {
  std::vector<Eigen::Matrix<double, 6, 1>> columns;
  std::vector<int> last_basis;
  SeparatingWrench last_separator;
};

/** Decides in doubles with a proven bound, or declines (kUndecided).
 kHolds: the wrench is interior to the true cone for every configuration within the stated errors,
 using certain contacts only. kFails: it is outside the true revolution cones of all contacts that
 may be active. Proofs above the functions in stability.cc. */
StabilityAnswer TryStability(const StabilityQuery& query, StabilityWorkspace* workspace);

}  // namespace cguide::numeric
