// A libFuzzer target for the readers of files; see readers.h for the form of its inputs.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "tests/fuzz/readers.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

// The tag stays; mutations are libFuzzer's, words of the dictionary and other inputs included.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned) {
  if (size < 1 || most < 2) return LLVMFuzzerMutate(data, size, most);
  return 1 + LLVMFuzzerMutate(data + 1, size - 1, most - 1);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const bool known = cguide::fuzz::ReadTagged(data, size) != cguide::fuzz::Reading::kNoReader;
    return known ? 0 : -1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "left a reader: %s\n", error.what());
    std::abort();
  }
}
