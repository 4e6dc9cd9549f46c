#include "tests/fuzz/twin_campaign.h"

#include <catch2/catch.hpp>
#include <sstream>

namespace cguide::fuzz {
namespace {

// A family whose batches have 16 cases. In one batch of three the slow checks find mistakes.
std::string Mistaken(std::mt19937_64& rng, long every, Tally* tally) {
  const bool mistaken = rng() % 3 == 0;
  for (int k = 0; k < 16; ++k) {
    const bool due = SlowCheckIsDue(*tally, every);
    ++tally->cases;
    tally->checked += due;
    if (mistaken && due && k >= 5) return "case " + std::to_string(k);
  }
  return "";
}

std::string NoBytes(ByteStream&, bool, Tally*) { return ""; }

std::string Output(const Family& family, const Campaign& campaign, bool right) {
  std::ostringstream out;
  CHECK(RunTies(family, campaign, out) == right);
  return out.str();
}

}  // namespace

TEST_CASE("The command that a wrong near tie prints finds a wrong near tie again") {
  const Family family{"mistaken", &NoBytes, &Mistaken};
  Campaign campaign;
  campaign.seed = 40;
  campaign.ties = 1'000'000;  // the slow checks of one case in a hundred
  const std::string said = Output(family, campaign, false);
  CAPTURE(said);
  const std::string command = "twin_fuzz mistaken --seed ";
  REQUIRE(said.find(command) != std::string::npos);
  const std::string rest = said.substr(said.find(command) + command.size());
  campaign.seed = std::stoull(rest);
  CHECK(campaign.seed > 40);  // others of the mistakes before it went unseen
  CHECK(rest == std::to_string(campaign.seed) + " --ties 1\n");
  campaign.ties = 1;
  CHECK(Output(family, campaign, false).find(command + rest) != std::string::npos);
}

TEST_CASE("Asked for one near tie, every family makes the slow checks whatever was before") {
  for (const Family& family : kFamilies) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      CAPTURE(family.name, seed);
      std::mt19937_64 first(seed), second(seed);
      Tally alone, late;  // late: the last of many cases
      late.cases = 1'000'000;
      late.checked = late.cases - 1;
      const Tally before = late;
      CHECK(family.ties(first, 1, &alone) == "");
      CHECK(family.ties(second, 1, &late) == "");
      CHECK(late.cases - before.cases == alone.cases);
      CHECK(late.checked - before.checked == alone.checked);
      CHECK(first() == second());
    }
  }
}

}  // namespace cguide::fuzz
