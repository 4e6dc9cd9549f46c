#include "tests/fuzz/twin_campaign.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <random>

namespace cguide::fuzz {
namespace {

class Clock {
 public:
  double seconds() const {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
    return spent.count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

bool RunBytes(const Family& family, const Campaign& campaign, std::ostream& out) {
  Tally tally;
  std::vector<std::uint8_t> bytes(campaign.length);
  const std::uint64_t share = campaign.count / static_cast<std::uint64_t>(campaign.independent);
  const std::uint64_t every = campaign.counted ? std::max<std::uint64_t>(10, share) : 64;
  const Clock clock;
  const auto more = [&](std::uint64_t i) {
    return (campaign.seconds <= 0 || clock.seconds() < campaign.seconds) &&
           (!campaign.counted || i < campaign.count);
  };
  for (std::uint64_t i = 0; more(i); ++i) {
    std::mt19937_64 rng(campaign.seed + i);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(rng());
    ByteStream in(bytes.data(), bytes.size());
    const std::string wrong = family.check(in, i % every == 0, &tally);
    if (wrong.empty()) continue;
    out << family.name << ": wrong: " << wrong << "\n  repeat with: " << campaign.program << ' '
        << family.name << " --seed " << campaign.seed + i << " --count 1 --length "
        << campaign.length << '\n';
    return false;
  }
  out << family.name << ": " << tally.cases << " cases, 0 wrong; " << tally.fast << " fast, "
      << tally.exact << " exact, " << tally.open << " open; " << tally.checked
      << " also by an independent solver" << std::endl;
  return true;
}

bool RunTies(const Family& family, const Campaign& campaign, std::ostream& out) {
  Tally tally;
  const long count = static_cast<long>(campaign.ties);
  const long every = count == 1 ? 1 : std::max(10L, count / campaign.independent);
  const Clock clock;
  for (std::uint64_t i = 0; tally.cases < count; ++i) {
    if (campaign.seconds > 0 && clock.seconds() > campaign.seconds) break;
    std::mt19937_64 rng(campaign.seed + i);
    const std::string wrong = family.ties(rng, every, &tally);
    if (wrong.empty()) continue;
    out << family.name << ": wrong: " << wrong << "\n  repeat with: " << campaign.program << ' '
        << family.name << " --seed " << campaign.seed + i << " --ties 1\n";
    return false;
  }
  out << family.name << ": " << tally.cases << " of " << count << " near ties (" << tally.tied
      << " exact ties), 0 wrong; " << tally.fast << " fast, " << tally.exact << " exact; "
      << tally.checked << " also by an independent solver; besides " << tally.open << " open, "
      << tally.refused << " proposals refused; " << std::lround(clock.seconds()) << " s"
      << std::endl;
  // With fewer a stage may have had no turn.
  if (tally.cases < 1000 || (tally.fast > 0 && tally.exact > 0)) return true;
  out << family.name << ": one of the stages decided nothing\n";
  return false;
}

Campaign ParseCampaign(int argc, char** argv) {
  Campaign campaign;
  campaign.program = argv[0];
  for (int i = 1; i < argc; ++i) {
    const auto number = [&] { return i + 1 < argc ? std::strtoull(argv[++i], nullptr, 10) : 0; };
    if (std::strcmp(argv[i], "--seed") == 0) {
      campaign.seed = number();
    } else if (std::strcmp(argv[i], "--count") == 0) {
      campaign.count = number();
      campaign.counted = true;
    } else if (std::strcmp(argv[i], "--ties") == 0) {
      campaign.ties = number();
    } else if (std::strcmp(argv[i], "--seconds") == 0) {
      campaign.seconds = static_cast<double>(number());
    } else if (std::strcmp(argv[i], "--independent") == 0) {
      campaign.independent = static_cast<long>(std::max(1ULL, number()));
    } else if (std::strcmp(argv[i], "--length") == 0) {
      campaign.length = static_cast<std::size_t>(number());
    } else {
      campaign.families.emplace_back(argv[i]);
    }
  }
  campaign.counted |= campaign.seconds <= 0;
  return campaign;
}

}  // namespace cguide::fuzz
