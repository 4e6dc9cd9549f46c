#include "tests/benchmark/part_sampler.h"

#include <cxxabi.h>
#include <elf.h>
#include <execinfo.h>
#include <link.h>
#include <signal.h>
#include <sys/time.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace cguide::benchmark_tools {
namespace {

constexpr int kDeepest = 64;
constexpr int kPeriodMicroseconds = 1000;

struct Rule {
  std::string_view name;  // how a demangled name begins
  Part part;
};

// The first rule that fits decides.
constexpr Rule kRules[] = {
    {"cguide::numeric::TestFree(", Part::kDistance},
    {"cguide::numeric::FindContacts(", Part::kDistance},
    {"cguide::numeric::FindApproaches(", Part::kDistance},
    {"cguide::numeric::FindNearPairs(", Part::kDistance},
    {"cguide::numeric::PairClearance(", Part::kDistance},
    {"cguide::numeric::BodyClearance(", Part::kDistance},
    {"cguide::verify::DecideEdgeCollision(", Part::kDistance},
    {"cguide::numeric::TestPlacedStability(", Part::kStability},
    {"cguide::numeric::TryStability(", Part::kStability},
    {"cguide::numeric::FindComMargin(", Part::kStability},
    {"cguide::verify::DecideEdgeStability(", Part::kStability},
    {"cguide::planner::Project(", Part::kProjection},
    {"cguide::planner::Repair(", Part::kProjection},
    {"cguide::planner::ProjectPath(", Part::kProjection},
    {"cguide::planner::Tree::Nearest(", Part::kNeighbours},
    {"cguide::planner::Forest::Nearest", Part::kNeighbours},
    {"cguide::planner::Roadmap::Nearest(", Part::kNeighbours},
    {"cguide::ompl_adapter::GuideStateSpace::distance(", Part::kNeighbours},
    {"ompl::NearestNeighbors", Part::kNeighbours},
    {"cguide::numeric::TestSampledEdge(", Part::kOracle},
    {"cguide::verify::MakeWholeOracle(", Part::kOracle},
    {"ompl::base::DiscreteMotionValidator::checkMotion(", Part::kOracle},
};

std::optional<Part> PartOf(std::string_view name) {
  // The call operator of a lambda in MakeWholeOracle is wrapped by std::function's invoker.
  if (name.find("cguide::verify::MakeWholeOracle(") != std::string_view::npos) return Part::kOracle;
  for (const Rule& rule : kRules) {
    if (name.substr(0, rule.name.size()) == rule.name) return rule.part;
  }
  return std::nullopt;
}

struct Range {
  std::uintptr_t begin, end;
  Part part;
};

// Written before the timer starts, read by the handler, which allocates nothing.
struct State {
  std::vector<Range> ranges;
  PartCounts counts;
};
State& Shared() {
  static State state;
  return state;
}

std::uintptr_t LoadAddress() {
  std::uintptr_t base = 0;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* data) {
        *static_cast<std::uintptr_t*>(data) = info->dlpi_addr;
        return 1;  // the first object is the program
      },
      &base);
  return base;
}

std::string Demangled(const char* name) {
  int status = 0;
  char* text = abi::__cxa_demangle(name, nullptr, nullptr, &status);
  std::string result = status == 0 ? text : name;
  std::free(text);
  return result;
}

void AddSymbols(const std::vector<char>& file, const Elf64_Shdr& table, const Elf64_Shdr& strings,
                std::uintptr_t base, std::vector<Range>* ranges) {
  for (std::size_t at = 0; at + sizeof(Elf64_Sym) <= table.sh_size; at += sizeof(Elf64_Sym)) {
    Elf64_Sym symbol;
    std::memcpy(&symbol, &file.at(table.sh_offset + at), sizeof symbol);
    if (ELF64_ST_TYPE(symbol.st_info) != STT_FUNC || symbol.st_size == 0) continue;
    const auto part = PartOf(Demangled(&file.at(strings.sh_offset + symbol.st_name)));
    if (!part) continue;
    const std::uintptr_t begin = base + symbol.st_value;
    ranges->push_back({begin, begin + symbol.st_size, *part});
  }
}

std::vector<Range> ReadRanges() {
  std::ifstream stream("/proc/self/exe", std::ios::binary);
  const std::vector<char> file{std::istreambuf_iterator<char>(stream), {}};
  Elf64_Ehdr header;
  std::memcpy(&header, &file.at(0), sizeof header);
  const auto section = [&](std::size_t i) {
    Elf64_Shdr result;
    std::memcpy(&result, &file.at(header.e_shoff + i * sizeof result), sizeof result);
    return result;
  };
  std::vector<Range> ranges;
  for (std::size_t i = 0; i < header.e_shnum; ++i) {
    const Elf64_Shdr table = section(i);
    if (table.sh_type == SHT_SYMTAB) {
      AddSymbols(file, table, section(table.sh_link), LoadAddress(), &ranges);
    }
  }
  if (ranges.empty()) throw std::runtime_error("the program has no symbols to tell its parts by");
  std::sort(ranges.begin(), ranges.end(),
            [](const Range& a, const Range& b) { return a.begin < b.begin; });
  return ranges;
}

const Range* Find(const std::vector<Range>& ranges, std::uintptr_t address) {
  auto next = std::upper_bound(
      ranges.begin(), ranges.end(), address,
      [](std::uintptr_t value, const Range& range) { return value < range.begin; });
  if (next == ranges.begin()) return nullptr;
  const Range& range = *std::prev(next);
  return address < range.end ? &range : nullptr;
}

// glibc's unwinder takes no lock and allocates nothing once it has been called (2.35 on).
void OnTick(int) {
  void* frames[kDeepest];
  const int count = backtrace(frames, kDeepest);
  State& state = Shared();
  std::optional<Part> innermost;
  bool oracle = false;
  for (int i = 0; i < count; ++i) {
    const Range* range = Find(state.ranges, reinterpret_cast<std::uintptr_t>(frames[i]));
    if (!range) continue;
    if (!innermost) innermost = range->part;
    oracle = oracle || range->part == Part::kOracle;
  }
  ++state.counts.samples[static_cast<std::size_t>(innermost.value_or(Part::kRest))];
  state.counts.within_oracle += oracle;
}

void SetTimer(int microseconds) {
  itimerval timer{};
  timer.it_interval.tv_usec = timer.it_value.tv_usec = microseconds;
  setitimer(ITIMER_PROF, &timer, nullptr);
}

}  // namespace

const char* ToString(Part part) {
  constexpr const char* kNames[] = {"distance and collision",
                                    "stability",
                                    "projection, rest",
                                    "neighbours",
                                    "edges, rest",
                                    "rest"};
  return kNames[static_cast<std::size_t>(part)];
}

long PartCounts::Total() const { return std::accumulate(samples.begin(), samples.end(), 0L); }

double PartCounts::Share(Part part) const {
  const long total = Total();
  const auto count = static_cast<double>(samples[static_cast<std::size_t>(part)]);
  return total == 0 ? 0 : count / static_cast<double>(total);
}

void PartCounts::Add(const PartCounts& other) {
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] += other.samples[i];
  within_oracle += other.within_oracle;
}

void StartPartSampler() {
  State& state = Shared();
  if (state.ranges.empty()) state.ranges = ReadRanges();
  state.counts = {};
  void* frames[1];
  backtrace(frames, 1);  // loads the unwinder outside of the handler
  struct sigaction action {};
  action.sa_handler = OnTick;
  action.sa_flags = SA_RESTART;
  sigaction(SIGPROF, &action, nullptr);
  SetTimer(kPeriodMicroseconds);
}

PartCounts StopPartSampler() {
  SetTimer(0);
  return Shared().counts;
}

}  // namespace cguide::benchmark_tools
