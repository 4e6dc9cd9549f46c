#include "tests/peers/cgal_qp_peer.h"

#include <CGAL/Gmpzf.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <vector>

namespace cguide::peers {
namespace {

template <typename Number>
bool IsMember(std::span<const Eigen::Matrix<double, 6, 1>> generators,
              const Eigen::Matrix<double, 6, 1>& v) {
  std::vector<const double*> columns;
  columns.reserve(generators.size());
  for (const auto& a : generators) columns.push_back(a.data());
  const auto program = CGAL::make_nonnegative_linear_program_from_iterators(
      static_cast<int>(generators.size()), 6, columns.data(), v.data(),
      CGAL::Const_oneset_iterator<CGAL::Comparison_result>(CGAL::EQUAL),
      CGAL::Const_oneset_iterator<double>(0));
  return !CGAL::solve_nonnegative_linear_program(program, Number()).is_infeasible();
}

}  // namespace

bool CgalQpMember(std::span<const Eigen::Matrix<double, 6, 1>> generators,
                  const Eigen::Matrix<double, 6, 1>& v) {
  return IsMember<CGAL::Gmpzf>(generators, v);
}

std::optional<bool> CgalQpMemberInDoubles(std::span<const Eigen::Matrix<double, 6, 1>> generators,
                                          const Eigen::Matrix<double, 6, 1>& v) {
  const pid_t child = fork();
  if (child < 0) return std::nullopt;
  if (child == 0) {
    const itimerval limit{{0, 0}, {0, 50000}};
    setitimer(ITIMER_VIRTUAL, &limit, nullptr);  // ends the process
    _exit(IsMember<double>(generators, v) ? 1 : 0);
  }
  int status = 0;
  if (waitpid(child, &status, 0) != child || !WIFEXITED(status)) return std::nullopt;
  if (WEXITSTATUS(status) > 1) return std::nullopt;
  return WEXITSTATUS(status) == 1;
}

}  // namespace cguide::peers
