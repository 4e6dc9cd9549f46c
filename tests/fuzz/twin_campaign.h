#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "tests/fuzz/twins.h"

namespace cguide::fuzz {

/** The arguments of twin_fuzz. */
struct Campaign {
  std::string program = "twin_fuzz";  ///< as it was called
  std::vector<std::string> families;  ///< all where none is named
  std::uint64_t seed = 1;
  std::uint64_t count = 100000;
  std::uint64_t ties = 0;
  double seconds = 0;  ///< 0: no limit of time
  bool counted = false;
  std::size_t length = 160;
  long independent = 10000;  ///< near ties that the slow checks are made of, about
};

Campaign ParseCampaign(int argc, char** argv);

/** Checks cases made from random bytes. False at the first that is wrong, with the command that
 repeats it: case i comes from a generator seeded with seed + i. */
bool RunBytes(const Family& family, const Campaign& campaign, std::ostream& out);

/** Checks near ties until campaign.ties of them are reached. Batch i comes from a generator seeded
 with seed + i. Where one tie is asked for, every check of its batch is made, so that the command
 that a failure prints repeats it whatever the tally was. */
bool RunTies(const Family& family, const Campaign& campaign, std::ostream& out);

}  // namespace cguide::fuzz
