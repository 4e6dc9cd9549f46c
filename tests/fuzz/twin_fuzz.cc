// Random cases for the pairs of twins, in an ordinary build, as fast as they go:
//   twin_fuzz [FAMILY ...] [--seed N] [--ties N | --count M] [--seconds S] [--length BYTES]
//     [--independent N]
// --ties: near ties made on purpose, until N of them or S seconds are reached. Both stages must
// have decided some of them. With --ties 1 the slow checks are made of every case of one batch.
// --independent: about how many of the cases are also given to the independent solver (10000).
// --count: cases made from random bytes, M of them or for S seconds.
// Case i (batch i of near ties) of a family comes from a generator seeded with seed + i, so that
// one can be repeated alone. Exit 1 at the first wrong answer, with the command that repeats it.
#include <cstdio>
#include <iostream>

#include "tests/fuzz/twin_campaign.h"

int main(int argc, char** argv) {
  using namespace cguide::fuzz;  // NOLINT: a program of one file
  const Campaign campaign = ParseCampaign(argc, argv);
  bool right = true, any = false;
  for (const Family& family : kFamilies) {
    bool asked = campaign.families.empty();
    for (const std::string& name : campaign.families) asked |= name == family.name;
    if (!asked) continue;
    any = true;
    right = (campaign.ties > 0 ? RunTies : RunBytes)(family, campaign, std::cout) && right;
  }
  if (!any) std::fprintf(stderr, "twin_fuzz: no such family\n");
  return !any ? 2 : right ? 0 : 1;
}
