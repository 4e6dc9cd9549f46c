#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

#include "cguide/numeric/geometry_internal.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/io/robot_reader.h"
#include "tests/numeric/geometry_models.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

// Folder of third-party scenes, or empty.
std::filesystem::path Scenes() {
  const char* named = std::getenv("CGUIDE_SHARED_DATA");
  const std::filesystem::path data =
      named ? std::filesystem::path(named)
            : std::filesystem::path(CGUIDE_SOURCE_DIR) / ".." / "shared";
  const auto scenes = data / "scenes" / "hpp_environments" / "urdf" / "multicontact";
  return std::filesystem::exists(scenes) ? scenes : std::filesystem::path();
}

TEST_CASE("in rooms of triangles the collision test and the clearances agree") {
  const auto scenes = Scenes();
  if (scenes.empty()) {
    WARN("skipped: no third-party scenes; set CGUIDE_SHARED_DATA");
    return;
  }
  const Problem problem = io::ReadProblem(std::string(CGUIDE_FIXTURES) + "/problems/floor.yaml");
  std::mt19937_64 rng(1);
  int holds = 0, fails = 0, undecided = 0, contacts_seen = 0, certain = 0;
  for (const char* name : {"stair_bauzil", "car", "stepladder", "darpa", "groundcrouch"}) {
    Model model = problem.model;
    std::vector<std::string> warnings;
    model.objects =
        io::ReadSceneUrdf(scenes / (std::string(name) + ".urdf"), {}, Pose{}, 0.5, &warnings);
    model.self_pairs.clear();
    const World world(std::move(model));
    Vector3d lower = Vector3d::Constant(INFINITY), upper = -lower;
    for (const ObstaclePiece& piece : world.geometry().pieces) {
      lower = lower.cwiseMin(piece.convex.c - piece.convex.half);
      upper = upper.cwiseMax(piece.convex.c + piece.convex.half);
    }
    upper.z() += 0.6;
    Workspace workspace(world);
    std::vector<Contact> contacts;
    for (int i = 0; i < 60; ++i) {
      Configuration q = problem.start;
      for (double& x : q.joints) x += test::Between(rng, -0.2, 0.2);
      for (int k = 0; k < 3; ++k) q.X_WB.p[k] = test::Between(rng, lower[k], upper[k]);
      Place(world, q, &workspace);
      const Verdict verdict = TestFree(world, &workspace).verdict;
      bool apart = true, meets = false;
      for (const Pair& pair : AllPairs(world)) {
        const Clearance c = PairClearance(world, pair, 0.5, &workspace);
        CAPTURE(name, i, pair.body, pair.other, c.lo, c.hi);
        REQUIRE(c.lo <= c.hi);
        if (c.lo < 0.5 && !c.overlap) REQUIRE(c.hi - c.lo < 1e-8);
        apart = apart && c.lo > 0;
        meets = meets || c.overlap;
      }
      CAPTURE(name, i);
      REQUIRE(apart == (verdict == Verdict::kHolds));
      REQUIRE(meets == (verdict == Verdict::kFails));
      holds += verdict == Verdict::kHolds;
      fails += verdict == Verdict::kFails;
      undecided += verdict == Verdict::kUndecided;
      FindContacts(world, &workspace, &contacts);
      contacts_seen += static_cast<int>(contacts.size());
      for (const Contact& c : contacts) certain += c.certain;
    }
  }
  CHECK(undecided == 0);
  CHECK(holds > 30);
  CHECK(fails > 30);
  CHECK(contacts_seen > 100);
  CHECK(certain > contacts_seen * 9 / 10);
}

}  // namespace
}  // namespace cguide::numeric
