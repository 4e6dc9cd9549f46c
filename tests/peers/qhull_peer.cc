#include "tests/peers/qhull_peer.h"

#include <libqhull_r/qhull_ra.h>

#include <Eigen/QR>
#include <cstdio>

namespace cguide::peers {

bool QhullFacets(std::span<const Eigen::Matrix<double, 6, 1>> generators,
                 const Eigen::Matrix<double, 6, 1>& w,
                 std::vector<Eigen::Matrix<double, 6, 1>>* facets) {
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  facets->clear();
  if (generators.size() < 6) return false;
  const Vector6d unit = w.normalized();
  const Eigen::Matrix<double, 6, 6> Q =
      Eigen::HouseholderQR<Vector6d>(unit).householderQ() * Eigen::Matrix<double, 6, 6>::Identity();
  std::vector<double> points(5 * generators.size());
  for (std::size_t i = 0; i < generators.size(); ++i) {
    const Eigen::Matrix<double, 5, 1> x =
        Q.rightCols<5>().transpose() * generators[i] / unit.dot(generators[i]);
    for (int k = 0; k < 5; ++k) points[5 * i + k] = x[k];
  }
  qhT memory;
  qhT* qh = &memory;
  QHULL_LIB_CHECK
  qh_zero(qh, nullptr);
  static std::FILE* const log = std::fopen("/dev/null", "w");
  char command[] = "qhull Qt";
  const int failed = qh_new_qhull(qh, 5, static_cast<int>(generators.size()), points.data(), False,
                                  command, nullptr, log);
  if (failed == 0) {
    // normal . x + offset <= 0 with x = (Q' a) / (unit . a).
    facetT* facet;
    FORALLfacets {
      Vector6d h = facet->offset * unit;
      for (int k = 0; k < 5; ++k) h += facet->normal[k] * Q.col(k + 1);
      facets->push_back(h);
    }
  }
  qh_freeqhull(qh, !qh_ALL);
  int current = 0, total = 0;
  qh_memfreeshort(qh, &current, &total);
  return failed == 0;
}

}  // namespace cguide::peers
