#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/byte_stream.h"

// Checks for each pair of twins, which compare them through proofs over Q. Two sources of cases:
// bytes (libFuzzer targets, twin_fuzz --count), which reach anything, and near ties made on purpose
// (twin_fuzz --ties), of which millions are cheap because the truth is known from their making.
namespace cguide::fuzz {

/** How many answers came from which stage. */
struct Tally {
  long cases = 0;    ///< in which a verdict was compared or a proof checked
  long fast = 0;     ///< decided in doubles
  long exact = 0;    ///< decided exactly
  long open = 0;     ///< undecided or not applicable; of the near ties not among `cases`
  long refused = 0;  ///< proposals that a certificate did not accept: not among `cases`
  long checked = 0;  ///< compared with an independent solver as well
  long tied = 0;     ///< of the near ties: exactly on the boundary
};

/** A check: describes what is wrong, or returns an empty string. `thorough` asks the independent
 solver too, which is slow. */
using Check = std::string (*)(ByteStream&, bool thorough, Tally*);

std::string CheckCone(ByteStream& in, bool thorough, Tally* tally);
std::string CheckFacets(ByteStream& in, bool thorough, Tally* tally);
std::string CheckStability(ByteStream& in, bool thorough, Tally* tally);
std::string CheckDistance(ByteStream& in, bool thorough, Tally* tally);
std::string CheckTriangles(ByteStream& in, bool thorough, Tally* tally);
std::string CheckClearance(ByteStream& in, bool thorough, Tally* tally);
std::string CheckContacts(ByteStream& in, bool thorough, Tally* tally);
std::string CheckLimits(ByteStream& in, bool thorough, Tally* tally);
std::string CheckMargins(ByteStream& in, bool thorough, Tally* tally);

/** Whether the slow checks of a near tie are to be made: of one case in `every`, as the tally
 stands, or of all where `every` is 1. */
inline bool SlowCheckIsDue(const Tally& tally, long every) {
  return every <= 1 || tally.checked * every <= tally.cases;
}

/** Makes and checks one family of near ties: a few dozen about one stance or pair of bodies, each
 within 2^-30 of a boundary of the predicate relative to the size of its numbers, or exactly on it.
 That it is so follows from the making and is checked; what is not does not count as a case. One
 case in `every` is also given to the independent solver. Describes what is wrong, or returns an
 empty string. */
using TieCheck = std::string (*)(std::mt19937_64& rng, long every, Tally*);

std::string TiesOfCones(std::mt19937_64& rng, long every, Tally* tally);
std::string TiesOfFacets(std::mt19937_64& rng, long every, Tally* tally);
std::string TiesOfStability(std::mt19937_64& rng, long every, Tally* tally);
/** Of TiesOfStability a share, counted with it: proposals for its certificates that are nearly, or
 barely, proofs. Near is not the verdict's boundary then, but that of what may be accepted. */
std::string TiesOfStabilityCertificates(std::mt19937_64& rng, Tally*);
std::string TiesOfDistance(std::mt19937_64& rng, long every, Tally* tally);
std::string TiesOfTriangles(std::mt19937_64& rng, long every, Tally* tally);
std::string TiesOfClearance(std::mt19937_64& rng, long every, Tally* tally);
/** Of TiesOfClearance half: balls, capsules and boxes, rotated, some with errors. */
std::string TiesOfPlacedClearance(std::mt19937_64& rng, Tally* tally);
std::string TiesOfContacts(std::mt19937_64& rng, long every, Tally* tally);
std::string TiesOfLimits(std::mt19937_64& rng, long every, Tally* tally);
std::string TiesOfMargins(std::mt19937_64& rng, long every, Tally* tally);

struct Family {
  const char* name;
  Check check;
  TieCheck ties;
};
inline constexpr Family kFamilies[] = {{"cone", &CheckCone, &TiesOfCones},
                                       {"facets", &CheckFacets, &TiesOfFacets},
                                       {"stability", &CheckStability, &TiesOfStability},
                                       {"distance", &CheckDistance, &TiesOfDistance},
                                       {"triangles", &CheckTriangles, &TiesOfTriangles},
                                       {"clearance", &CheckClearance, &TiesOfClearance},
                                       {"contacts", &CheckContacts, &TiesOfContacts},
                                       {"limits", &CheckLimits, &TiesOfLimits},
                                       {"margins", &CheckMargins, &TiesOfMargins}};

}  // namespace cguide::fuzz
