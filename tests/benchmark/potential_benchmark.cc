// What a call of GuidePotential costs: HRP-2's guide out of the chair, its edges cut into pieces,
// and one that wanders between random postures; configurations near the guide and far from it.
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/kinematics.h"
#include "cguide/numeric/sampled_edge.h"
#include "cguide/planner/potential_field.h"
#include "cguide/planner/rrt.h"
#include "tests/benchmark/timing.h"

namespace {

using namespace cguide;  // NOLINT: a program of one file
using benchmark_tools::Keep;
using benchmark_tools::Quantile;
using planner::GuidePotential;

constexpr int kQueries = 2000;
constexpr int kRepeats = 20;

// Every edge in as many equal pieces as make `count` edges or just more.
std::vector<Configuration> Cut(const std::vector<Configuration>& guide, int count) {
  const int pieces =
      (count + static_cast<int>(guide.size()) - 2) / static_cast<int>(guide.size() - 1);
  std::vector<Configuration> result{guide.front()};
  for (std::size_t i = 0; i + 1 < guide.size(); ++i) {
    for (int k = 1; k <= pieces; ++k) {
      result.push_back(Interpolate({guide[i], guide[i + 1]}, static_cast<double>(k) / pieces));
    }
  }
  return result;
}

std::vector<Configuration> Near(const GuidePotential& potential, double size, numeric::Rng& rng) {
  std::vector<Configuration> queries;
  for (int i = 0; i < kQueries; ++i) {
    const Configuration q = potential.At(numeric::Uniform(rng) * potential.length());
    Eigen::VectorXd v(6 + q.joints.size());
    for (Eigen::Index k = 0; k < v.size(); ++k) v[k] = size * numeric::Normal(rng);
    queries.push_back(numeric::Integrate(q, v));
  }
  return queries;
}

template <typename Call>
void PrintRow(const std::string& name, const std::vector<Configuration>& queries,
              const Call& call) {
  std::vector<double> times;
  for (const Configuration& q : queries) {
    times.push_back(benchmark_tools::MicrosecondsOf(kRepeats, [&] { Keep(call(q)); }));
  }
  double mean = 0;
  for (const double t : times) mean += t / static_cast<double>(times.size());
  std::printf("| %s | %.2f | %.2f | %.2f | %.2f |\n", name.c_str(), mean, Quantile(times, 0.5),
              Quantile(times, 0.95), Quantile(times, 0.999));
}

void PrintGuide(const std::string& name, const std::vector<Configuration>& guide,
                const numeric::Problem& problem, numeric::Rng& rng) {
  const GuidePotential potential(guide);
  const std::string where = name + ", " + std::to_string(guide.size()) + " waypoints, length " +
                            std::to_string(potential.length()).substr(0, 5) + ", ";
  std::vector<Configuration> far;
  for (int i = 0; i < kQueries; ++i) {
    far.push_back(SampleConfiguration(problem.sampling, problem.model.robot, rng));
  }
  const auto near = Near(potential, 0.05, rng);
  const auto value = [&](const Configuration& q) { return potential.Value(q); };
  PrintRow(where + "value, near", near, value);
  PrintRow(where + "value, far", far, value);
  PrintRow(where + "nearest, far", far,
           [&](const Configuration& q) { return potential.Nearest(q).distance; });
  PrintRow(where + "gradient, far", far,
           [&](const Configuration& q) { return potential.Gradient(q)[0]; });
}

}  // namespace

int main() {
  const std::string file = std::string(CGUIDE_FIXTURES) + "/problems/chair_and_table.yaml";
  const numeric::Problem problem = numeric::io::ReadProblem(file);
  const numeric::World world(problem.model);
  const auto plan = planner::PlanRrt(world, problem.sampling, problem.start, problem.goal,
                                     numeric::MakeSampledOracle(world, {0.02}), {}, {});
  if (plan.stop != planner::StopReason::kSolved) return 1;
  numeric::Rng rng(1);
  std::vector<Configuration> wandering;
  for (int i = 0; i < 400; ++i) {
    wandering.push_back(SampleConfiguration(problem.sampling, problem.model.robot, rng));
  }
  std::printf("| microseconds a call | mean | median | 95 %% | 99.9 %% |\n|---|---|---|---|---|\n");
  PrintGuide("A1", plan.waypoints, problem, rng);
  PrintGuide("A1, cut", Cut(plan.waypoints, 400), problem, rng);
  PrintGuide("wandering", wandering, problem, rng);
  return 0;
}
