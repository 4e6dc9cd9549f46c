// Motions as a recording has them: feet on the floor at z = 0, a hair or some tenths of a
// millimetre in or above it (fixtures/paths).
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/verify/audit_report.h"
#include "cguide/verify/certificate_writer.h"
#include "cguide/verify/whole_report.h"

namespace cguide::verify {
namespace {

struct Recording {
  explicit Recording(const std::string& name)
      : path(numeric::io::ReadPathCsv(CGUIDE_FIXTURES "/paths/" + name + ".csv", model.robot)) {}

  Model model = numeric::io::ReadProblem(CGUIDE_FIXTURES "/problems/recorded.yaml").model;
  Path path;
};

WholeAudit Audit(const Model& model, const Path& path) {
  const numeric::World world(model);
  return AuditWhole(world, path, {});
}

/** Height of a sole above z = 0 where the legs are straight and the root stands upright: a sum of
 doubles, taken over Q. */
Rational SoleOfStraightLeg(const Robot& robot, const Configuration& q, const std::string& foot) {
  Rational z = Lift(q.X_WB.p.z());
  std::size_t link = 0;
  while (robot.links[link].name != foot) ++link;
  const LinkShape& sole = robot.links[link].shapes.at(0);
  z += Lift(sole.X_LS.p.z()) - Lift(std::get<Box>(sole.geometry).size.z()) / 2;
  for (; link > 0; link = static_cast<std::size_t>(robot.joints[link - 1].parent)) {
    z += Lift(robot.joints[link - 1].X_PJ.p.z());
  }
  return z;
}

Path Lifted(Path path, double height) {
  for (Configuration& q : path.waypoints) q.X_WB.p.z() += height;
  return path;
}

/** Both feet are named, and what to do. */
void CheckReason(const Model& model, const WholeAudit& audit) {
  const std::string text = WriteWholeText({}, model, audit);
  CAPTURE(text);
  for (const char* foot : {"RLEG_JOINT5", "LLEG_JOINT5"}) {
    const std::size_t hint = text.find(std::string("\n  \"") + foot + "\" and \"floor\"");
    REQUIRE(hint != std::string::npos);
    const std::string line = text.substr(hint, text.find('\n', hint + 1) - hint);
    CHECK((line.find("touch") != std::string::npos || line.find("overlap") != std::string::npos));
    CHECK(line.find("contact.skin_m") != std::string::npos);
  }
  const auto json = nlohmann::json::parse(WriteWholeJson({}, model, audit));
  CHECK(json["hints"].size() == 2);
}

}  // namespace

TEST_CASE("Soles of straight legs lie a hair below the floor, which no double can mend") {
  const Recording standing("standing");
  for (const Configuration& q : standing.path.waypoints) {
    for (const char* foot : {"RLEG_JOINT5", "LLEG_JOINT5"}) {
      const Rational z = SoleOfStraightLeg(standing.model.robot, q, foot);
      CHECK(z < 0);
      CHECK(z > Lift(-0x1p-54));
      Configuration above = q;
      above.X_WB.p.z() = std::nextafter(q.X_WB.p.z(), 1);
      CHECK(SoleOfStraightLeg(standing.model.robot, above, foot) > 0);
    }
  }
}

TEST_CASE("With a skin of 1 mm recorded motions are proved, and the checker agrees") {
  for (const char* name : {"standing", "squatting"}) {
    const Recording recording(name);
    CHECK(recording.model.contact.skin == 0.001);
    const WholeAudit audit = Audit(recording.model, recording.path);
    CHECK(audit.verdict == Verdict::kHolds);
    std::vector<const check::EdgeProof*> proofs;
    for (const EdgeFinding& edge : audit.edges) {
      REQUIRE(edge.proof);
      proofs.push_back(&*edge.proof);
    }
    const std::string text = WriteCertificate(recording.model, recording.path, "test", proofs);
    CHECK(check::CheckCertificate(check::ParseCertificate(text)).IsProved());
    CHECK(check::CheckCertificate(check::ParseCertificate(text), {128}).IsProved());
    CHECK(WriteWholeText({}, recording.model, audit).find("skin of 1 mm") != std::string::npos);
  }
}

TEST_CASE(
    "Without a skin, or where the feet may not touch, they are not, and the report says why") {
  for (const char* name : {"standing", "squatting"}) {
    for (const bool listed : {true, false}) {
      if (!listed && std::string(name) == "standing") continue;  // ties are slow, and asked above
      CAPTURE(name, listed);
      Recording recording(name);
      if (listed) {
        recording.model.contact.skin = 0;
      } else {
        recording.model.contact.may_touch.clear();
      }
      const WholeAudit audit = Audit(recording.model, recording.path);
      CHECK(audit.verdict != Verdict::kHolds);
      CheckReason(recording.model, audit);
      CHECK((WriteWholeText({}, recording.model, audit).find("contact.may_touch") ==
             std::string::npos) == listed);
    }
  }
}

TEST_CASE("A skin thinner than the noise does not do") {
  Recording recording("squatting");
  recording.model.contact.skin = 1e-4;
  const WholeAudit audit = Audit(recording.model, recording.path);
  CHECK(audit.verdict == Verdict::kFails);
  CheckReason(recording.model, audit);
}

TEST_CASE(
    "A hair above the floor is undecided without a skin, never refuted; a hair below never holds") {
  Recording standing("standing");
  standing.model.contact.skin = 0;
  // 2^-53 is one step of the root's height: the truth is 1e-16 m above the floor, and balanced.
  const WholeAudit above = Audit(standing.model, Lifted(standing.path, 0x1p-53));
  CHECK(above.verdict != Verdict::kFails);
  if (above.verdict == Verdict::kUndecided) {
    const std::string text = WriteWholeText({}, standing.model, above);
    CHECK(text.find("touch within rounding; if they are meant to touch") != std::string::npos);
  }
  const WholeAudit below = Audit(standing.model, Lifted(standing.path, -0x1p-53));
  CHECK(below.verdict != Verdict::kHolds);
  CheckReason(standing.model, below);
  CHECK(Audit(standing.model, Lifted(standing.path, 1e-9)).verdict == Verdict::kHolds);
  CHECK(Audit(standing.model, Lifted(standing.path, -1e-9)).verdict == Verdict::kFails);
}

TEST_CASE("The squatting motion goes into and above the floor by tenths of a millimetre") {
  Recording squatting("squatting");
  squatting.model.contact.skin = 0;
  const numeric::World world(squatting.model);
  SampledAuditOptions options;
  options.step = 0.005;
  const SampledAudit audit = AuditSamples(world, squatting.path, options);
  CHECK(audit.clearance.value < -1.5e-4);
  CHECK(audit.clearance.value > -2.5e-4);
  CHECK(audit.contact_gap.value > 5e-5);
  CHECK(audit.contact_gap.value < 2e-4);
  CHECK(WriteAuditText({}, squatting.model, audit).find("contact.skin_m") != std::string::npos);
}

}  // namespace cguide::verify
