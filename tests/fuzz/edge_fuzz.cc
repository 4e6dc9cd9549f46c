// Random edges near the boundary of C_guide for the certifier, as fast as they go:
//   edge_fuzz [KIND ...] [--count N] [--seconds S] [--seed K] [--samples M]
// For each kind N edges, or as many as S seconds allow. Edge i comes from a generator seeded with
// seed + i, so that one can be repeated alone. A wrong verdict is printed with the command that
// repeats it; exit 1 where there is one.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "tests/fuzz/edge_campaign.h"

namespace {

using namespace cguide::fuzz;  // NOLINT: a program of one file

struct Arguments {
  std::vector<std::string> kinds;
  std::uint64_t seed = 1;
  long count = 1000;
  double seconds = 0;  ///< 0: no limit of time
  CampaignOptions options;
};

double SecondsSince(std::chrono::steady_clock::time_point start) {
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  return spent.count();
}

double Percent(long part, long whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

bool Run(const EdgeKind& kind, const Arguments& arguments) {
  EdgeTally tally;
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t i = 0; tally.cases < arguments.count; ++i) {
    if (arguments.seconds > 0 && SecondsSince(start) > arguments.seconds) break;
    const std::string wrong = JudgeEdge(kind, arguments.seed + i, arguments.options, &tally);
    if (wrong.empty()) continue;
    std::printf("%s: wrong: %s\n  repeat with: edge_fuzz %s --seed %llu --count 1 --samples %d\n",
                kind.name, wrong.c_str(), kind.name,
                static_cast<unsigned long long>(arguments.seed + i), arguments.options.samples);
  }
  std::printf(
      "%s: %ld edges (%ld kept, %ld violated by making), %ld wrong; %ld proved, %ld refuted, %ld "
      "undecided (%.2f %%); %ld proofs checked at %d bits, %ld instants of them tested; %.0f s\n",
      kind.name, tally.cases, tally.kept, tally.violated, tally.wrong, tally.proved, tally.refuted,
      tally.undecided, Percent(tally.undecided, tally.cases), tally.precise,
      arguments.options.precise_bits, tally.samples, SecondsSince(start));
  for (const auto& [reason, found] : tally.reasons) {
    std::printf("  undecided %ld times: %s, first with --seed %llu\n", found.first, reason.c_str(),
                static_cast<unsigned long long>(found.second));
  }
  std::fflush(stdout);
  return tally.wrong == 0;
}

Arguments Parse(int argc, char** argv) {
  Arguments arguments;
  bool counted = false;
  for (int i = 1; i < argc; ++i) {
    const auto number = [&] { return i + 1 < argc ? std::strtoull(argv[++i], nullptr, 10) : 0; };
    if (std::strcmp(argv[i], "--seed") == 0) {
      arguments.seed = number();
    } else if (std::strcmp(argv[i], "--count") == 0) {
      arguments.count = static_cast<long>(number());
      counted = true;
    } else if (std::strcmp(argv[i], "--seconds") == 0) {
      arguments.seconds = static_cast<double>(number());
    } else if (std::strcmp(argv[i], "--samples") == 0) {
      arguments.options.samples = static_cast<int>(number());
    } else {
      arguments.kinds.emplace_back(argv[i]);
    }
  }
  if (!counted && arguments.seconds > 0) arguments.count = 1L << 40;
  return arguments;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = Parse(argc, argv);
  bool right = true, any = false;
  for (const EdgeKind& kind : EdgeKinds()) {
    bool asked = arguments.kinds.empty();
    for (const std::string& name : arguments.kinds) asked |= name == kind.name;
    if (!asked) continue;
    any = true;
    right = Run(kind, arguments) && right;
  }
  if (!any) std::fprintf(stderr, "edge_fuzz: no such kind\n");
  return !any ? 2 : right ? 0 : 1;
}
