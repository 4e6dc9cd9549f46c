#pragma once

#include <string>

#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/world.h"

namespace cguide::test {

/** A problem of fixtures/, ready for queries. */
struct Room {
  explicit Room(const std::string& name)
      : problem(
            numeric::io::ReadProblem(std::string(CGUIDE_FIXTURES) + "/problems/" + name + ".yaml")),
        world(problem.model) {}
  numeric::Problem problem;
  numeric::World world;
};

}  // namespace cguide::test
