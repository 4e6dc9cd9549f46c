#pragma once

namespace cguide::numeric {

/** The normal y of five vectors of R^6: y.a = det(r0; r1; r2; r3; r4; a) for every a, so y_k is
 (-1)^(k+1) times the minor without column k. By Laplace's expansion: 2x2 minors of rows 0, 1 and of
 rows 2, 3, from them the 4x4 minors of rows 0..3, then row 4. Without division, so that it serves
 doubles and integers. T1 are entries, T2, T4, T5 hold minors of that order. For lanes, which are
 not passed between functions, this form. */
template <typename T2, typename T4, typename T5, typename T1>
__attribute__((always_inline)) inline void InlinedNormalOfRows(const T1* r0, const T1* r1,
                                                               const T1* r2, const T1* r3,
                                                               const T1* r4, T5* y) {
  // Pairs j < k in lexicographic order.
  static constexpr int kPair[6][6] = {{-1, 0, 1, 2, 3, 4},    {0, -1, 5, 6, 7, 8},
                                      {1, 5, -1, 9, 10, 11},  {2, 6, 9, -1, 12, 13},
                                      {3, 7, 10, 12, -1, 14}, {4, 8, 11, 13, 14, -1}};
  T2 a[15], b[15];
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) {
#pragma GCC unroll 6
    for (int k = j + 1; k < 6; ++k) {
      a[kPair[j][k]] = r0[j] * r1[k];
      a[kPair[j][k]] -= r0[k] * r1[j];
      b[kPair[j][k]] = r2[j] * r3[k];
      b[kPair[j][k]] -= r2[k] * r3[j];
    }
  }
  // The 4x4 minor without columns p < q, stored under the pair (p, q).
  T4 m[15];
#pragma GCC unroll 6
  for (int p = 0; p < 6; ++p) {
#pragma GCC unroll 6
    for (int q = p + 1; q < 6; ++q) {
      int c[4] = {}, n = 0;
#pragma GCC unroll 6
      for (int k = 0; k < 6; ++k) {
        if (k != p && k != q) c[n++] = k;
      }
      T4 sum = a[kPair[c[0]][c[1]]] * b[kPair[c[2]][c[3]]];
      sum -= a[kPair[c[0]][c[2]]] * b[kPair[c[1]][c[3]]];
      sum += a[kPair[c[0]][c[3]]] * b[kPair[c[1]][c[2]]];
      sum += a[kPair[c[1]][c[2]]] * b[kPair[c[0]][c[3]]];
      sum -= a[kPair[c[1]][c[3]]] * b[kPair[c[0]][c[2]]];
      sum += a[kPair[c[2]][c[3]]] * b[kPair[c[0]][c[1]]];
      m[kPair[p][q]] = sum;
    }
  }
#pragma GCC unroll 6
  for (int k = 0; k < 6; ++k) {
    // Column j is at place i among those without k; its cofactor in the last row has sign (-1)^i.
    T5 sum{};
    int i = 0;
#pragma GCC unroll 6
    for (int j = 0; j < 6; ++j) {
      if (j == k) continue;
      const bool minus = (i + k + 1) % 2 != 0;
      if (minus) {
        sum -= m[kPair[j][k]] * r4[j];
      } else {
        sum += m[kPair[j][k]] * r4[j];
      }
      ++i;
    }
    y[k] = sum;
  }
}

template <typename T2, typename T4, typename T5, typename T1>
inline void NormalOfRows(const T1* r0, const T1* r1, const T1* r2, const T1* r3, const T1* r4,
                         T5* y) {
  InlinedNormalOfRows<T2, T4, T5>(r0, r1, r2, r3, r4, y);
}

}  // namespace cguide::numeric
