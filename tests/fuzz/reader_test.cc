#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "cguide/exact/core/error.h"
#include "tests/fuzz/readers.h"

namespace cguide::fuzz {
namespace {

const std::uint8_t* Bytes(const std::string& text) {
  return reinterpret_cast<const std::uint8_t*>(text.data());
}

}  // namespace

TEST_CASE("Every reader has a tag of its own and seeds, and but for PLY's reads one of them") {
  std::set<char> tags, seeded, reading;
  for (const Reader& reader : Readers()) CHECK(tags.insert(reader.tag).second);
  std::set<std::string> names;
  for (const Seed& seed : ReaderSeeds()) {
    CAPTURE(seed.name);
    CHECK(names.insert(seed.name).second);
    seeded.insert(seed.bytes[0]);
    const Reading read = ReadTagged(Bytes(seed.bytes), seed.bytes.size());
    CHECK(read != Reading::kNoReader);
    if (read == Reading::kRead) reading.insert(seed.bytes[0]);
  }
  CHECK(seeded == tags);
  reading.insert('P');
  CHECK(reading == tags);
  CHECK(ReadTagged(Bytes("?x"), 2) == Reading::kNoReader);
  CHECK(ReadTagged(nullptr, 0) == Reading::kNoReader);
}

TEST_CASE("Readers refuse files cut short or with a byte changed as bad input, if at all") {
  std::mt19937_64 rng(5);
  for (const Seed& seed : ReaderSeeds()) {
    if (seed.bytes.size() < 2 || seed.bytes.size() > 20000) continue;
    for (int k = 0; k < 6; ++k) {
      std::string bytes = seed.bytes;
      const std::size_t at = 1 + rng() % (bytes.size() - 1);
      if (k < 2) {
        bytes.resize(at);
      } else {
        bytes[at] = static_cast<char>(rng());
      }
      CAPTURE(seed.name, k, at);
      CHECK_NOTHROW(ReadTagged(Bytes(bytes), bytes.size()));
    }
  }
}

}  // namespace cguide::fuzz
