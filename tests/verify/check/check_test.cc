#include "cguide/verify/check/check.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <random>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/membership.h"
#include "cguide/verify/certificate_writer.h"
#include "cguide/verify/edge_audit.h"

namespace cguide::verify {
namespace {

using nlohmann::json;
using Rng = std::mt19937_64;

/** A path of two short edges in the room with chair and table, both proved. */
struct Proved {
  numeric::Problem problem =
      numeric::io::ReadProblem(CGUIDE_FIXTURES "/problems/chair_and_table.yaml");
  numeric::World world{problem.model};
  Path path;
  std::vector<EdgeFinding> findings;
  std::string text;

  Proved() {
    const Configuration& q = problem.start;
    path = {ColumnNames(problem.model.robot), {q, q, q}};
    path.waypoints[1].joints[0] += 0.02;
    path.waypoints[1].X_WB.p.z() += 0.0005;
    path.waypoints[2].joints[3] += 0.01;
    EdgeAuditor auditor(world);
    std::vector<const check::EdgeProof*> proofs;
    for (int i = 0; i < 2; ++i) {
      findings.push_back(auditor.Audit(i, check::EdgesOf(path)[i]));
      REQUIRE(findings.back().refusal == "");
      REQUIRE(findings.back().proof);
    }
    for (const EdgeFinding& finding : findings) proofs.push_back(&*finding.proof);
    text = WriteCertificate(problem.model, path, "test", proofs);
  }
};

enum class Outcome { kProved, kIncomplete, kRefused, kUnreadable };

Outcome CheckText(const std::string& text, check::Certificate* read) {
  try {
    *read = check::ParseCertificate(text);
    const check::CheckReport report = check::CheckCertificate(*read);
    if (!report.refused.empty()) return Outcome::kRefused;
    return report.IsProved() ? Outcome::kProved : Outcome::kIncomplete;
  } catch (const Error&) {
    return Outcome::kUnreadable;
  }
}

Outcome CheckText(const std::string& text) {
  check::Certificate read;
  return CheckText(text, &read);
}

json Altered(Rng& rng, const json& value) {
  if (value.is_boolean()) return !value.get<bool>();
  if (value.is_string()) return value.get<std::string>() + "x";
  const double x = value.get<double>();
  if (value.is_number_integer()) {
    const auto n = value.get<long>();
    const long choices[] = {n + 1, n - 1, 0, 7, 1000000, -1};
    return choices[rng() % 6];
  }
  const double choices[] = {x + 1e-3, x - 1e-3, x * 1.01, -x,
                            0,        x + 0.1,  x * 1e6,  std::nextafter(x, 9e9),
                            x - 0.05, 2 * x};
  return choices[rng() % 10];
}

/** The real path of a mutant is refuted at one of many instants: a checker that accepts it is
 * wrong.
 */
bool IsRefuted(const check::Certificate& mutant) {
  const numeric::World world(mutant.model);
  numeric::GuideWorkspace workspace(world);
  for (const Edge& edge : check::EdgesOf(mutant.path)) {
    for (int k = 0; k <= 16; ++k) {
      const Configuration q = Interpolate(edge, k / 16.0);
      if (TestConfiguration(world, q, numeric::Space::kGuide, &workspace).verdict ==
          Verdict::kFails) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

TEST_CASE("A certificate is accepted as written, in doubles and in 128 and 256 bits") {
  const Proved proved;
  const check::Certificate certificate = check::ParseCertificate(proved.text);
  CHECK(certificate.model == proved.problem.model);
  CHECK(certificate.path.waypoints == proved.path.waypoints);
  for (const int bits : {0, 53, 128, 256}) {
    const check::CheckReport report = check::CheckCertificate(certificate, {bits});
    CHECK(report.refused == std::vector<std::string>{});
    CHECK(report.proved == 2);
    CHECK(report.IsProved());
  }
}

TEST_CASE("Every alteration is refused or leaves a true statement") {
  const Proved proved;
  const json whole = json::parse(proved.text);
  const json flat = whole.flatten();
  std::vector<std::string> proofs, statements;
  for (const auto& [pointer, value] : flat.items()) {
    if (value.is_null() || !value.is_primitive()) continue;
    (pointer.rfind("/proofs", 0) == 0 ? proofs : statements).push_back(pointer);
  }
  REQUIRE(proofs.size() > 100);
  Rng rng(7);
  int refused = 0, accepted = 0, wrong = 0;
  const auto mutate = [&](const std::string& pointer) {
    json mutant = whole;
    json& value = mutant[json::json_pointer(pointer)];
    value = Altered(rng, value);
    check::Certificate read;
    const Outcome outcome = CheckText(mutant.dump(), &read);
    ++(outcome == Outcome::kProved ? accepted : refused);
    const bool is_wrong = outcome == Outcome::kProved && IsRefuted(read);
    wrong += is_wrong;
    if (is_wrong) UNSCOPED_INFO("accepted, yet refuted: " + pointer);
  };
  for (int k = 0; k < 250; ++k) mutate(proofs[rng() % proofs.size()]);
  for (int k = 0; k < 250; ++k) mutate(statements[rng() % statements.size()]);
  // Waypoints are few among the numbers of the model, and where the statement mostly breaks.
  for (int k = 0; k < 100; ++k) {
    mutate("/path/waypoints/" + std::to_string(rng() % 3) + "/" + std::to_string(rng() % 37));
  }
  CAPTURE(refused, accepted);
  CHECK(wrong == 0);
  CHECK(refused > 100);
  CHECK(accepted > 50);
}

TEST_CASE("Whatever of a proof is needed cannot be left out") {
  const Proved proved;
  const json whole = json::parse(proved.text);
  SECTION("all nodes of an edge") {
    json mutant = whole;
    mutant["proofs"][0]["tree"] = json::object();
    CHECK(CheckText(mutant.dump()) == Outcome::kRefused);
  }
  SECTION("one force") {
    json mutant = whole;
    json* node = &mutant["proofs"][0]["tree"];
    while (!node->contains("balance")) node = &(*node)["halves"][0];
    (*node)["balance"]["forces"].erase(0);
    CHECK(CheckText(mutant.dump()) == Outcome::kRefused);
  }
  SECTION("a half") {
    json mutant = whole;
    mutant["proofs"][0]["tree"]["halves"] = json::array({json::object()});
    CHECK(CheckText(mutant.dump()) == Outcome::kUnreadable);
  }
  SECTION("an edge") {
    json mutant = whole;
    mutant["proofs"].erase(0);
    CHECK(CheckText(mutant.dump()) == Outcome::kIncomplete);
  }
  SECTION("an edge given twice, or out of order") {
    json mutant = whole;
    mutant["proofs"].push_back(mutant["proofs"][0]);
    CHECK(CheckText(mutant.dump()) == Outcome::kUnreadable);
  }
  SECTION("the proof of another edge") {
    json mutant = whole;
    mutant["path"]["waypoints"][1][2] = mutant["path"]["waypoints"][1][2].get<double>() - 0.05;
    CHECK(CheckText(mutant.dump()) == Outcome::kRefused);
  }
}

TEST_CASE("A waypoint beyond its limits is refused, mimic joints included") {
  Proved proved;
  Robot robot = proved.problem.model.robot;
  Configuration q = proved.problem.start;
  CHECK(check::CheckLimits(robot, q) == "");
  int joint = 0;
  while (robot.joints[joint].column < 0) ++joint;
  q.joints[robot.joints[joint].column] = std::nextafter(robot.joints[joint].upper, 100);
  CHECK(check::CheckLimits(robot, q) == robot.joints[joint].name);
}

TEST_CASE("An edge is in C_guide where its proof holds and both its ends keep their limits") {
  Proved proved;
  check::Certificate certificate = check::ParseCertificate(proved.text);
  CHECK(CheckCertificate(certificate).in_guide == std::vector<bool>{true, true});
  SECTION("without a proof") {
    certificate.proofs.erase(certificate.proofs.begin());
    CHECK(CheckCertificate(certificate).in_guide == std::vector<bool>{false, true});
  }
  SECTION("a limit of the first, the middle or the last waypoint") {
    Robot& robot = certificate.model.robot;
    int joint = 0;
    while (robot.joints[joint].column != 3) ++joint;  // 0.01 rad farther at the last waypoint
    robot.joints[joint].upper = proved.path.waypoints[1].joints[3];
    CHECK(CheckCertificate(certificate).in_guide == std::vector<bool>{true, false});
    robot.joints[joint].upper -= 1e-9;
    CHECK(CheckCertificate(certificate).in_guide == std::vector<bool>{false, false});
  }
}

TEST_CASE("The model in a certificate is compared byte for byte") {
  const Proved proved;
  const std::string begin = "\"model\": ";
  const std::size_t at = proved.text.find(begin) + begin.size();
  const std::string model = proved.text.substr(at, proved.text.find(",\n\"path\"") - at);
  CHECK(check::HasModelText(proved.text, model));
  CHECK(check::HasModelText(proved.text, model + "\n"));
  CHECK(!check::HasModelText(proved.text, model.substr(1)));
  std::string other = model;
  other[model.size() / 2] ^= 1;
  CHECK(!check::HasModelText(proved.text, other));
  CHECK(!check::HasModelText("", model));
}

TEST_CASE("Models that cannot be checked are refused with the reason") {
  Proved proved;
  Model nearest = proved.problem.model;
  nearest.contact.model = ContactModel::kNearest;
  CHECK_THROWS_AS(check::Checker(nearest), Error);
  Model thin = proved.problem.model;
  thin.objects[0].pieces[0].geometry = Box{{1, 1, 1e-310}};
  CHECK_THROWS_AS(check::Checker(thin), Error);
  CHECK_THROWS_AS(check::Checker(proved.problem.model, {10}), Error);
}

}  // namespace cguide::verify
