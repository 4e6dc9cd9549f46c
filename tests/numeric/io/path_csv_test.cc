#include <random>

#include "cguide/numeric/io/guide_io.h"
#include "tests/numeric/io/reader_tools.h"
#include "tests/random_robot.h"

namespace cguide::numeric::io {
namespace {

Path RandomPath(std::mt19937_64& rng, const Robot& robot) {
  Path path;
  path.joint_names = ColumnNames(robot);
  for (int i = 0; i < 5; ++i) path.waypoints.push_back(test::RandomConfiguration(rng, robot));
  return path;
}

TEST_CASE("a path that is written and read is the same to the last bit") {
  const TemporaryFolder folder;
  std::mt19937_64 rng(51);
  for (int i = 0; i < 50; ++i) {
    const Robot robot = test::RandomRobot(rng, 3 + i % 9);
    const Path path = RandomPath(rng, robot);
    const Path read = ReadPathCsv(folder.Write("path.csv", WritePathCsv(path)), robot);
    CHECK(read.joint_names == path.joint_names);
    REQUIRE(read.waypoints == path.waypoints);
  }
}

TEST_CASE("columns may come in any order and are brought into the robot's") {
  const TemporaryFolder folder;
  std::mt19937_64 rng(52);
  const Robot robot = test::RandomRobot(rng, 6);
  const Path path = RandomPath(rng, robot);
  const std::string text = WritePathCsv(path);
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  std::vector<std::size_t> order(rows[0].size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  for (int i = 0; i < 20; ++i) {
    std::shuffle(order.begin(), order.end(), rng);
    std::string shuffled = "\xEF\xBB\xBF";
    for (const auto& row : rows) {
      for (std::size_t k = 0; k < order.size(); ++k) {
        shuffled += (k ? " ,\t" : "") + row[order[k]];
      }
      shuffled += "\r\n\n";
    }
    const Path read = ReadPathCsv(folder.Write("path.csv", shuffled), robot);
    CHECK(read.joint_names == path.joint_names);
    REQUIRE(read.waypoints == path.waypoints);
  }
}

TEST_CASE("a last line without line end counts") {
  const TemporaryFolder folder;
  std::mt19937_64 rng(53);
  const Robot robot = test::RandomRobot(rng, 4);
  const Path path = RandomPath(rng, robot);
  std::string text = WritePathCsv(path);
  text.pop_back();
  CHECK(ReadPathCsv(folder.Write("path.csv", text), robot).waypoints == path.waypoints);
}

}  // namespace
}  // namespace cguide::numeric::io
