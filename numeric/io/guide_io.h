#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "cguide/exact/core/path.h"

namespace cguide::numeric::io {

/** A guide file (schema cguide-guide/1). */
struct Guide {
  Path path;
  std::string problem_file;  ///< as given when it was planned, relative to the guide's folder
  std::string model_digest;
  std::string problem_digest;
  std::string tool_version;
  std::uint64_t seed = 0;
  std::string edges;  ///< how the edges were tested: "sampled(0.01)"
  bool start_projected = false;
  bool goal_projected = false;
  std::map<std::string, long> counters;  ///< iterations, nodes ...; no times
};

/** The text of a guide file: shortest round-trip doubles, keys in a fixed order, one waypoint a
 * line. */
std::string WriteGuide(const Guide& guide);

/** @throws Error (kBadInput, kIo) with file, JSON pointer, cause, remedy. */
Guide ReadGuide(const std::filesystem::path& file);

/** A foreign path: CSV with header x,y,z,qx,qy,qz,qw,<joint names in any order>, columns brought
 into the robot's order. */
Path ReadPathCsv(const std::filesystem::path& file, const Robot& robot);
std::string WritePathCsv(const Path& path);

/** The canonical model as text (JSON, schema cguide-model/1): shortest round-trip doubles, keys in
 a fixed order; ReadModel(WriteModel(m)) == m. */
std::string WriteModel(const Model& model);
Model ReadModel(const std::filesystem::path& file);

/** "sha256:" and 64 hex digits. */
std::string Digest(std::string_view bytes);

/** Writes beside the file and renames, so that a reader sees the old text or the new one.
 @throws Error (kIo). */
void WriteFileAtomically(const std::filesystem::path& file, std::string_view bytes);

}  // namespace cguide::numeric::io
