#include "cguide/verify/sampled_audit.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "cguide/exact/core/error.h"
#include "cguide/verify/audit_report.h"
#include "tests/planner/room.h"

namespace cguide::verify {
namespace {

using numeric::Obstruction;
using test::Room;

Path PathOf(const Room& room, std::vector<Configuration> waypoints) {
  return {ColumnNames(room.problem.model.robot), std::move(waypoints)};
}

Configuration Raised(Configuration q, double height) {
  q.X_WB.p.z() += height;
  return q;
}

SampledAudit Audit(const Room& room, const Path& path, double step, int threads = 1) {
  SampledAuditOptions options;
  options.step = step;
  options.threads = threads;
  return AuditSamples(room.world, path, options);
}

TEST_CASE("a guide that stays on the floor has no violation, and its worst values are found") {
  const Room room("floor");
  const SampledAudit audit =
      Audit(room, PathOf(room, {room.problem.start, Raised(room.problem.start, 0.01)}), 0.0011);
  CHECK(audit.verdict == Verdict::kHolds);
  CHECK(audit.violations.empty());
  CHECK(audit.samples == 11);
  CHECK(audit.stability.fast == audit.samples);
  // The soles start at the height of the problem file above the floor and end 10 mm higher.
  REQUIRE(audit.clearance.known);
  CHECK(audit.clearance.at.s == 0);
  CHECK(audit.contact_gap.at.s == 1);
  CHECK(audit.contact_gap.value == Approx(audit.clearance.value + 0.01).margin(1e-9));
  CHECK(audit.com_margin.value > 0.03);
}

TEST_CASE("a lift loses balance where the contact band ends") {
  const Room room("floor");
  const Path path = PathOf(room, {room.problem.start, Raised(room.problem.start, 0.2)});
  const SampledAudit audit = Audit(room, path, 0.002);
  CHECK(audit.verdict == Verdict::kFails);
  REQUIRE(audit.violations.size() == 1);
  const Violation& v = audit.violations[0];
  CHECK(v.kind == Obstruction::kUnstable);
  CHECK(v.s_last == 1);
  const double gap = Audit(room, PathOf(room, {room.problem.start}), 1).contact_gap.value;
  CHECK(v.s_first == Approx((0.04 - gap) / 0.2).margin(0.02));
  CHECK(v.length == Approx(0.2 * (1 - v.s_first)).margin(0.01));
  CHECK(v.depth == -1);  // no contact at all: no centre of mass would do
}

TEST_CASE("contacts that are made and broken are counted, at waypoints too") {
  const Room room("floor");
  const Configuration down = room.problem.start, up = Raised(down, 0.2);
  for (const double step : {0.003, 1.0}) {  // with step 1 changes show at the waypoints alone
    const Path path = PathOf(room, {down, up, down, down});
    for (const int threads : {1, 2}) {
      const SampledAudit audit = Audit(room, path, step, threads);
      CHECK(audit.contacts_broken == 2);  // the soles
      CHECK(audit.contacts_made == 2);
    }
  }
  const SampledAudit still = Audit(room, PathOf(room, {down, Raised(down, 0.01)}), 0.001);
  CHECK(still.contacts_broken == 0);
  CHECK(still.contacts_made == 0);
}

TEST_CASE("a dip into the floor is measured: bodies, depth, stretch") {
  const Room room("floor");
  const double gap = Audit(room, PathOf(room, {room.problem.start}), 1).clearance.value;
  const Path path =
      PathOf(room, {room.problem.start, Raised(room.problem.start, -0.03), room.problem.start});
  const SampledAudit audit = Audit(room, path, 0.001);
  CHECK(audit.verdict == Verdict::kFails);
  int floor_violations = 0;
  for (const Violation& v : audit.violations) {
    if (v.kind != Obstruction::kCollision) continue;
    ++floor_violations;
    // The turning point is the last sample of edge 0; edge 1 begins one step after it.
    CHECK(v.depth == Approx(0.03 - gap).margin(v.edge == 0 ? 1e-6 : 0.00101));
    CHECK(v.length == Approx(0.03 - gap).margin(0.002));
    CHECK(room.problem.model.objects[v.pair.other].name == "floor");
    CHECK(v.s_worst == (v.edge == 0 ? Approx(1) : Approx(1.0 / 30).margin(0.01)));
  }
  CHECK(floor_violations == 4);  // two feet, down and up again
  CHECK(audit.clearance.value == Approx(gap - 0.03).margin(1e-6));
}

TEST_CASE("exact touching is left to the twins and stays undecided for real placements") {
  const Room room("floor");
  Model model = room.problem.model;
  // The floor rises to the soles: the distance is within rounding of zero.
  const double gap = Audit(room, PathOf(room, {room.problem.start}), 1).clearance.value;
  std::get<Halfspace>(model.objects[0].pieces[0].geometry).offset = gap;
  const numeric::World world(model);
  SampledAuditOptions options;
  options.step = 1;
  const SampledAudit audit = AuditSamples(world, PathOf(room, {room.problem.start}), options);
  CHECK(audit.collision.exact + audit.collision.undecided > 0);
  for (const Violation& v : audit.violations) CHECK(v.depth < 1e-9);
}

TEST_CASE("the report does not depend on the number of threads") {
  const Room room("chair_and_table");
  std::vector<Configuration> waypoints;
  for (int i = 0; i <= 12; ++i) {
    waypoints.push_back(Interpolate({room.problem.start, room.problem.goal}, i / 12.0));
  }
  const Path path = PathOf(room, waypoints);
  const AuditSubject subject{"p", "q", "d", "v"};
  const std::string one = WriteAuditJson(subject, room.problem.model, Audit(room, path, 0.01, 1));
  CHECK(one == WriteAuditJson(subject, room.problem.model, Audit(room, path, 0.01, 2)));
  // The straight way from the chair leads through the table.
  const auto json = nlohmann::json::parse(one);
  CHECK(json["verdict"] == "violated");
  CHECK(json["violations"].size() > 0);
  CHECK(json["edges"] == 12);
  CHECK(Audit(room, path, 0.01, 2).done == std::vector<char>(12, 1));
}

TEST_CASE("the text report names places, values and stages") {
  const Room room("floor");
  const Path path = PathOf(room, {room.problem.start, Raised(room.problem.start, -0.03)});
  const std::string text =
      WriteAuditText({"guide.json", "p", "d", "v"}, room.problem.model, Audit(room, path, 0.001));
  for (const char* part :
       {"guide.json: ", "violations", "sampled(0.001)", "overlap by about", "\"floor\"",
        "edge 0, s = ", "contacts of a body with an object", "by the exact twin", "undecided"}) {
    CAPTURE(part);
    CHECK(text.find(part) != std::string::npos);
  }
  CHECK(text.find("proved") == std::string::npos);
}

TEST_CASE("a file name that is not UTF-8 has its bytes replaced in the report for programs") {
  const Room room("floor");
  const Path path = PathOf(room, {room.problem.start});
  const AuditSubject subject{"a\xFF.json", "\xC3.yaml", "d", "v"};
  const auto json =
      nlohmann::json::parse(WriteAuditJson(subject, room.problem.model, Audit(room, path, 0.1)));
  CHECK(json["path"] == "a\xEF\xBF\xBD.json");
  CHECK(json["problem"] == "\xEF\xBF\xBD.yaml");
}

TEST_CASE("a path of another robot is refused") {
  const Room room("floor");
  Path path = PathOf(room, {room.problem.start});
  path.joint_names[0] = "elbow";
  CHECK_THROWS_AS(Audit(room, path, 0.1), Error);
}

}  // namespace
}  // namespace cguide::verify
