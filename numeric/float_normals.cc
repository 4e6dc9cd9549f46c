#include <algorithm>

#include "cguide/numeric/float_normals_internal.h"
#include "cguide/numeric/fp_guard.h"
#include "cguide/numeric/lanes_internal.h"
#include "cguide/numeric/minors_internal.h"

namespace cguide::numeric {
namespace {

template <Lanes8 V>
CGUIDE_INLINE void NormalsKernel(const Vector6d* rows, FloatNormals* result) {
  const int count = static_cast<int>(result->sets.size());
  for (int begin = 0; begin < count; begin += 8) {
    const int lanes = std::min(8, count - begin);
    alignas(64) double entry[36][8] = {};
    for (int lane = 0; lane < lanes; ++lane) {
      for (int i = 0; i < 6; ++i) {
        const double* const row = rows[result->sets[begin + lane][i]].data();
        for (int k = 0; k < 6; ++k) entry[6 * i + k][lane] = row[k];
      }
    }
    V r[36], y[6];
    for (int j = 0; j < 36; ++j) r[j] = Load<V>(entry[j]);
    InlinedNormalOfRows<V, V, V>(r, r + 6, r + 12, r + 18, r + 24, y);
    const V* const a = r + 30;
    const V product =
        ((y[0] * a[0] + y[1] * a[1]) + (y[2] * a[2] + y[3] * a[3])) + (y[4] * a[4] + y[5] * a[5]);
    V largest = Absolute(y[0]);
    for (int k = 1; k < 6; ++k) largest = Larger(largest, Absolute(y[k]));
    for (int k = 0; k < 6; ++k) Store(y[k], entry[k]);
    Store(product, entry[6]);
    Store(largest, entry[7]);
    for (int lane = 0; lane < lanes; ++lane) {
      for (int k = 0; k < 6; ++k) result->normals[begin + lane][k] = entry[k][lane];
      result->products[begin + lane] = entry[6][lane];
      result->largest[begin + lane] = entry[7][lane];
    }
  }
}

CGUIDE_DISPATCH(void, Dispatch, NormalsKernel, (const Vector6d* rows, FloatNormals* result),
                (rows, result))

}  // namespace

void FloatNormals::Compute(std::span<const Vector6d> rows) {
  normals.resize(sets.size());
  largest.resize(sets.size());
  products.resize(sets.size());
  Dispatch(rows.data(), this);
}

}  // namespace cguide::numeric
