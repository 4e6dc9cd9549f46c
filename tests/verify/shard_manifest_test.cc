#include "cguide/verify/shard_manifest.h"

#include <catch2/catch.hpp>

#include "cguide/exact/core/error.h"
#include "tests/verify/shard_folder.h"

namespace cguide::verify {
namespace {

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("A manifest is read as it was written") {
  const ShardFolder folder(6, 2);
  for (int i = 1; i <= 2; ++i) {
    const ShardManifest& written = folder.manifests[static_cast<std::size_t>(i - 1)];
    const ShardManifest read = ReadManifest(folder.path() / ManifestName(i, 2));
    CHECK(read.audits == written.audits);
    CHECK(read.options == written.options);
    CHECK(read.list_digest == written.list_digest);
    CHECK(WriteManifest(read) == WriteManifest(written));
    CHECK(read.IsComplete());
  }
}

TEST_CASE("A shard is complete where each of its paths was audited to its end") {
  ShardManifest manifest = ShardFolder(5, 2).manifests[0];
  CHECK(manifest.IsComplete());
  manifest.audits[1].finished = false;
  CHECK(!manifest.IsComplete());
  manifest.audits[1].finished = true;
  manifest.audits.pop_back();
  CHECK(!manifest.IsComplete());
  manifest.listed = 4;
  CHECK(manifest.IsComplete());
  manifest.audits.erase(manifest.audits.begin());
  CHECK(!manifest.IsComplete());
  CHECK(ShardFolder(1, 3).manifests[2].IsComplete());  // a shard without paths
}

TEST_CASE("Files of a path have plain names, whatever the path is called") {
  CHECK(ReportName(7, "rooms/../a b.tar.csv") == "0007_a_b_tar.report.json");
  CHECK(CertificateName(12345, "/x/g.json") == "12345_g.certificate.json");
  CHECK(ReportName(0, "..") == "0000___.report.json");
  CHECK(ReportName(0, std::string(500, 'x')).size() < 100);
}

TEST_CASE("A damaged manifest is refused with the place") {
  ShardFolder folder(6, 2);
  const std::string good = folder.Get(ManifestName(1, 2));
  const std::pair<std::string, std::string> changes[] = {
      {"cguide-shard/1", "cguide-shard/2"},
      {"\"shard\": 1", "\"shard\": 3"},
      {"\"shard\": 1", "\"shard\": 0"},
      {"\"shards\": 2", "\"shards\": 1e99"},
      {"\"listed\": 6", "\"listed\": 4"},
      {"\"index\": 2", "\"index\": -2"},
      {"\"index\": 2", "\"index\": 0"},
      {"\"verdict\": \"refuted\"", "\"verdict\": \"sure\""},
      {"\"finished\": true", "\"finished\": 1"},
      {"0000_g0.report.json", "../0000_g0.report.json"},
      {"\"edges\": 3", "\"edges\": null"},
      {"\"path\": \"g0.json\"", "\"path\": \"h0.json\""},
      {"\"root\": \"\"", "\"root\": 1"},
      {"\"error\"", "\"mistake\""},
      {"\"listed\"", "\"list\""}};
  for (const auto& [from, to] : changes) {
    CAPTURE(from, to);
    folder.Put("shard-1-of-2.json", Replaced(good, from, to));
    CHECK_THROWS_AS(ReadManifest(folder.path() / "shard-1-of-2.json"), Error);
  }
  for (std::size_t size = 0; size + 2 < good.size(); size += 97) {
    folder.Put("shard-1-of-2.json", good.substr(0, size));
    CHECK_THROWS_AS(ReadManifest(folder.path() / "shard-1-of-2.json"), Error);
  }
}

TEST_CASE("A message that is not UTF-8 can be kept") {
  ShardManifest manifest = ShardFolder(5, 1).manifests[0];
  manifest.audits[4].error = "the name \xFF";
  ShardFolder folder(1, 1);
  folder.Put("shard-1-of-1.json", WriteManifest(manifest));
  CHECK(ReadManifest(folder.path() / "shard-1-of-1.json").audits[4].error ==
        "the name \xEF\xBF\xBD");
}

TEST_CASE("What an audit counted is taken over") {
  WholeAudit audit;
  audit.edges.resize(4);
  audit.edges[0].done = audit.edges[1].done = true;
  audit.edges[0].collision.verdict = Verdict::kFails;
  audit.edges_done = 2;
  audit.verdict = Verdict::kFails;
  audit.beyond_limits = {3};
  ListedAudit listed;
  TakeOver(audit, &listed);
  CHECK(listed.verdict == ListedVerdict::kRefuted);
  CHECK(!listed.finished);
  CHECK(listed.edges == 4);
  CHECK(listed.refuted == 1);
  CHECK(listed.undecided == 1);
  CHECK(listed.waypoints_beyond_limits == 1);
  audit.verdict = Verdict::kUndecided;
  TakeOver(audit, &listed);
  CHECK(listed.verdict == ListedVerdict::kInterrupted);
}

}  // namespace cguide::verify
