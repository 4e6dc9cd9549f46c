#pragma once

#include <string>
#include <vector>

#include "cguide/exact/core/wrench.h"
#include "cguide/numeric/sampling.h"

// Wrench cones as humanoids meet them, and harder ones, for tests, fuzzing and benchmarks. Every
// generator is a force applied at a point, in doubles; a demand is a force at a point too (for
// gravity: -m g at the centre of mass).
namespace cguide::testing {

/** Generators of one cone and what they came from. */
struct WrenchSet {
  std::string family;
  int patches = 0;  ///< rectangles of four contact points
  int sides = 0;    ///< generators a point
  std::vector<AppliedForce> generators;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< of the contact points
};

/** How the numbers are stored. */
enum class Storage {
  kRounded,  ///< as computed
  kSnapped   ///< p and u to multiples of 2^-20: p x u is exact in doubles, coplanarity survives
};

/** A stance on `patches` rectangles of 0.22 m x 0.12 m: two feet, then hands on walls and rails and
 a seat; mu between 0.3 and 0.9; unit generators at equal angles about each normal, offset by half a
 side, as hpp-centroidal-dynamics places them. */
WrenchSet RandomStanceSet(int patches, int sides, Storage storage, numeric::Rng& rng);

/** Weight of a 58 kg robot at a centre of mass drawn within 0.35 m of the centroid (horizontally),
 0.2 to 0.8 m above it; snapped to 2^-20 likewise. */
AppliedForce RandomDemand(const WrenchSet& set, Storage storage, numeric::Rng& rng);

/** The demand with its point moved by `offset` along the horizontal direction from the centroid to
 it: for walking across the cone's boundary. */
AppliedForce Displaced(const WrenchSet& set, const AppliedForce& demand, double offset);

/** Sets that are degenerate exactly, all numbers dyadic with few bits, with demands on ties and
 2^-30 to 2^-40 m beside them: a flat foot or two, with the centre of mass on an edge or a vertex of
 the support; duplicated and collinear generators; one contact point (rank 3), two (rank 5 at most),
 facing walls and facing points (force closure or a line), wall and floor, zero vectors, no
 generator at all. */
struct TieCase {
  std::string name;
  WrenchSet set;
  AppliedForce demand;
};
std::vector<TieCase> TieCases(int count, numeric::Rng& rng);

}  // namespace cguide::testing
