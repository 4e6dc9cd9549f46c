#include <algorithm>
#include <cmath>
#include <utility>

#include "cguide/numeric/insertion_order_internal.h"

namespace cguide::numeric {
namespace {

/** The lower triangle of L with C = L L', the reciprocals of its diagonal on its diagonal. */
using Triangle = double[6][6];

// A direction that hardly occurs, be it for rounding alone, is not divided by: no pivot is below
// 2^-40 of the trace.
void Factor(Triangle& c) {
  double trace = 0;
  for (int k = 0; k < 6; ++k) trace += c[k][k];
  const double least = 0x1p-40 * trace;
  for (int k = 0; k < 6; ++k) {
    for (int i = k; i < 6; ++i) {
      for (int j = 0; j < k; ++j) c[i][k] -= c[i][j] * c[k][j];
    }
    const double reciprocal = 1 / std::sqrt(std::max(c[k][k], least));
    for (int i = k + 1; i < 6; ++i) c[i][k] *= reciprocal;
    c[k][k] = reciprocal;
  }
}

Vector6d Solve(const Triangle& l, const Vector6d& a) {
  Vector6d z;
  for (int i = 0; i < 6; ++i) {
    double sum = a[i];
    for (int j = 0; j < i; ++j) sum -= l[i][j] * z[j];
    z[i] = sum * l[i][i];
  }
  return z;
}

}  // namespace

void SortOutermostFirst(std::span<const Vector6d> rows, std::span<const int> nonzero,
                        std::vector<int>* indices) {
  Triangle c = {};
  Vector6d sum = Vector6d::Zero();
  for (const int i : nonzero) {
    const Vector6d& a = rows[i];
    sum += a;
    for (int j = 0; j < 6; ++j) {
      for (int k = 0; k <= j; ++k) c[j][k] += a[j] * a[k];
    }
  }
  Factor(c);
  const Vector6d mean = Solve(c, sum);
  std::vector<std::pair<double, int>> keyed;
  keyed.reserve(indices->size());
  for (const int i : *indices) {
    const Vector6d z = Solve(c, rows[i]);
    const double cosine = z.dot(mean) / z.norm();
    keyed.emplace_back(std::isfinite(cosine) ? cosine : 0, i);
  }
  std::sort(keyed.begin(), keyed.end());
  for (std::size_t k = 0; k < keyed.size(); ++k) (*indices)[k] = keyed[k].second;
}

}  // namespace cguide::numeric
