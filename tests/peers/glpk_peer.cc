#include "tests/peers/glpk_peer.h"

#include <glpk.h>

namespace cguide::peers {

bool GlpkMember(std::span<const Eigen::Matrix<double, 6, 1>> generators,
                const Eigen::Matrix<double, 6, 1>& v, const GlpkOptions& options) {
  glp_prob* lp = glp_create_prob();
  glp_add_rows(lp, 6);
  for (int i = 0; i < 6; ++i) glp_set_row_bnds(lp, i + 1, GLP_FX, v[i], v[i]);
  const int rows[7] = {0, 1, 2, 3, 4, 5, 6};
  if (!generators.empty()) glp_add_cols(lp, static_cast<int>(generators.size()));
  for (std::size_t j = 0; j < generators.size(); ++j) {
    double values[7] = {0};
    for (int i = 0; i < 6; ++i) values[i + 1] = generators[j][i];
    glp_set_mat_col(lp, static_cast<int>(j) + 1, 6, rows, values);
    glp_set_col_bnds(lp, static_cast<int>(j) + 1, GLP_LO, 0, 0);
  }
  glp_smcp parameters;
  glp_init_smcp(&parameters);
  parameters.msg_lev = GLP_MSG_OFF;
  parameters.tol_bnd = parameters.tol_dj = options.tolerance;
  const int status = glp_simplex(lp, &parameters);
  const bool feasible = status == 0 && glp_get_status(lp) == GLP_OPT;
  glp_delete_prob(lp);
  return feasible;
}

}  // namespace cguide::peers
