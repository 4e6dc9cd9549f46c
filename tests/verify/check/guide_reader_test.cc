#include <catch2/catch.hpp>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/verify/check/certificate.h"

namespace cguide::check {
namespace {

Path TwoWaypoints() {
  Path path;
  path.joint_names = {"hip", "knee"};
  Configuration q{{{0.1, -1e-300, 3}, {0, 0, 0.6, 0.8}}, Eigen::Vector2d(1.0 / 3, -2)};
  path.waypoints = {q, q};
  path.waypoints[1].joints[1] = 0.25;
  return path;
}

std::string GuideText(const Path& path) {
  numeric::io::Guide guide;
  guide.path = path;
  guide.problem_file = "room.yaml";
  return numeric::io::WriteGuide(guide);
}

std::string Refusal(const std::string& text) {
  try {
    ParseGuidePath(text);
  } catch (const Error& e) {
    CHECK(e.code() == Error::Code::kBadInput);
    return e.what();
  }
  return {};
}

std::string With(const std::string& from, const std::string& to) {
  std::string text = GuideText(TwoWaypoints());
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("The path of a guide is the one that was written, number for number") {
  const Path path = ParseGuidePath(GuideText(TwoWaypoints()));
  CHECK(path.joint_names == TwoWaypoints().joint_names);
  CHECK(path.waypoints == TwoWaypoints().waypoints);
  CHECK(DifferenceOf(path, TwoWaypoints()).empty());
}

TEST_CASE("Paths that differ in a name, a number, their length are different") {
  const Path path = TwoWaypoints();
  Path other = path;
  other.joint_names[1] = "ankle";
  CHECK(DifferenceOf(path, other) == "its joints are others");
  other = path;
  std::swap(other.joint_names[0], other.joint_names[1]);
  CHECK(DifferenceOf(path, other) == "its joints are others");
  other = path;
  other.waypoints.pop_back();
  CHECK(DifferenceOf(path, other) == "it has 2 waypoints, not 1");
  const auto altered = [&](auto number) {
    other = path;
    double& x = number(other.waypoints[1]);
    x = std::nextafter(x, 9);
    CHECK(DifferenceOf(path, other) == "waypoint 1 is another");
  };
  for (const int k : {0, 1, 2}) {
    altered([k](Configuration& q) -> double& { return q.X_WB.p[k]; });
  }
  altered([](Configuration& q) -> double& { return q.X_WB.q.x; });
  altered([](Configuration& q) -> double& { return q.X_WB.q.y; });
  altered([](Configuration& q) -> double& { return q.X_WB.q.z; });
  altered([](Configuration& q) -> double& { return q.X_WB.q.w; });
  for (const int k : {0, 1}) {
    altered([k](Configuration& q) -> double& { return q.joints[k]; });
  }
}

TEST_CASE("Zeros of either sign are one number") {
  Path path = TwoWaypoints(), other = path;
  path.waypoints[0].X_WB.q.x = 0.0;
  other.waypoints[0].X_WB.q.x = -0.0;
  CHECK(DifferenceOf(path, other).empty());
}

TEST_CASE("What is no guide is refused with the place named") {
  CHECK(Refusal("").find("not JSON") != std::string::npos);
  CHECK(Refusal("[]").find("an object is expected") != std::string::npos);
  CHECK(Refusal(With("cguide-guide/1", "cguide-guide/2")).find("/schema") != std::string::npos);
  CHECK(Refusal(With("\"joint_names\"", "\"joints\"")).find("joint_names") != std::string::npos);
  CHECK(Refusal(With("\"hip\", ", "")).find("/waypoints/0/joints") != std::string::npos);
  CHECK(Refusal(With("\"qz\"", "\"qq\"")).find("/waypoints/0/root") != std::string::npos);
  CHECK(Refusal(With("0.25", "null")).find("/waypoints/1/joints/1") != std::string::npos);
  CHECK(Refusal(With("0.25", "1e99")).find("beyond 1e9") != std::string::npos);
  CHECK(Refusal(With("\"seed\"", "\"edges\"")).find("twice") != std::string::npos);
  const std::string good = GuideText(TwoWaypoints());
  for (std::size_t size = 0; size + 3 < good.size(); ++size) {
    CHECK_THROWS_AS(ParseGuidePath(good.substr(0, size)), Error);
  }
}

}  // namespace cguide::check
