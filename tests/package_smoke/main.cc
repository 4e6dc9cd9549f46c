// Reads a problem, asks whether its start is in C_guide, plans, and asks an exact twin something.
#include <cguide/exact/cone_membership.h>
#include <cguide/exact/core/path.h>
#include <cguide/numeric/io/problem_reader.h>
#include <cguide/numeric/membership.h>
#include <cguide/numeric/sampled_edge.h>
#include <cguide/planner/rrt.h>

#include <iostream>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto problem = cguide::numeric::io::ReadProblem(argv[1]);
  const cguide::numeric::World world(problem.model);
  cguide::numeric::GuideWorkspace workspace(world);
  const auto start = cguide::numeric::TestConfiguration(world, problem.start,
                                                        cguide::numeric::Space::kGuide, &workspace);
  if (start.verdict != cguide::Verdict::kHolds) return 1;
  const cguide::EdgeOracle oracle = cguide::numeric::MakeSampledOracle(world, {0.02});
  const auto result = cguide::planner::PlanRrt(world, problem.sampling, problem.start, problem.goal,
                                               oracle, {}, {});
  if (result.stop != cguide::planner::StopReason::kSolved) return 1;
  std::cout << "planned " << result.waypoints.size() << " waypoints\n";
  return 0;
}
