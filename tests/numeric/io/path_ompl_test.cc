#include <algorithm>
#include <random>

#include "cguide/numeric/io/foreign_path.h"
#include "tests/numeric/io/reader_tools.h"
#include "tests/random_robot.h"

namespace cguide::numeric::io {
namespace {

// As PathGeometric::printAsMatrix writes it, with all digits: a blank after every number and an
// empty line at the end.
std::string Matrix(const Path& path, const std::vector<std::size_t>& order, bool with_root) {
  std::ostringstream text;
  text.precision(17);
  for (const Configuration& q : path.waypoints) {
    const Pose& X = q.X_WB;
    if (with_root) {
      for (const double x : {X.p[0], X.p[1], X.p[2], X.q.x, X.q.y, X.q.z, X.q.w}) text << x << ' ';
    }
    for (const std::size_t i : order) text << q.joints[static_cast<Eigen::Index>(i)] << ' ';
    text << '\n';
  }
  text << '\n';
  return text.str();
}

std::vector<std::size_t> Order(std::mt19937_64& rng, std::size_t size) {
  std::vector<std::size_t> order(size);
  for (std::size_t i = 0; i < size; ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), rng);
  return order;
}

TEST_CASE("a printed matrix is read back to the last bit, in any order of the joints") {
  const TemporaryFolder folder;
  std::mt19937_64 rng(61);
  for (int i = 0; i < 50; ++i) {
    const Robot robot = test::RandomRobot(rng, 3 + i % 9);
    Path path;
    path.joint_names = ColumnNames(robot);
    for (int k = 0; k < 4; ++k) path.waypoints.push_back(test::RandomConfiguration(rng, robot));
    std::vector<std::size_t> order = Order(rng, path.joint_names.size());
    ForeignPathOptions options;
    for (const std::size_t k : order) options.joint_order.push_back(path.joint_names[k]);
    const auto file = folder.Write("m.txt", Matrix(path, order, true));
    const Path read = ReadPathOmpl(file, robot, options);
    CHECK(read.joint_names == path.joint_names);
    REQUIRE(read.waypoints == path.waypoints);
    std::sort(order.begin(), order.end());
    const auto plain = folder.Write("m.txt", Matrix(path, order, true));
    REQUIRE(ReadPathOmpl(plain, robot, {}).waypoints == path.waypoints);
  }
}

TEST_CASE("where the root stands still the matrix holds the joints alone") {
  const TemporaryFolder folder;
  std::mt19937_64 rng(62);
  const Robot robot = test::RandomRobot(rng, 4);
  Path path;
  for (int k = 0; k < 3; ++k) path.waypoints.push_back(test::RandomConfiguration(rng, robot));
  for (Configuration& q : path.waypoints) q.X_WB = path.waypoints[0].X_WB;
  std::vector<std::size_t> order = Order(rng, ColumnNames(robot).size());
  std::sort(order.begin(), order.end());
  ForeignPathOptions options;
  options.X_WB = path.waypoints[0].X_WB;
  const auto file = folder.Write("m.txt", Matrix(path, order, false));
  CHECK(ReadPathOmpl(file, robot, options).waypoints == path.waypoints);
  CHECK(RefusalOf([&] { ReadPathOmpl(file, robot, {}); }));
  // A matrix with root columns is not one of joints alone.
  const auto full = folder.Write("m.txt", Matrix(path, order, true));
  CHECK(RefusalOf([&] { ReadPathOmpl(full, robot, options); }));
}

TEST_CASE("line ends of Windows, tabs and more empty lines at the end change nothing") {
  const TemporaryFolder folder;
  Robot robot;
  robot.links.resize(1);
  AssignBodiesAndColumns(&robot);
  const Path read = ReadPathOmpl(
      folder.Write("m.txt", "1\t2  3 0 0 0 1\r\n-1 2 3 0 0 0 1 \r\n\r\n\n"), robot, {});
  REQUIRE(read.waypoints.size() == 2);
  CHECK(read.waypoints[0].X_WB.p == Eigen::Vector3d(1, 2, 3));
  CHECK(read.waypoints[1].X_WB.p.x() == -1);
}

TEST_CASE("an order that names not every joint once is refused") {
  std::mt19937_64 rng(63);
  const Robot robot = test::RandomRobot(rng, 3);
  const std::vector<std::string> names = ColumnNames(robot);
  REQUIRE(names.size() >= 1);
  const auto refusal = [&](const std::vector<std::string>& order) {
    ForeignPathOptions options;
    options.joint_order = order;
    const auto found =
        RefusalOf([&] { ReadPathOmpl(Fixture("io/two_joints.matrix"), robot, options); });
    REQUIRE(found);
    CHECK(found->message.find("--joint-order") == 0);
    return found->message;
  };
  std::vector<std::string> order = names;
  order.push_back(names[0]);
  CHECK(refusal(order).find("stands twice") != std::string::npos);
  order = names;
  order[0] = "elbow";
  CHECK(refusal(order).find("unknown") != std::string::npos);
  CHECK(refusal({names.begin(), names.end() - 1}).size() > 0);
}

}  // namespace
}  // namespace cguide::numeric::io
