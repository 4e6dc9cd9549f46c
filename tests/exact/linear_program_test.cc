#include "cguide/exact/linear_program.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/cone_membership.h"
#include "cguide/exact/core/error.h"
#include "tests/exact/random_rationals.h"

namespace cguide::exact {
namespace {

VectorXq Vec(std::initializer_list<int> x) {
  VectorXq v(static_cast<Eigen::Index>(x.size()));
  Eigen::Index i = 0;
  for (int value : x) v[i++] = value;
  return v;
}

ProgramSolution Solve(const LinearProgram& program, std::span<const int> start = {}) {
  ProgramSolution solution = SolveLinearProgram(program, start);
  REQUIRE(CheckProgramSolution(program, solution));
  return solution;
}

LinearProgram RandomProgram(std::mt19937& rng) {
  const int m = 1 + static_cast<int>(rng() % 6), n = static_cast<int>(rng() % 14);
  LinearProgram program;
  for (int j = 0; j < n; ++j) {
    program.columns.push_back(RandomVectorX(rng, m, 2));
    program.c.push_back(RandomInteger(rng, 3));
  }
  program.b = RandomVectorX(rng, m, 2);
  if (rng() % 3 == 0 && m > 1) {  // dependent rows
    for (VectorXq& a : program.columns) a[m - 1] = a[0];
    if (rng() % 2 == 0) program.b[m - 1] = program.b[0];
  }
  return program;
}

}  // namespace

TEST_CASE("A textbook program has its optimum") {
  // max 3x + 2y, x + y + s = 4, x + 3y + t = 6, x <= 3.
  LinearProgram program;
  program.columns = {Vec({1, 1, 1}), Vec({1, 3, 0}), Vec({1, 0, 0}), Vec({0, 1, 0}),
                     Vec({0, 0, 1})};
  program.c = {3, 2, 0, 0, 0};
  program.b = Vec({4, 6, 3});
  const ProgramSolution solution = Solve(program);
  REQUIRE(solution.status == ProgramStatus::kOptimal);
  CHECK(solution.value == 11);
  CHECK(solution.x[0] == 3);
  CHECK(solution.x[1] == 1);
  CHECK(Solve(program, solution.basis).pivots == 3);  // only the basis is brought in
}

TEST_CASE("Random programs of all kinds carry proofs, whatever basis they start from") {
  std::mt19937 rng(11);
  int count[3] = {0, 0, 0}, started = 0;
  for (int round = 0; round < 3000; ++round) {
    const LinearProgram program = RandomProgram(rng);
    const ProgramSolution solution = Solve(program);
    ++count[static_cast<int>(solution.status)];
    std::vector<int> start;
    for (int k = 0; k < 3; ++k) start.push_back(static_cast<int>(rng() % 14) - 1);
    const ProgramSolution again = Solve(program, round % 2 ? start : solution.basis);
    CHECK(again.status == solution.status);
    CHECK(again.value == solution.value);
    if (solution.status == ProgramStatus::kOptimal) {
      started += round % 2 == 0 && !solution.basis.empty();
    }
    // Feasible iff the right-hand side is in the cone of the columns, says another solver.
    const bool member =
        DecideConeMembershipByQp(program.columns, program.b).where != Membership::kOutside;
    CHECK(member == (solution.status != ProgramStatus::kInfeasible));
  }
  for (const int n : count) CHECK(n > 100);
  CHECK(started > 50);
}

TEST_CASE("Beale's program, which makes the simplex method cycle without care, ends") {
  LinearProgram program;
  const auto column = [](Rational a, Rational b, Rational c) {
    VectorXq v(3);
    v << a, b, c;
    return v;
  };
  program.columns = {column(Rational(1, 4), Rational(1, 2), 0),
                     column(-60, -90, 0),
                     column(Rational(-1, 25), Rational(-1, 50), 1),
                     column(9, 3, 0),
                     column(1, 0, 0),
                     column(0, 1, 0),
                     column(0, 0, 1)};
  program.c = {Rational(3, 4), -150, Rational(1, 50), -6, 0, 0, 0};
  program.b = Vec({0, 0, 1});
  CHECK(Solve(program).value == Rational(1, 20));
}

TEST_CASE("The checker of programs refuses altered witnesses") {
  std::mt19937 rng(12);
  int altered = 0;
  for (int round = 0; round < 300; ++round) {
    const LinearProgram program = RandomProgram(rng);
    ProgramSolution solution = SolveLinearProgram(program);
    if (solution.status == ProgramStatus::kOptimal && !solution.x.empty()) {
      ProgramSolution wrong = solution;
      wrong.value += 1;
      CHECK_FALSE(CheckProgramSolution(program, wrong));
      wrong = solution;
      wrong.x[0] = -1;
      CHECK_FALSE(CheckProgramSolution(program, wrong));
      ++altered;
    }
    if (solution.status == ProgramStatus::kUnbounded) {
      for (Rational& x : solution.ray) x = -x;
      CHECK_FALSE(CheckProgramSolution(program, solution));
      solution.ray.assign(solution.ray.size(), 0);
      CHECK_FALSE(CheckProgramSolution(program, solution));
      ++altered;
    }
    if (solution.status == ProgramStatus::kInfeasible) {
      solution.y = -solution.y;
      CHECK_FALSE(CheckProgramSolution(program, solution));
      solution.status = ProgramStatus::kOptimal;
      CHECK_FALSE(CheckProgramSolution(program, solution));
      ++altered;
    }
  }
  CHECK(altered > 200);
}

TEST_CASE("Programs of wrong sizes are refused") {
  LinearProgram program;
  CHECK_THROWS_AS(SolveLinearProgram(program), Error);
  program.b = Vec({1});
  program.columns = {Vec({1})};
  CHECK_THROWS_AS(SolveLinearProgram(program), Error);
  program.c = {1};
  program.columns = {Vec({1, 0})};
  CHECK_THROWS_AS(SolveLinearProgram(program), Error);
}

}  // namespace cguide::exact
