#pragma once

#include <string>

#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/world.h"
#include "cguide/planner/endpoint.h"

namespace cguide::benchmark_tools {

/** A problem with both ends in C_guide, ready for planners. */
struct Room {
  explicit Room(const std::string& file)
      : problem(numeric::io::ReadProblem(file)),
        world(problem.model),
        start(Prepared(problem.start, "start")),
        goal(Prepared(problem.goal, "goal")) {}

  numeric::Problem problem;
  numeric::World world;
  Configuration start, goal;

 private:
  Configuration Prepared(const Configuration& q, const char* what) const {
    planner::ProjectionWorkspace workspace(world);
    return planner::PrepareEndpoint(world, q, numeric::Space::kGuide, what, {}, &workspace).q;
  }
};

}  // namespace cguide::benchmark_tools
