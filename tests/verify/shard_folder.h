#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "cguide/numeric/io/guide_io.h"
#include "cguide/verify/shard_manifest.h"

namespace cguide::verify {

/** A folder that an audit of `count` paths in `shards` shards could have left; path 2, where there
 is one, is refuted, path 4 bad input. Removed at the end. */
class ShardFolder {
 public:
  ShardFolder(int count, int shards)
      : path_(std::filesystem::temp_directory_path() /
              ("cguide_shard_folder_" + std::to_string(::getpid()) + "_" +
               std::to_string(reinterpret_cast<std::uintptr_t>(this)))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directory(path_);
    std::vector<ListedInput> inputs;
    for (int k = 0; k < count; ++k) inputs.push_back(InputOf(k));
    for (int i = 1; i <= shards; ++i) {
      ShardManifest manifest{"1", i, shards, count, DigestOf(inputs), {{"root", ""}}, {}};
      for (int k = i - 1; k < count; k += shards) manifest.audits.push_back(Audit(k));
      manifests.push_back(manifest);
    }
    for (int i = 1; i <= shards; ++i) Write(i);
  }
  ~ShardFolder() { std::filesystem::remove_all(path_); }
  ShardFolder(const ShardFolder&) = delete;
  ShardFolder& operator=(const ShardFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /** Writes manifest i, counted from 1, as it stands in `manifests`. */
  void Write(int i) {
    const ShardManifest& manifest = manifests[static_cast<std::size_t>(i - 1)];
    Put(ManifestName(i, static_cast<int>(manifests.size())), WriteManifest(manifest));
  }

  void Put(const std::string& name, const std::string& text) {
    std::ofstream(path_ / name, std::ios::binary) << text;
  }

  std::string Get(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(path_ / name, std::ios::binary).rdbuf();
    return text.str();
  }

  std::vector<ShardManifest> manifests;

 private:
  static ListedInput InputOf(int k) {
    const std::string number = std::to_string(k);
    return {"g" + number + ".json", "room.yaml", "sha256:" + number, k == 4 ? "" : "sha256:m"};
  }

  ListedAudit Audit(int k) {
    ListedAudit audit;
    audit.index = k;
    audit.input = InputOf(k);
    if (k == 4) {
      audit.verdict = ListedVerdict::kBadInput;
      audit.error = "g4.json: it is damaged";
      return audit;
    }
    audit.verdict = k == 2 ? ListedVerdict::kRefuted : ListedVerdict::kProved;
    audit.edges = 3;
    audit.refuted = k == 2;
    audit.proved = audit.edges - audit.refuted;
    const std::string report = std::string("{\"verdict\": \"") + NameOf(audit.verdict) + "\"}";
    const std::string certificate = "proofs of " + std::to_string(k);
    audit.report_digest = numeric::io::Digest(report);
    audit.certificate_digest = numeric::io::Digest(certificate);
    Put(ReportName(k, audit.input.path), report);
    Put(CertificateName(k, audit.input.path), certificate);
    return audit;
  }

  std::filesystem::path path_;
};

}  // namespace cguide::verify
