#include <algorithm>

#include "cguide/numeric/io/srdf_reader_internal.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

RobotDescription Brickman(const std::filesystem::path& srdf) {
  return ReadRobot({Fixture("io/brickman.urdf"), srdf, {}});
}

bool Warns(const RobotDescription& description, const std::string& words) {
  return std::any_of(description.warnings.begin(), description.warnings.end(),
                     [&](const std::string& w) { return w.find(words) != std::string::npos; });
}

TEST_CASE("postures hold independent joints; the floating root is kept aside") {
  const RobotDescription description = Brickman(Fixture("io/brickman.srdf"));
  REQUIRE(description.postures.size() == 2);
  const NamedPosture& rest = description.postures[0];
  CHECK(rest.name == "rest");
  CHECK(rest.joints == std::map<std::string, double>{{"hip", -0.25}, {"turret", 9.5}});
  REQUIRE(rest.root);
  CHECK(rest.root->p == Eigen::Vector3d(0, 0, 0.8));
  CHECK(rest.root->q == Quaternion{});
  const NamedPosture& low = description.postures[1];
  CHECK(low.joints ==
        std::map<std::string, double>{{"hip", -1e3}});  // limits are not this reader's
  CHECK_FALSE(low.root);
}

TEST_CASE("disabled links become body pairs, sorted, once, without pairs inside a body") {
  const RobotDescription description = Brickman(Fixture("io/brickman.srdf"));
  CHECK(description.disabled_bodies == std::vector<std::pair<int, int>>{{0, 1}, {3, 4}});
  CHECK(description.robot.bodies[3].name == "foot");
  CHECK(description.robot.bodies[4].name == "head");
}

TEST_CASE("end effectors are kept where their link exists") {
  const RobotDescription description = Brickman(Fixture("io/brickman.srdf"));
  REQUIRE(description.end_effectors.size() == 1);
  CHECK(description.end_effectors[0].name == "sole");
  CHECK(description.end_effectors[0].parent_link == "foot");
}

TEST_CASE("what the robot does not know is skipped with a warning") {
  const RobotDescription description = Brickman(Fixture("io/brickman.srdf"));
  CHECK(description.warnings.size() == 4);
  CHECK(Warns(description, "joints the robot does not have, skipped: \"gripper\""));
  CHECK(Warns(description, "fixed or mimic joints, skipped: \"knee\", \"mount\""));
  CHECK(Warns(description, "links the robot does not have, skipped: \"gripper_link\""));
  CHECK(Warns(description, "\"claw\""));
}

TEST_CASE("an SRDF of another robot gives a warning that names both") {
  const TemporaryFolder folder;
  const auto file = folder.Write("a.srdf", "<robot name=\"stickman\"/>");
  const RobotDescription description = Brickman(file);
  REQUIRE(description.warnings.size() == 1);
  CHECK(Warns(description, "\"stickman\""));
  CHECK(Warns(description, "\"brickman\""));
}

}  // namespace
}  // namespace cguide::numeric::io
