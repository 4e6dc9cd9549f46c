// Asks through OMPL's interfaces whether the start of a problem is in C_guide, and a motion from it
// to itself.
#include <cguide/numeric/io/problem_reader.h>
#include <cguide/numeric/sampled_edge.h>
#include <cguide/planner/ompl/ompl_adapter.h>
#include <ompl/base/ScopedState.h>

#include <iostream>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto problem = cguide::numeric::io::ReadProblem(argv[1]);
  const cguide::numeric::World world(problem.model);
  const auto information = cguide::ompl_adapter::MakeSpaceInformation(
      world, problem.sampling, cguide::numeric::MakeSampledOracle(world, {0.02}), {});
  ompl::base::ScopedState<> start(information->getStateSpace());
  const auto* space = information->getStateSpace()->as<cguide::ompl_adapter::GuideStateSpace>();
  space->Write(problem.start, start.get());
  if (!information->isValid(start.get()) || !information->checkMotion(start.get(), start.get())) {
    return 1;
  }
  std::cout << "valid for OMPL\n";
  return 0;
}
