#include <algorithm>

#include "cguide/numeric/float_normals_internal.h"
#include "cguide/numeric/fp_guard.h"
#include "cguide/numeric/lanes_internal.h"
#include "cguide/numeric/minors_internal.h"

namespace cguide::numeric {
namespace {

using Set = std::array<std::int32_t, 5>;

template <Lanes8 V>
CGUIDE_INLINE void NormalsKernel(const Vector6d* rows, const Set* sets, int count,
                                 Vector6d* normals) {
  for (int begin = 0; begin < count; begin += 8) {
    const int lanes = std::min(8, count - begin);
    double entry[30][8] = {};
    for (int lane = 0; lane < lanes; ++lane) {
      for (int i = 0; i < 5; ++i) {
        const double* const row = rows[sets[begin + lane][i]].data();
        for (int k = 0; k < 6; ++k) entry[6 * i + k][lane] = row[k];
      }
    }
    V r[30], y[6];
    for (int j = 0; j < 30; ++j) r[j] = Load<V>(entry[j]);
    InlinedNormalOfRows<V, V, V>(r, r + 6, r + 12, r + 18, r + 24, y);
    for (int k = 0; k < 6; ++k) Store(y[k], entry[k]);
    for (int lane = 0; lane < lanes; ++lane) {
      for (int k = 0; k < 6; ++k) normals[begin + lane][k] = entry[k][lane];
    }
  }
}

CGUIDE_DISPATCH(void, Dispatch, NormalsKernel,
                (const Vector6d* rows, const Set* sets, int count, Vector6d* normals),
                (rows, sets, count, normals))

}  // namespace

void FloatNormals(std::span<const Vector6d> rows, std::span<const Set> sets, Vector6d* normals) {
  Dispatch(rows.data(), sets.data(), static_cast<int>(sets.size()), normals);
}

}  // namespace cguide::numeric
