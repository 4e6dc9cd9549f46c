#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/fuzz/byte_stream.h"

// One check for each pair of twins: builds a case near a tie from bytes, asks all twins, and
// compares them through proofs over Q. Shared by the libFuzzer targets and by twin_fuzz.
namespace cguide::fuzz {

/** How many answers came from which stage. */
struct Tally {
  long cases = 0;
  long fast = 0;     ///< decided in doubles
  long exact = 0;    ///< decided exactly
  long open = 0;     ///< undecided, refused or not applicable
  long checked = 0;  ///< compared with an independent solver as well
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

struct Family {
  const char* name;
  Check check;
};
inline constexpr Family kFamilies[] = {
    {"cone", &CheckCone},         {"facets", &CheckFacets},       {"stability", &CheckStability},
    {"distance", &CheckDistance}, {"triangles", &CheckTriangles}, {"clearance", &CheckClearance}};

}  // namespace cguide::fuzz
