#pragma once

#include <Eigen/Core>
#include <span>

// GLPK's simplex as its users call it: feasibility of A lambda = v, lambda >= 0.
namespace cguide::peers {

struct GlpkOptions {
  double tolerance = 1e-7;  ///< tol_bnd, tol_dj: GLPK's default
};

/** What the status says of v in the closed cone. A float verdict. */
bool GlpkMember(std::span<const Eigen::Matrix<double, 6, 1>> generators,
                const Eigen::Matrix<double, 6, 1>& v, const GlpkOptions& options = {});

}  // namespace cguide::peers
