#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "cguide/verify/ci_report.h"
#include "tests/verify/every_outcome.h"

namespace cguide::verify {
namespace {

using nlohmann::json;

std::string Text(const std::string& file) {
  return WriteSarif({file, "room.yaml", "sha256:0", "1"},
                    ChecksOf(test::HostileModel(), test::EveryOutcome()));
}

json Run(const std::string& file = "g.json") { return json::parse(Text(file))["runs"][0]; }

std::set<std::string> Keys(const json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

// Sections are those of SARIF 2.1.0; its schema allows no other keys than the ones it knows.
TEST_CASE("the log has the required properties of the specification and no unknown ones") {
  const json log = json::parse(Text("g.json"));
  CHECK(Keys(log) == std::set<std::string>{"$schema", "version", "runs"});  // 3.13
  CHECK(log["version"] == "2.1.0");
  REQUIRE(log["runs"].size() == 1);
  const json& run = log["runs"][0];
  CHECK(Keys(run) == std::set<std::string>{"tool", "invocations", "artifacts", "results",
                                           "columnKind", "properties"});  // 3.14
  const json& driver = run["tool"]["driver"];                             // 3.18, 3.19
  CHECK(Keys(driver) == std::set<std::string>{"name", "version", "rules"});
  std::set<std::string> ids;
  for (const json& rule : driver["rules"]) {  // 3.49
    CHECK(Keys(rule) ==
          std::set<std::string>{"id", "name", "shortDescription", "defaultConfiguration"});
    CHECK(ids.insert(rule["id"].get<std::string>()).second);
    CHECK(rule["shortDescription"]["text"].get<std::string>().back() == '.');  // 3.49.9
  }
  CHECK(run["columnKind"] == "utf16CodeUnits");
  for (const json& result : run["results"]) {  // 3.27
    CHECK(Keys(result) == std::set<std::string>{"ruleId", "ruleIndex", "level", "message",
                                                "locations", "properties"});
    const json& rule = driver["rules"][result["ruleIndex"].get<std::size_t>()];
    CHECK(rule["id"] == result["ruleId"]);  // 3.27.6
    CHECK(rule["defaultConfiguration"]["level"] == result["level"]);
    CHECK_FALSE(result["message"]["text"].get<std::string>().empty());  // 3.11.7
    REQUIRE(result["locations"].size() == 1);
    const json& location = result["locations"][0];  // 3.28
    CHECK(Keys(location) == std::set<std::string>{"physicalLocation", "logicalLocations"});
    const json& file = location["physicalLocation"]["artifactLocation"];  // 3.4
    CHECK(run["artifacts"][file["index"].get<std::size_t>()]["location"]["uri"] == file["uri"]);
    CHECK(location["logicalLocations"][0]["name"] ==
          "edge " + std::to_string(result["properties"]["edge"].get<int>()));
  }
}

TEST_CASE("refuted obligations are errors with their rule, undecided ones warnings") {
  const json run = Run();
  const json& results = run["results"];
  REQUIRE(results.size() == 6);
  const char* ids[6] = {"CG002", "CG002", "CG001", "CG005", "CG004", "CG005"};
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(results[i]["ruleId"] == ids[i]);
    const bool open = std::string(ids[i]) == "CG005";
    CHECK(results[i]["level"] == (open ? "warning" : "error"));
    CHECK(results[i]["properties"]["verdict"] == (open ? "undecided" : "fails"));
  }
  CHECK(results[2]["properties"]["s"] == 0.375);
  CHECK(results[2]["properties"]["bodies"].size() == 2);
  CHECK(results[5]["properties"]["obligation"] == "balance");
  CHECK(run["invocations"][0]["executionSuccessful"] == false);  // 3.20.14
  const json& notice = run["invocations"][0]["toolExecutionNotifications"][0];
  CHECK(notice["message"]["text"] == "the audit was interrupted; edges not reached: 1");
}

TEST_CASE("a complete audit without findings has an empty list of results") {
  WholeAudit audit;
  audit.edges.resize(1);
  audit.edges[0].done = true;
  audit.edges[0].proof.emplace();
  audit.edges_done = 1;
  const json run =
      json::parse(WriteSarif({"g", "", "", "1"}, ChecksOf(test::HostileModel(), audit)));
  CHECK(run["runs"][0]["results"] == json::array());
  CHECK(run["runs"][0]["invocations"][0]["executionSuccessful"] == true);
}

TEST_CASE("file names become URIs whatever their bytes") {
  const auto uri = [](const std::string& file) {
    return Run(file)["artifacts"][0]["location"]["uri"].get<std::string>();
  };
  CHECK(uri("a/b-c_d.e~f/9.json") == "a/b-c_d.e~f/9.json");
  CHECK(uri("../a b.json") == "../a%20b.json");
  CHECK(uri("http:x") == "http%3Ax");
  CHECK(uri("/tmp/a#b?") == "file:///tmp/a%23b%3F");
  CHECK(uri("//tmp/a") == "file:///tmp/a");
  CHECK(uri("\xff%\n\"") == "%FF%25%0A%22");
}

TEST_CASE("names of any bytes stay valid JSON, and the same audit gives the same bytes") {
  const std::string text = Text(test::kHostileName);
  CHECK(text == Text(test::kHostileName));
  const json run = json::parse(text)["runs"][0];
  const std::string name = run["results"][2]["properties"]["bodies"][0];
  CHECK(name.find("a<b>&\"'\\]]>\t\n\xEF\xBF\xBD\xEF\xBF\xBD") == 0);
}

}  // namespace
}  // namespace cguide::verify
