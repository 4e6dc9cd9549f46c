#include "cguide/numeric/task_stack.h"

#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <random>

#include "tests/random_robot.h"

namespace cguide::numeric {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// A robot of n free sliders: the task rows act on [root; joints] and nothing else matters.
struct Fixture {
  explicit Fixture(int joints, double limit) {
    robot.links.resize(static_cast<std::size_t>(joints) + 1);
    robot.links[0].mass = 1;
    for (int i = 0; i < joints; ++i) {
      Joint joint;
      joint.name = "slider" + std::to_string(i);
      joint.type = JointType::kPrismatic;
      joint.parent = i;
      joint.child = i + 1;
      joint.lower = -limit;
      joint.upper = limit;
      robot.joints.push_back(joint);
    }
    AssignBodiesAndColumns(&robot);
    q.joints.setZero(joints);
  }
  Robot robot;
  Configuration q;
};

TaskStackOptions Undamped() {
  TaskStackOptions options;
  options.damping = 0;
  options.max_translation = options.max_rotation = 1e9;
  return options;
}

std::vector<Task> RandomTasks(std::mt19937_64& rng, int count, int size) {
  std::vector<Task> tasks(static_cast<std::size_t>(count));
  std::normal_distribution<double> normal;
  for (Task& task : tasks) {
    task.row.resize(size);
    for (double& x : task.row) x = normal(rng);
    task.rate = normal(rng);
  }
  return tasks;
}

TEST_CASE("compatible tasks are all met by the step of least norm") {
  std::mt19937_64 rng(1);
  const Fixture f(8, 1e6);
  const KinematicTree tree(f.robot);
  TaskStackWorkspace ws;
  for (int trial = 0; trial < 100; ++trial) {
    const auto tasks = RandomTasks(rng, 1 + trial % 10, 14);
    MatrixXd J(static_cast<int>(tasks.size()), 14);
    VectorXd e(J.rows());
    for (int i = 0; i < J.rows(); ++i) {
      J.row(i) = tasks[static_cast<std::size_t>(i)].row;
      e[i] = tasks[static_cast<std::size_t>(i)].rate;
    }
    const VectorXd step = SolveTaskStack(tree, f.q, tasks, Undamped(), &ws);
    const VectorXd reference = J.completeOrthogonalDecomposition().solve(e);
    CHECK((step - reference).norm() < 1e-8 * (1 + reference.norm()));
  }
}

TEST_CASE("a task never disturbs those above it, even where it contradicts them") {
  std::mt19937_64 rng(2);
  const Fixture f(4, 1e6);
  const KinematicTree tree(f.robot);
  TaskStackWorkspace ws;
  for (int trial = 0; trial < 100; ++trial) {
    auto tasks = RandomTasks(rng, 4, 10);
    tasks[2].row = 2 * tasks[0].row - tasks[1].row;  // dependent, with a rate of its own
    const VectorXd step = SolveTaskStack(tree, f.q, tasks, Undamped(), &ws);
    for (int i : {0, 1, 3}) {
      const Task& task = tasks[static_cast<std::size_t>(i)];
      CHECK(task.row.dot(step) == Approx(task.rate).margin(1e-8));
    }
  }
}

TEST_CASE("damping bounds the step near a singular row") {
  const Fixture f(4, 1e6);
  const KinematicTree tree(f.robot);
  TaskStackWorkspace ws;
  TaskStackOptions options = Undamped();
  options.damping = 0.1;
  Task task;
  task.row = VectorXd::Zero(10);
  for (double norm : {1e-12, 1e-6, 1e-3, 0.1, 1.0}) {
    task.row[7] = norm;
    task.rate = 1;
    const VectorXd step = SolveTaskStack(tree, f.q, {&task, 1}, options, &ws);
    CHECK(step.norm() <= 1 / (2 * options.damping) + 1e-12);  // max of x / (x^2 + d^2)
  }
}

TEST_CASE("columns at their limits are left out and the others take over") {
  std::mt19937_64 rng(3);
  const Fixture f(6, 0.05);
  const KinematicTree tree(f.robot);
  TaskStackWorkspace ws;
  for (int trial = 0; trial < 200; ++trial) {
    const auto tasks = RandomTasks(rng, 3, 12);
    const VectorXd step = SolveTaskStack(tree, f.q, tasks, Undamped(), &ws);
    CHECK(step.tail(6).cwiseAbs().maxCoeff() <= 0.05 * (1 + 1e-12));
    // The free root has six velocities, enough for three tasks whatever the joints do.
    for (const Task& task : tasks) CHECK(task.row.dot(step) == Approx(task.rate).margin(1e-7));
  }
}

TEST_CASE("the step clamp keeps the direction") {
  std::mt19937_64 rng(4);
  const Fixture f(5, 1e6);
  const KinematicTree tree(f.robot);
  TaskStackWorkspace ws;
  const auto tasks = RandomTasks(rng, 4, 11);
  TaskStackOptions clamped = Undamped();
  clamped.max_translation = 1e-3;
  clamped.max_rotation = 1e-3;
  const VectorXd whole = SolveTaskStack(tree, f.q, tasks, Undamped(), &ws);
  const VectorXd part = SolveTaskStack(tree, f.q, tasks, clamped, &ws);
  CHECK(part.head<3>().norm() <= 1e-3 * (1 + 1e-12));
  CHECK(part.tail(5).cwiseAbs().maxCoeff() <= 1e-3 * (1 + 1e-12));
  CHECK((part / part.norm() - whole / whole.norm()).norm() < 1e-9);
}

TEST_CASE("no task, no motion") {
  const Fixture f(3, 1);
  TaskStackWorkspace ws;
  CHECK(SolveTaskStack(KinematicTree(f.robot), f.q, {}, {}, &ws).isZero());
}

}  // namespace
}  // namespace cguide::numeric
