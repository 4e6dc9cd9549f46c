#include "cguide/verify/whole_audit.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/verify/certificate_writer.h"
#include "cguide/verify/whole_report.h"

namespace cguide::verify {
namespace {

struct Room {
  numeric::Problem problem =
      numeric::io::ReadProblem(CGUIDE_FIXTURES "/problems/chair_and_table.yaml");
  numeric::World world{problem.model};

  Path PathOf(std::vector<Configuration> waypoints) const {
    return {ColumnNames(problem.model.robot), std::move(waypoints)};
  }
};

}  // namespace

TEST_CASE("A path is audited edge by edge, for every s, and its report says so") {
  const Room room;
  Configuration near = room.problem.start, far = room.problem.start;
  near.joints[0] += 0.01;
  far.X_WB.p.z() -= 0.2;  // through the seat
  const Path path = room.PathOf({room.problem.start, near, room.problem.start, far});
  const WholeAudit audit = AuditWhole(room.world, path, {});
  REQUIRE(audit.edges.size() == 3);
  CHECK(audit.edges_done == 3);
  CHECK(audit.edges[0].collision.verdict == Verdict::kHolds);
  CHECK(audit.edges[0].stability.verdict == Verdict::kHolds);
  CHECK(audit.edges[2].collision.verdict == Verdict::kFails);
  CHECK(audit.verdict == Verdict::kFails);
  const AuditSubject subject{"p.json", "room.yaml", "sha256:0", "0"};
  const std::string text = WriteWholeText(subject, room.problem.model, audit);
  CHECK(text.find("2 of 3 edges proved for every s, 1 refuted") != std::string::npos);
  CHECK(text.find("edge 2") != std::string::npos);
  CHECK(audit.edges[0].proof);
  CHECK(!audit.edges[2].proof);
  const auto json = nlohmann::json::parse(WriteWholeJson(subject, room.problem.model, audit));
  CHECK(json["verdict"] == "refuted");
  CHECK(json["edges"].size() == 3);
  CHECK(json["edges"][0]["verdict"] == "proved");
}

TEST_CASE("Reports and proofs do not depend on the number of threads") {
  const Room room;
  std::vector<Configuration> waypoints{room.problem.start};
  for (int i = 0; i < 8; ++i) {
    waypoints.push_back(waypoints.back());
    waypoints.back().joints[i] += i == 5 ? 1.0 : 0.01;
  }
  const Path path = room.PathOf(waypoints);
  std::string reports[2];
  for (const int k : {0, 1}) {
    WholeAuditOptions options;
    options.threads = k == 0 ? 1 : 3;
    const WholeAudit audit = AuditWhole(room.world, path, options);
    CHECK(audit.edges_done == 8);
    reports[k] = WriteWholeText({}, room.problem.model, audit) +
                 WriteWholeJson({}, room.problem.model, audit);
    for (const EdgeFinding& edge : audit.edges) {
      if (edge.proof) reports[k] += WriteProof(*edge.proof);
    }
  }
  CHECK(reports[0] == reports[1]);
}

TEST_CASE("A refuted edge is measured: depth, length, bodies") {
  const Room room;
  Configuration far = room.problem.start;
  far.X_WB.p.z() -= 0.2;
  const WholeAudit audit = AuditWhole(room.world, room.PathOf({room.problem.start, far}), {});
  REQUIRE(!audit.edges[0].measured.empty());
  const auto deepest =
      std::max_element(audit.edges[0].measured.begin(), audit.edges[0].measured.end(),
                       [](const Violation& a, const Violation& b) { return a.depth < b.depth; });
  CHECK(deepest->depth > 0.03);
  CHECK(deepest->s_last == 1);
  const std::string text = WriteWholeText({}, room.problem.model, audit);
  CHECK(text.find("overlap by about") != std::string::npos);
}

TEST_CASE("A lone waypoint is an edge from it to itself") {
  const Room room;
  const WholeAudit audit = AuditWhole(room.world, room.PathOf({room.problem.goal}), {});
  CHECK(audit.verdict == Verdict::kHolds);
  CHECK(audit.edges.size() == 1);
}

TEST_CASE("Waypoints beyond joint limits fail the path, and a wrong path is refused") {
  const Room room;
  Configuration beyond = room.problem.start;
  beyond.joints[0] = 10;
  const WholeAudit audit = AuditWhole(room.world, room.PathOf({room.problem.start, beyond}), {});
  CHECK(audit.verdict == Verdict::kFails);
  CHECK(audit.beyond_limits == std::vector<int>{1});
  CHECK_THROWS_AS(AuditWhole(room.world, room.PathOf({}), {}), Error);
}

TEST_CASE("An interrupted audit says what it did not reach") {
  const Room room;
  const std::atomic<bool> stop{true};
  WholeAuditOptions options;
  options.interrupt = &stop;
  const WholeAudit audit = AuditWhole(room.world, room.PathOf({room.problem.start}), options);
  CHECK(audit.edges_done == 0);
  CHECK(audit.verdict == Verdict::kUndecided);
  const auto json = nlohmann::json::parse(WriteWholeJson({}, room.problem.model, audit));
  CHECK(json["verdict"] == "undecided");
  const std::string text = WriteWholeText({}, room.problem.model, audit);
  CHECK(text.find("1 not reached") != std::string::npos);
}

TEST_CASE("A path that is refuted before the interruption stays refuted") {
  const Room room;
  Configuration far = room.problem.start;
  far.X_WB.p.z() -= 0.2;
  std::atomic<bool> stop{false};
  WholeAuditOptions options;
  options.interrupt = &stop;
  options.on_progress = [&stop](int, int) { stop = true; };
  const WholeAudit audit =
      AuditWhole(room.world, room.PathOf(std::vector<Configuration>(9, far)), options);
  CHECK(audit.edges_done == 1);
  CHECK(audit.verdict == Verdict::kFails);
}

TEST_CASE("A file name that is not UTF-8 has its bytes replaced in the report for programs") {
  const Room room;
  const WholeAudit audit = AuditWhole(room.world, room.PathOf({room.problem.start}), {});
  const AuditSubject subject{"a\xFF.json", "\xC3.yaml", "d", "v"};
  const auto json = nlohmann::json::parse(WriteWholeJson(subject, room.problem.model, audit));
  CHECK(json["path"] == "a\xEF\xBF\xBD.json");
  CHECK(json["problem"] == "\xEF\xBF\xBD.yaml");
}

}  // namespace cguide::verify
