#include <cmath>

#include "tests/numeric/io/problem_tools.h"

namespace cguide::numeric::io {
namespace {

SamplingRules Rules(const std::string& lines) {
  const LegProblem leg;
  return leg.Read("sampling:\n" + lines).sampling;
}

TEST_CASE("positions are uniform in a box or normal") {
  const auto box = std::get<UniformPosition>(
      Rules("  position: {box_m: [[-1, -2, 0.5], [1, 2, 0.5]]}\n").position);
  CHECK(box.lower == Eigen::Vector3d(-1, -2, 0.5));
  CHECK(box.upper == Eigen::Vector3d(1, 2, 0.5));
  const auto gaussian = std::get<GaussianPosition>(
      Rules("  position: {gaussian: {mean_m: [1, 2, 3], sigma_m: [0.1, 0, 0.3]}}\n").position);
  CHECK(gaussian.mean == Eigen::Vector3d(1, 2, 3));
  CHECK(gaussian.sigma == Eigen::Vector3d(0.1, 0, 0.3));
  CHECK(std::get<GaussianPosition>(
            Rules("  position: {gaussian: {mean_m: [1, 2, 3], sigma_m: 0.2}}\n").position)
            .sigma == Eigen::Vector3d::Constant(0.2));
  const LegProblem leg;
  CHECK(Contains(
      leg.Message("sampling: {position: {gaussian: {mean_m: [1, 2, 3], sigma_m: [1, 1, -1]}}}\n"),
      "sampling.position.gaussian.sigma_m"));
}

TEST_CASE("orientations are a mixture, means by angles or quaternions, weights one by default") {
  const auto modes = Rules(
                         "  orientation:\n"
                         "    - {mean_rpy: [0, 1.5, 0], kappa: 50, weight: 2}\n"
                         "    - {mean_quaternion: {x: 0, y: 0.6, z: 0, w: 0.8}, kappa: 0}\n"
                         "    - {kappa: 1e12}\n")
                         .orientation;
  REQUIRE(modes.size() == 3);
  CHECK(modes[0].mean == FromRpy({0, 1.5, 0}));
  CHECK(modes[0].kappa == 50);
  CHECK(modes[0].weight == 2);
  CHECK(modes[1].mean == Quaternion{0, 0.6, 0, 0.8});
  CHECK(modes[1].weight == 1);
  CHECK(modes[2].mean == Quaternion{});
  CHECK(modes[2].kappa == 1e12);
}

TEST_CASE("the posture family: norm, local noise, also the infinite norm") {
  const PostureSampling posture = Rules(
                                      "  posture: {base: bent, keys: [bent], k: 1.5, "
                                      "local_fraction: 0.5, local_sigma_rad: 0.1}\n")
                                      .posture;
  CHECK(posture.k == 1.5);
  CHECK(posture.local_fraction == 0.5);
  CHECK(posture.local_sigma == 0.1);
  CHECK(std::isinf(Rules("  posture: {k: .inf}\n").posture.k));
  CHECK(std::isinf(Rules("  posture: {k: inf}\n").posture.k));
  const LegProblem leg;
  CHECK(Contains(leg.Message("sampling: {posture: {k: -.inf}}\n"), "sampling.posture.k"));
}

}  // namespace
}  // namespace cguide::numeric::io
