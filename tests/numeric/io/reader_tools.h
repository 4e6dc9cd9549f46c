#pragma once

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/mesh_reader.h"

namespace cguide::numeric::io {

inline std::filesystem::path Fixture(const std::string& name) {
  return std::filesystem::path(CGUIDE_FIXTURES) / name;
}

/** The folder of third-party data, or nothing and a warning. */
inline std::optional<std::filesystem::path> SharedData(const std::string& part) {
  const char* set = std::getenv("CGUIDE_SHARED_DATA");
  const std::filesystem::path folder =
      set != nullptr ? std::filesystem::path(set)
                     : std::filesystem::path(CGUIDE_SOURCE_DIR) / ".." / "shared";
  if (std::filesystem::is_directory(folder / part)) return folder;
  WARN("skipped: no third-party data in " << (folder / part) << "; set CGUIDE_SHARED_DATA");
  return std::nullopt;
}

/** A folder of its own, removed at the end. */
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "cguide_test_XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /** Writes a file, with the folders above it. */
  std::filesystem::path Write(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }

 private:
  std::filesystem::path path_;
};

inline std::string ReadText(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/** The message of the Error that `call` throws, with its code; nothing where it throws none. Any
 other exception passes. */
struct Refusal {
  std::string message;
  Error::Code code;
};
template <typename Call>
std::optional<Refusal> RefusalOf(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return Refusal{error.what(), error.code()};
  }
  return std::nullopt;
}

/** Six times the signed volume that the triangles enclose; positive where they face outwards. */
inline double SixVolumes(const std::vector<Eigen::Vector3d>& vertices,
                         const std::vector<std::array<int, 3>>& triangles) {
  double sum = 0;
  for (const auto& [a, b, c] : triangles) {
    Eigen::Matrix3d m;
    m << vertices[a], vertices[b], vertices[c];
    sum += m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1)) -
           m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0)) +
           m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0));
  }
  return sum;
}

}  // namespace cguide::numeric::io
