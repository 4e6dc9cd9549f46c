// A libFuzzer target for one pair of twins, named by CGUIDE_FUZZ_CHECK.
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/twins.h"

namespace {

cguide::fuzz::Tally& Totals() {
  static cguide::fuzz::Tally totals;
  return totals;
}

void PrintTotals() {
  const cguide::fuzz::Tally& t = Totals();
  std::fprintf(stderr,
               "%ld cases: %ld fast, %ld exact, %ld open, %ld checked by an independent solver\n",
               t.cases, t.fast, t.exact, t.open, t.checked);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  Totals();
  std::atexit(&PrintTotals);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  cguide::fuzz::ByteStream in(data, size);
  const bool thorough = Totals().cases % 64 == 0;
  const std::string wrong = cguide::fuzz::CGUIDE_FUZZ_CHECK(in, thorough, &Totals());
  if (wrong.empty()) return 0;
  std::fprintf(stderr, "wrong: %s\n", wrong.c_str());
  std::abort();
}
