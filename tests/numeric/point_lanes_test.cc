#include <catch2/catch.hpp>

#include "cguide/numeric/point_lanes_internal.h"
#include "tests/cases/convex_pairs.h"

namespace cguide::numeric {

using Eigen::Vector3d;

TEST_CASE("Scans of lanes give what a plain loop gives, for every size") {
  std::mt19937_64 rng(6);
  for (int count = 1; count <= 70; ++count) {
    const std::vector<Vector3d> points = test::cases::Ellipsoid(rng, count, 1);
    const PointLanes lanes(points);
    CHECK(lanes.size() == count);
    CHECK(lanes.is_finite());
    const Vector3d n = test::cases::Direction(rng), origin = points[count / 2];
    const auto dot = [&n](const Vector3d& p) { return n[0] * p[0] + n[1] * p[1] + n[2] * p[2]; };
    double greatest = -INFINITY, least = INFINITY;
    int farthest = 0;
    std::vector<int> within, found;
    for (int i = 0; i < count; ++i) {
      if (dot(points[i]) > greatest) greatest = dot(points[i]), farthest = i;
      least = std::min(least, dot(points[i] - origin));
      if (dot(points[i] - origin) <= 0.1) within.push_back(i);
    }
    lanes.CollectWithin(origin, n, 0.1, &found);
    CHECK(lanes.Farthest(n) == farthest);
    CHECK(lanes.Greatest(n) == greatest);
    CHECK(lanes.LeastFrom(origin, n) == least);
    CHECK(found == within);
    const Vector3d farness = lanes.Farness(origin);
    for (const Vector3d& p : points) CHECK(((p - origin).cwiseAbs() - farness).maxCoeff() <= 0);
  }
}

TEST_CASE("Lanes notice numbers that are not finite, and keep such points in doubt") {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (int at = 0; at < 11; ++at) {
      std::vector<Vector3d> points(11, Vector3d(1, 2, 3));
      points[at][at % 3] = bad;
      const PointLanes lanes(points);
      CHECK_FALSE(lanes.is_finite());
      if (!std::isnan(bad)) continue;
      std::vector<int> found;
      lanes.CollectWithin(Vector3d::Zero(), Vector3d::Ones(), 0, &found);
      CHECK(found == std::vector<int>{at});
    }
  }
}

}  // namespace cguide::numeric
