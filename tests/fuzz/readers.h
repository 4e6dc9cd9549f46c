#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

// The readers of files as one fuzzed function. The first byte of an input is the tag of a reader,
// the rest is the file. A mutator keeps tags, so that files of one kind breed files of that kind.
namespace cguide::fuzz {

/** Where the files of a reader that start a search come from: those of `folder` (below fixtures/)
 with the extension. */
struct SeedFolder {
  const char* folder;
  const char* extension;
};

struct Reader {
  char tag;
  const char* name;
  const char* extension;  ///< of the files it is given
  void (*read)(const std::filesystem::path&);
  std::vector<SeedFolder> seeds;
};

const std::vector<Reader>& Readers();

/** The reader with this tag, or null. */
const Reader* FindReader(char tag);

enum class Reading { kNoReader, kRefused, kRead };

/** Whatever the file, a reader answers or throws cguide::Error of bad input; anything else leaves
 as an exception. Files stand in a folder of this process, with robots, scenes and meshes for those
 that refer to others. */
Reading ReadTagged(const std::uint8_t* data, std::size_t size);

/** A tagged input. */
struct Seed {
  std::string name;
  std::string bytes;
};

/** The fixtures of every reader, and files that our own writers wrote where there are none. Files
 beyond 64 kB are left out: searches would only mutate their middle. */
std::vector<Seed> ReaderSeeds();

}  // namespace cguide::fuzz
