// Random cases for the pairs of twins, in an ordinary build, as fast as they go:
//   twin_fuzz [FAMILY ...] [--seed N] [--ties N | --count M] [--seconds S] [--length BYTES]
//     [--independent N]
// --ties: near ties made on purpose, until N of them or S seconds are reached. Both stages must
// have decided some of them.
// --independent: about how many of the cases are also given to the independent solver (10000).
// --count: cases made from random bytes, M of them or for S seconds.
// Case i (batch i of near ties) of a family comes from a generator seeded with seed + i, so that
// one can be repeated alone. Exit 1 at the first wrong answer, with the command that repeats it.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>

#include "tests/fuzz/twins.h"

namespace {

using namespace cguide::fuzz;  // NOLINT: a program of one file

struct Arguments {
  std::vector<std::string> families;
  std::uint64_t seed = 1, count = 100000, ties = 0;
  double seconds = 0;  ///< 0: no limit of time
  bool counted = false;
  std::size_t length = 160;
  long independent = 10000;  ///< cases also given to the independent solver
};

class Clock {
 public:
  double seconds() const {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
    return spent.count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

bool Run(const Family& family, const Arguments& arguments) {
  Tally tally;
  std::vector<std::uint8_t> bytes(arguments.length);
  const std::uint64_t share = arguments.count / static_cast<std::uint64_t>(arguments.independent);
  const std::uint64_t every = arguments.counted ? std::max<std::uint64_t>(10, share) : 64;
  const Clock clock;
  const auto more = [&](std::uint64_t i) {
    return (arguments.seconds <= 0 || clock.seconds() < arguments.seconds) &&
           (!arguments.counted || i < arguments.count);
  };
  for (std::uint64_t i = 0; more(i); ++i) {
    std::mt19937_64 rng(arguments.seed + i);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(rng());
    ByteStream in(bytes.data(), bytes.size());
    const std::string wrong = family.check(in, i % every == 0, &tally);
    if (wrong.empty()) continue;
    std::printf("%s: wrong: %s\n  repeat with: twin_fuzz %s --seed %llu --count 1 --length %zu\n",
                family.name, wrong.c_str(), family.name,
                static_cast<unsigned long long>(arguments.seed + i), arguments.length);
    return false;
  }
  std::printf(
      "%s: %ld cases, 0 wrong; %ld fast, %ld exact, %ld open; %ld also by an independent solver\n",
      family.name, tally.cases, tally.fast, tally.exact, tally.open, tally.checked);
  std::fflush(stdout);
  return true;
}

bool RunTies(const Family& family, const Arguments& arguments) {
  Tally tally;
  const long count = static_cast<long>(arguments.ties);
  const long every = std::max(10L, count / arguments.independent);
  const Clock clock;
  for (std::uint64_t i = 0; tally.cases < count; ++i) {
    if (arguments.seconds > 0 && clock.seconds() > arguments.seconds) break;
    std::mt19937_64 rng(arguments.seed + i);
    const std::string wrong = family.ties(rng, every, &tally);
    if (wrong.empty()) continue;
    std::printf("%s: wrong: %s\n  repeat with: twin_fuzz %s --seed %llu --ties 1\n", family.name,
                wrong.c_str(), family.name, static_cast<unsigned long long>(arguments.seed + i));
    return false;
  }
  std::printf(
      "%s: %ld of %ld near ties (%ld exact ties), 0 wrong; %ld fast, %ld exact; %ld also by an "
      "independent solver; besides %ld open, %ld proposals refused; %.0f s\n",
      family.name, tally.cases, count, tally.tied, tally.fast, tally.exact, tally.checked,
      tally.open, tally.refused, clock.seconds());
  std::fflush(stdout);
  // With fewer a stage may have had no turn.
  if (tally.cases < 1000 || (tally.fast > 0 && tally.exact > 0)) return true;
  std::printf("%s: one of the stages decided nothing\n", family.name);
  return false;
}

Arguments Parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const auto number = [&] { return i + 1 < argc ? std::strtoull(argv[++i], nullptr, 10) : 0; };
    if (std::strcmp(argv[i], "--seed") == 0) {
      arguments.seed = number();
    } else if (std::strcmp(argv[i], "--count") == 0) {
      arguments.count = number();
      arguments.counted = true;
    } else if (std::strcmp(argv[i], "--ties") == 0) {
      arguments.ties = number();
    } else if (std::strcmp(argv[i], "--seconds") == 0) {
      arguments.seconds = static_cast<double>(number());
    } else if (std::strcmp(argv[i], "--independent") == 0) {
      arguments.independent = static_cast<long>(std::max(1ULL, number()));
    } else if (std::strcmp(argv[i], "--length") == 0) {
      arguments.length = static_cast<std::size_t>(number());
    } else {
      arguments.families.emplace_back(argv[i]);
    }
  }
  arguments.counted |= arguments.seconds <= 0;
  return arguments;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = Parse(argc, argv);
  bool right = true, any = false;
  for (const Family& family : kFamilies) {
    bool asked = arguments.families.empty();
    for (const std::string& name : arguments.families) asked |= name == family.name;
    if (!asked) continue;
    any = true;
    right = (arguments.ties > 0 ? RunTies : Run)(family, arguments) && right;
  }
  if (!any) std::fprintf(stderr, "twin_fuzz: no such family\n");
  return !any ? 2 : right ? 0 : 1;
}
