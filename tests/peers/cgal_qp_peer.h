#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

// CGAL's QP_solver as its users call it [CGAL manual, "Linear and Quadratic Programming Solver"]:
// the nonnegative linear program A lambda = v with a zero objective, given by iterators, doubles as
// input and Gmpzf as the exact number type, default options.
namespace cguide::peers {

/** Whether v is in the closed cone of the generators: exact. */
bool CgalQpMember(std::span<const Eigen::Matrix<double, 6, 1>> generators,
                  const Eigen::Matrix<double, 6, 1>& v);

/** The same with double in place of the exact number type, the quick choice of users, for which
 CGAL promises nothing: it can cycle for ever. Asked in a process of its own, and given up after 50
 ms of processor time, where the exact type takes about one: then, or where it ends the process,
 nothing. */
std::optional<bool> CgalQpMemberInDoubles(std::span<const Eigen::Matrix<double, 6, 1>> generators,
                                          const Eigen::Matrix<double, 6, 1>& v);

}  // namespace cguide::peers
