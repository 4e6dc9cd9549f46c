// seed_readers FOLDER: writes what the search for hostile files starts from.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "tests/fuzz/readers.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: seed_readers FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder(argv[1]);
  std::filesystem::create_directories(folder);
  for (const cguide::fuzz::Seed& seed : cguide::fuzz::ReaderSeeds()) {
    std::ofstream(folder / seed.name, std::ios::binary) << seed.bytes;
  }
  return 0;
}
