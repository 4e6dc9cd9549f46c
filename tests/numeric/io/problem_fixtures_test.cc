#include <Eigen/Geometry>
#include <map>

#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/stability.h"
#include "cguide/numeric/world.h"
#include "tests/numeric/io/problem_tools.h"

namespace cguide::numeric::io {
namespace {

namespace fs = std::filesystem;

// The fixture, with the folder of third-party data put in; nothing where that is absent.
std::optional<fs::path> FixtureProblem(const fs::path& file, const TemporaryFolder& folder) {
  std::string text = ReadText(file);
  const std::string shared = "../../../shared";
  if (!Contains(text, shared)) return file;
  const auto data = SharedData("robots");
  if (!data) return std::nullopt;
  const auto replace = [&](const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
      text.replace(at, what.size(), by);
    }
  };
  replace(shared, fs::absolute(*data).string());
  replace(" ../robots", " " + Fixture("robots").string());
  return folder.Write(file.filename().string(), text);
}

StabilityAnswer Stability(const World& world, Workspace* workspace,
                          std::vector<Contact>* contacts) {
  FindContacts(world, workspace, contacts);
  StabilityQuery query;
  query.contacts = *contacts;
  query.com_W = workspace->state.com_W;
  query.com_error = workspace->state.com_error;
  query.mass = world.tree().mass;
  query.gravity_W = world.model().gravity;
  query.generators = world.model().contact.generators;
  StabilityWorkspace scratch;
  return TryStability(query, &scratch);
}

TEST_CASE("start and goal of every problem are free, within limits, in contact and stable") {
  const TemporaryFolder folder;
  int problems = 0;
  for (const auto& entry : fs::directory_iterator(Fixture("problems"))) {
    CAPTURE(entry.path().string());
    const auto file = FixtureProblem(entry.path(), folder);
    if (!file) continue;
    ++problems;
    const Problem problem = ReadProblem(*file);
    const World world(problem.model);
    Workspace workspace(world);
    for (const Configuration& q : {problem.start, problem.goal}) {
      CAPTURE(q.X_WB.p.transpose());
      CHECK(WithinLimits(world.tree(), q));
      Place(world, q, &workspace);
      CHECK(TestFree(world, &workspace).verdict == Verdict::kHolds);
      std::vector<Contact> contacts;
      CHECK(Stability(world, &workspace, &contacts).verdict == Verdict::kHolds);
      CHECK(contacts.size() >= 3);
    }
    CHECK_FALSE(problem.sampling.posture.keys.empty());
  }
  CHECK(problems >= 10);
}

Problem Hrp2() { return ReadProblem(Fixture("problems/floor.yaml")); }

TEST_CASE("HRP-2: thirty joints, 56.04 kg, 1.56 m, and no word of warning") {
  const Problem problem = Hrp2();
  CHECK(problem.model.robot.num_columns == 30);
  CHECK(problem.model.robot.bodies.size() == 31);
  CHECK(TotalMass(problem.model.robot) == Approx(56.04).margin(0.005));
  CHECK(problem.warnings.empty());
  for (const char* posture : {"standing", "half_sitting", "sitting", "crouching", "four_legged",
                              "prone", "one_leg_up_left", "one_leg_up_right"}) {
    CAPTURE(posture);
    CHECK(problem.postures.count(posture) == 1);
  }
  CHECK(problem.postures.size() == 8);
}

// Heights of the lowest and the highest corner of all boxes above the root's origin.
std::pair<double, double> HeightRange(const Problem& problem, const std::string& posture) {
  const World world(problem.model);
  Workspace workspace(world);
  Configuration q;
  q.joints = problem.postures.at(posture);
  Place(world, q, &workspace);
  double low = 1e9, high = -1e9;
  for (std::size_t link = 0; link < problem.model.robot.links.size(); ++link) {
    const Transform X_WL =
        workspace.state.X_WB[static_cast<std::size_t>(world.tree().link_body[link])] *
        world.tree().X_BL[link];
    for (const LinkShape& shape : problem.model.robot.links[link].shapes) {
      const Transform X_WS = X_WL * ToTransform(shape.X_LS);
      const double half = X_WS.R.row(2).cwiseAbs().dot(std::get<Box>(shape.geometry).size) / 2;
      low = std::min(low, X_WS.p[2] - half);
      high = std::max(high, X_WS.p[2] + half);
    }
  }
  return {low, high};
}

TEST_CASE(
    "HRP-2: half-sitting puts the sole 0.648702 m under the waist; standing measures 1.56 m") {
  const Problem problem = Hrp2();
  // 0.3 (cos 26 deg + cos 24 deg) + 0.105; the angles are published with six digits.
  CHECK(HeightRange(problem, "half_sitting").first == Approx(-0.648702).margin(1e-6));
  const auto [low, high] = HeightRange(problem, "standing");
  CHECK(low == Approx(-0.705).margin(1e-9));
  CHECK(high - low == Approx(1.56).margin(1e-9));
}

TEST_CASE("HRP-2: the centre of mass in half-sitting is the published one") {
  const Problem problem = Hrp2();
  const World world(problem.model);
  Workspace workspace(world);
  Configuration q;
  q.joints = problem.postures.at("half_sitting");
  Place(world, q, &workspace);
  CHECK((workspace.state.com_W - Eigen::Vector3d(0.013, 0.002, 0.160)).cwiseAbs().maxCoeff() <
        6e-4);
}

TEST_CASE("HRP-2: in every key posture all enabled pairs of bodies are at least 15 mm apart") {
  const Problem problem = Hrp2();
  const World world(problem.model);
  Workspace workspace(world);
  CHECK(problem.model.self_pairs.size() == 421);
  for (const auto& [name, joints] : problem.postures) {
    Configuration q;
    q.joints = joints;
    CHECK(WithinLimits(world.tree(), q));
    Place(world, q, &workspace);
    for (const auto& [i, j] : problem.model.self_pairs) {
      CAPTURE(name, problem.model.robot.bodies[i].name, problem.model.robot.bodies[j].name);
      CHECK(PairClearance(world, {i, j, true}, 0.1, &workspace).lo > 0.015);
    }
  }
}

TEST_CASE("HRP-2: left and right are mirror images, but for the two that the sources state") {
  const Robot robot = Hrp2().model.robot;
  const auto mirrored = [](Eigen::Vector3d v) {
    v[1] = -v[1];
    return v;
  };
  int pairs = 0;
  for (const Link& right : robot.links) {
    if (right.name[0] != 'R') continue;
    ++pairs;
    CAPTURE(right.name);
    const Link& left =
        robot.links[static_cast<std::size_t>(FindLink(robot, "L" + right.name.substr(1)))];
    CHECK(left.mass == right.mass);
    REQUIRE(left.shapes.size() == right.shapes.size());
    for (std::size_t i = 0; i < left.shapes.size(); ++i) {
      CHECK(left.shapes[i].geometry == right.shapes[i].geometry);
      CHECK(left.shapes[i].X_LS.p == mirrored(right.shapes[i].X_LS.p));
    }
    if (right.name != "RARM_JOINT4") CHECK(left.com_L == mirrored(right.com_L));
    const Joint& r = robot.joints[static_cast<std::size_t>(right.joint)];
    const Joint& l = robot.joints[static_cast<std::size_t>(left.joint)];
    if (right.name != "RARM_JOINT6") CHECK(l.X_PJ.p == mirrored(r.X_PJ.p));
    const bool turns_over = r.axis[1] == 0;  // roll and yaw change sign, pitch does not
    CHECK(l.lower == (turns_over ? -r.upper : r.lower));
    CHECK(l.upper == (turns_over ? -r.lower : r.upper));
  }
  CHECK(pairs == 13);
}

TEST_CASE("HRP-2: the boxes stay within the room that the real covers take") {
  // A few rows of the measured boxes (child frame): minimum, maximum.
  const std::map<std::string, std::pair<Eigen::Vector3d, Eigen::Vector3d>> rooms = {
      {"BODY", {{-0.173, -0.164, 0.061}, {0.124, 0.164, 0.327}}},
      {"RLEG_JOINT2", {{-0.050, -0.136, -0.337}, {0.057, 0.001, 0.040}}},
      {"RLEG_JOINT3", {{-0.077, -0.127, -0.336}, {0.107, 0.015, 0.104}}},
      {"LLEG_JOINT5", {{-0.106, -0.059, -0.105}, {0.136, 0.079, 0.035}}},
      {"CHEST_JOINT1", {{-0.223, -0.195, -0.031}, {0.132, 0.195, 0.288}}},
      {"HEAD_JOINT1", {{-0.174, -0.105, 0.001}, {0.127, 0.105, 0.210}}},
      {"LARM_JOINT2", {{-0.052, -0.043, -0.290}, {0.040, 0.060, -0.040}}},
      {"RARM_JOINT5", {{-0.032, -0.045, -0.205}, {0.048, 0.045, 0.028}}}};
  const Robot robot = Hrp2().model.robot;
  for (const auto& [name, room] : rooms) {
    CAPTURE(name);
    for (const LinkShape& shape :
         robot.links[static_cast<std::size_t>(FindLink(robot, name))].shapes) {
      const Eigen::Vector3d half = std::get<Box>(shape.geometry).size / 2;
      CHECK((shape.X_LS.p - half - room.first).minCoeff() > -1e-9);
      CHECK((room.second - shape.X_LS.p - half).minCoeff() > -1e-9);
    }
  }
}

TEST_CASE("stairs as boxes and as one mesh give the same contacts on the platform") {
  std::vector<std::vector<Contact>> found;
  for (const char* name : {"problems/stairs.yaml", "problems/stairs_mesh.yaml"}) {
    const Problem problem = ReadProblem(Fixture(name));
    const World world(problem.model);
    Workspace workspace(world);
    Place(world, problem.goal, &workspace);
    found.emplace_back();
    FindContacts(world, &workspace, &found.back());
  }
  REQUIRE(found[0].size() == found[1].size());
  for (std::size_t i = 0; i < found[0].size(); ++i) {
    CHECK(found[0][i].site == found[1][i].site);
    CHECK((found[0][i].y_W - found[1][i].y_W).norm() < 1e-6);
    CHECK((found[0][i].n_W - found[1][i].n_W).norm() < 1e-6);
  }
}

}  // namespace
}  // namespace cguide::numeric::io
