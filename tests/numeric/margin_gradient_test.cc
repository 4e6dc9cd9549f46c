#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/numeric/margins.h"
#include "tests/numeric/stability_cases.h"

namespace cguide::numeric {
namespace {

using testing::AddPatch;
using testing::RandomStance;
using testing::Stance;

constexpr MarginOptions kFine{1e-11, 120};

double Margin(const Stance& stance, StabilityWorkspace* workspace) {
  return FindComMargin(stance.Query(), kFine, workspace).lo;
}

TEST_CASE("A foot's margin falls as the centre of mass nears the edge, and rises with the edge") {
  StabilityWorkspace workspace;
  Stance stance;
  AddPatch({0, 0, 0}, {0, 0, 1}, 0, 0.5, 0.125, 0.0625, &stance);
  stance.com = {0.0, 0.03, 1};
  const auto gradient = ComMarginGradient(stance.Query(), kFine, &workspace);
  REQUIRE(gradient);
  CHECK((gradient->com_W - Eigen::Vector3d(0, -1, 0)).norm() < 1e-9);
  // The disc touches the middle of the edge y = 0.0625: its two corners share.
  for (std::size_t i = 0; i < 4; ++i) {
    const double share = stance.contacts[i].x_W[1] > 0 ? 0.5 : 0;
    CHECK((gradient->contact_W[i] - Eigen::Vector3d(0, share, 0)).norm() < 1e-9);
  }
}

TEST_CASE("Moving everything together changes nothing") {
  StabilityWorkspace workspace;
  Rng rng(811);
  for (int i = 0; i < 100; ++i) {
    const Stance stance = RandomStance(1 + i % 4, rng);
    const auto gradient = ComMarginGradient(stance.Query(), {}, &workspace);
    if (!gradient) continue;
    Eigen::Vector3d sum = gradient->com_W;
    for (const Eigen::Vector3d& g : gradient->contact_W) sum += g;
    CHECK(sum.norm() < 1e-6);
  }
}

TEST_CASE("The gradient agrees with finite differences away from kinks") {
  StabilityWorkspace workspace;
  Rng rng(821);
  constexpr double kStep = 1e-6;
  int tested = 0, smooth = 0, agree = 0, negative = 0;
  for (int i = 0; i < 60; ++i) {
    const Stance stance = RandomStance(1 + i % 4, rng);
    const auto gradient = ComMarginGradient(stance.Query(), kFine, &workspace);
    if (!gradient) continue;
    negative += Margin(stance, &workspace) < 0;
    const auto compare = [&](const Eigen::Vector3d& expected, auto&& part) {
      for (int k = 0; k < 3; ++k) {
        Stance up = stance, down = stance;
        part(up)[k] += kStep;
        part(down)[k] -= kStep;
        const double m = Margin(stance, &workspace);
        const double forward = (Margin(up, &workspace) - m) / kStep;
        const double backward = (m - Margin(down, &workspace)) / kStep;
        ++tested;
        if (std::abs(forward - backward) > 1e-3) continue;  // a kink, or curved beyond the step
        ++smooth;
        agree += std::abs(expected[k] - 0.5 * (forward + backward)) < 2e-3;
      }
    };
    compare(gradient->com_W, [](Stance& s) -> Eigen::Vector3d& { return s.com; });
    const auto j = static_cast<std::size_t>(i) % stance.contacts.size();
    compare(gradient->contact_W[j],
            [j](Stance& s) -> Eigen::Vector3d& { return s.contacts[j].x_W; });
  }
  CAPTURE(tested, smooth, agree);
  CHECK(tested > 200);
  CHECK(smooth > 0.9 * tested);
  CHECK(agree > 0.98 * smooth);
  CHECK(negative > 5);
}

TEST_CASE("No margin, no gradient") {
  StabilityWorkspace workspace;
  Stance stance;
  CHECK_FALSE(ComMarginGradient(stance.Query(), {}, &workspace));
}

}  // namespace
}  // namespace cguide::numeric
