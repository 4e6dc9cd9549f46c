#include "cguide/verify/shard_merge.h"

#include <catch2/catch.hpp>

#include "cguide/exact/core/error.h"
#include "tests/verify/shard_folder.h"

namespace cguide::verify {
namespace {

/** What MergeShards says; empty where it merges. */
std::string RefusalOf(const ShardFolder& folder, int shards) {
  try {
    MergeShards(folder.path(), shards);
  } catch (const Error& e) {
    CHECK(e.code() == Error::Code::kBadInput);
    return e.what();
  }
  return {};
}

void CheckRefused(const ShardFolder& folder, const std::string& file, const std::string& why) {
  const std::string refusal = RefusalOf(folder, 3);
  CAPTURE(refusal);
  CHECK(refusal.find(file) != std::string::npos);
  CHECK(refusal.find(why) != std::string::npos);
  CHECK(refusal.find("; ") != std::string::npos);  // and what to do
}

}  // namespace

TEST_CASE("The summary does not depend on the shards") {
  for (const int count : {1, 2, 7}) {
    std::string json, text;
    for (const int shards : {1, 2, 3, 5}) {
      const ShardFolder folder(count, shards);
      const ListSummary summary = MergeShards(folder.path(), shards);
      REQUIRE(static_cast<int>(summary.audits.size()) == count);
      for (int k = 0; k < count; ++k) CHECK(summary.audits[static_cast<std::size_t>(k)].index == k);
      if (json.empty()) json = WriteSummaryJson(summary);
      if (text.empty()) text = WriteSummaryText(summary.audits);
      CHECK(WriteSummaryJson(summary) == json);
      CHECK(WriteSummaryText(summary.audits) == text);
    }
  }
}

TEST_CASE("The summary counts verdicts and says what is wrong with each path") {
  const ShardFolder folder(6, 2);
  const ListSummary summary = MergeShards(folder.path(), 2);
  const std::string text = WriteSummaryText(summary.audits);
  CHECK(text.starts_with("6 paths audited: 4 proved, 1 refuted, 1 bad input\n"));
  CHECK(text.find("  2  refuted      g2.json: 2 of 3 edges proved, 1 refuted\n") !=
        std::string::npos);
  CHECK(text.find("  4  bad input    g4.json: it is damaged\n") != std::string::npos);
  const std::string json = WriteSummaryJson(summary);
  CHECK(json.find("\"cguide-summary/1\"") != std::string::npos);
  CHECK(json.find("\"verdict\": \"bad_input\"") != std::string::npos);
}

TEST_CASE("The worst verdict is that of the list") {
  std::vector<ListedAudit> audits(2);
  CHECK(WorstOf({}) == ListedVerdict::kProved);
  CHECK(WorstOf(audits) == ListedVerdict::kProved);
  for (const ListedVerdict worse :
       {ListedVerdict::kUndecided, ListedVerdict::kInterrupted, ListedVerdict::kRefuted,
        ListedVerdict::kBadInput, ListedVerdict::kInternalError}) {
    audits.push_back(audits.front());
    audits.back().verdict = worse;
    CHECK(WorstOf(audits) == worse);
  }
  audits.resize(2);
  audits[0].finished = false;
  CHECK(WorstOf(audits) == ListedVerdict::kInterrupted);
}

TEST_CASE("A missing shard is named, with the run that is to make it") {
  const ShardFolder folder(7, 3);
  std::filesystem::remove(folder.path() / "shard-2-of-3.json");
  CheckRefused(folder, "shard-2-of-3.json", "--shard 2/3");
}

TEST_CASE("Shards of another division, and copies under another name, are refused") {
  ShardFolder folder(7, 3);
  folder.Put("shard-1-of-2.json", folder.Get("shard-1-of-3.json"));
  CheckRefused(folder, "shard-1-of-2.json", "another division");
  std::filesystem::remove(folder.path() / "shard-1-of-2.json");
  folder.Put("shard-4-of-3.json", "");
  CheckRefused(folder, "shard-4-of-3.json", "another division");
  std::filesystem::remove(folder.path() / "shard-4-of-3.json");
  CHECK(RefusalOf(folder, 3).empty());
  folder.Put("shard-3-of-3.json", folder.Get("shard-1-of-3.json"));
  CheckRefused(folder, "shard-3-of-3.json", "it holds shard 1/3");
}

TEST_CASE("Files that are no shards do not matter") {
  ShardFolder folder(7, 3);
  for (const char* name : {"shard-1-of-2.json~", "shard-01-of-2.json", "shard--1-of-2.json",
                           "shard-x-of-2.json", "summary.json", "shard-1-of-99999999999.json"}) {
    folder.Put(name, "");
  }
  CHECK(RefusalOf(folder, 3).empty());
}

TEST_CASE("Shards of another list, version or options are refused") {
  ShardFolder folder(7, 3);
  const ShardManifest good = folder.manifests[1];
  const auto altered = [&](auto alter, const std::string& why) {
    folder.manifests[1] = good;
    alter(&folder.manifests[1]);
    folder.Write(2);
    CheckRefused(folder, "shard-2-of-3.json", why);
  };
  altered([](ShardManifest* m) { m->list_digest = "sha256:0"; }, "another content");
  altered([](ShardManifest* m) { m->listed = 8; }, "another content");
  altered([](ShardManifest* m) { m->tool_version = "2"; }, "version 2");
  altered([](ShardManifest* m) { m->options["root"] = "0,0,0,0,0,0,1"; }, "options");
  altered([](ShardManifest* m) { m->options["speed"] = "1"; }, "options");
}

TEST_CASE("Shards that overlap, or lack a path or its end, are refused") {
  ShardFolder folder(7, 3);
  const ShardManifest good = folder.manifests[0];
  const auto altered = [&](auto alter, const std::string& why) {
    folder.manifests[0] = good;
    alter(&folder.manifests[0]);
    folder.Write(1);
    CheckRefused(folder, "shard-1-of-3.json", why);
  };
  altered([&](ShardManifest* m) { m->audits[1] = folder.manifests[1].audits[1]; },
          "belongs to shard 2/3");
  altered([](ShardManifest* m) { m->audits.pop_back(); }, "path 6 of the list was not audited");
  altered([](ShardManifest* m) { m->audits.clear(); }, "path 0 of the list was not audited");
  altered([](ShardManifest* m) { m->audits.erase(m->audits.begin() + 1); }, "path 3 of the list");
  altered([](ShardManifest* m) { m->audits[2].finished = false; }, "was interrupted");
}

TEST_CASE("Paths that are not those of the list are seen by its digest") {
  ShardFolder folder(7, 3);
  folder.manifests[0].audits[1].input.path_digest = "sha256:x";
  folder.Write(1);
  CheckRefused(folder, "cguide_shard_folder", "not those of the list");
}

TEST_CASE("Reports and certificates that are gone or altered are refused") {
  for (const char* name : {"0003_g3.report.json", "0003_g3.certificate.json"}) {
    ShardFolder folder(7, 3);
    const std::string good = folder.Get(name);
    folder.Put(name, good + " ");
    CheckRefused(folder, name, "not what the audit wrote");
    std::filesystem::remove(folder.path() / name);
    CheckRefused(folder, name, "missing");
    folder.Put(name, good);
    CHECK(RefusalOf(folder, 3).empty());
  }
}

TEST_CASE("A manifest that says better than its report is refused") {
  ShardFolder folder(7, 3);
  folder.manifests[2].audits[0].verdict = ListedVerdict::kProved;
  folder.Write(3);
  CheckRefused(folder, "0002_g2.report.json", "the manifest says \"proved\"");
}

TEST_CASE("A folder that is none, and a damaged shard, are refused") {
  CHECK_THROWS_AS(MergeShards("/no/such/folder", 1), Error);
  ShardFolder folder(7, 3);
  folder.Put("shard-2-of-3.json", folder.Get("shard-2-of-3.json").substr(0, 200));
  CheckRefused(folder, "shard-2-of-3.json", "damaged");
}

}  // namespace cguide::verify
