#pragma once

#include <cmath>
#include <cstdint>

// Kernels are templates on a type of eight lanes. CGUIDE_DISPATCH compiles one for several
// instruction sets and picks one as the program starts. All of them round every operation once
// (-ffp-contract=off keeps fused operations out) and lanes hold independent results, so that they
// compute the same bits.
#define CGUIDE_INLINE __attribute__((always_inline)) inline

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__)
/** Defines the function `name` by the best version of kernel<Lanes8>; its parameters and how they
 are handed on are given in parentheses. */
#define CGUIDE_DISPATCH(result, name, kernel, parameters, arguments)                         \
  __attribute__((target("avx512f"))) result name##Wide parameters {                          \
    return kernel<Wide8> arguments;                                                          \
  }                                                                                          \
  __attribute__((target("avx2"))) result name##Pairs parameters {                            \
    return kernel<Pair8> arguments;                                                          \
  }                                                                                          \
  result name##Plain parameters { return kernel<Pair8> arguments; }                          \
  result name parameters {                                                                   \
    static result(*const best) parameters = __builtin_cpu_supports("avx512f") ? &name##Wide  \
                                            : __builtin_cpu_supports("avx2")  ? &name##Pairs \
                                                                              : &name##Plain; \
    return best arguments;                                                                   \
  }
#else
#define CGUIDE_DISPATCH(result, name, kernel, parameters, arguments) \
  result name parameters { return kernel<Pair8> arguments; }
#endif

// Vectors as values of inlined functions only: nothing is passed that depends on the instruction
// set.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

namespace cguide::numeric {

/** Eight doubles in one register, or in two of four (vector extension of GCC and clang). */
struct Wide8 {
  using Part = double __attribute__((vector_size(64)));
  using Bits = std::uint64_t __attribute__((vector_size(64)));
  using Stored = double __attribute__((vector_size(64), aligned(8), may_alias));
  Part part[1];
};
struct Pair8 {
  using Part = double __attribute__((vector_size(32)));
  using Bits = std::uint64_t __attribute__((vector_size(32)));
  using Stored = double __attribute__((vector_size(32), aligned(8), may_alias));
  Part part[2];
};

template <typename V>
inline constexpr int kParts = sizeof(V::part) / sizeof(typename V::Part);

template <typename V>
concept Lanes8 = sizeof(V) == 64 && requires {
  typename V::Part;
};

// Parts are named one by one, not in a loop: g++ keeps what a loop indexes in memory, and copies it
// there in pieces of 16 bytes, for which a load of 32 has to wait.

template <Lanes8 V>
CGUIDE_INLINE V Lanes(double x) {
  V v;
  if constexpr (kParts<V> == 1) {
    v.part[0] = typename V::Part{x, x, x, x, x, x, x, x};
  } else {
    v.part[0] = v.part[1] = typename V::Part{x, x, x, x};
  }
  return v;
}
template <Lanes8 V>
CGUIDE_INLINE V operator+(const V& x, const V& y) {
  V z;
  z.part[0] = x.part[0] + y.part[0];
  if constexpr (kParts<V> == 2) z.part[1] = x.part[1] + y.part[1];
  return z;
}
template <Lanes8 V>
CGUIDE_INLINE V operator-(const V& x, const V& y) {
  V z;
  z.part[0] = x.part[0] - y.part[0];
  if constexpr (kParts<V> == 2) z.part[1] = x.part[1] - y.part[1];
  return z;
}
template <Lanes8 V>
CGUIDE_INLINE V operator*(const V& x, const V& y) {
  V z;
  z.part[0] = x.part[0] * y.part[0];
  if constexpr (kParts<V> == 2) z.part[1] = x.part[1] * y.part[1];
  return z;
}
template <Lanes8 V>
CGUIDE_INLINE V operator/(const V& x, const V& y) {
  V z;
  z.part[0] = x.part[0] / y.part[0];
  if constexpr (kParts<V> == 2) z.part[1] = x.part[1] / y.part[1];
  return z;
}
template <Lanes8 V>
CGUIDE_INLINE V operator*(double x, const V& y) {
  V z;
  z.part[0] = x * y.part[0];
  if constexpr (kParts<V> == 2) z.part[1] = x * y.part[1];
  return z;
}
template <Lanes8 V>
CGUIDE_INLINE V operator*(const V& y, double x) {
  return x * y;
}
template <Lanes8 V>
CGUIDE_INLINE V operator+(const V& y, double x) {
  return y + Lanes<V>(x);
}
template <Lanes8 V>
CGUIDE_INLINE V operator-(const V& x) {
  V z;
  z.part[0] = -x.part[0];
  if constexpr (kParts<V> == 2) z.part[1] = -x.part[1];
  return z;
}
template <Lanes8 V>
CGUIDE_INLINE V& operator+=(V& x, const V& y) {
  return x = x + y;
}
template <Lanes8 V>
CGUIDE_INLINE V& operator-=(V& x, const V& y) {
  return x = x - y;
}

/** Lane by lane x > y ? p : q. */
template <Lanes8 V>
CGUIDE_INLINE V IfGreater(const V& x, const V& y, const V& p, const V& q) {
  V z;
  z.part[0] = x.part[0] > y.part[0] ? p.part[0] : q.part[0];
  if constexpr (kParts<V> == 2) z.part[1] = x.part[1] > y.part[1] ? p.part[1] : q.part[1];
  return z;
}
template <Lanes8 V>
CGUIDE_INLINE V Larger(const V& x, const V& y) {
  return IfGreater(x, y, x, y);
}

template <Lanes8 V>
CGUIDE_INLINE V Absolute(const V& x) {
  constexpr std::uint64_t kMagnitude = UINT64_MAX >> 1;
  V z;
  z.part[0] = (typename V::Part)((typename V::Bits)x.part[0] & kMagnitude);  // NOLINT: lanes' bits
  if constexpr (kParts<V> == 2) {
    z.part[1] = (typename V::Part)((typename V::Bits)x.part[1] & kMagnitude);  // NOLINT
  }
  return z;
}

template <Lanes8 V>
CGUIDE_INLINE V Load(const double* p) {
  V v;
  v.part[0] = *reinterpret_cast<const typename V::Stored*>(p);
  if constexpr (kParts<V> == 2) v.part[1] = *reinterpret_cast<const typename V::Stored*>(p + 4);
  return v;
}
template <Lanes8 V>
CGUIDE_INLINE void Store(const V& v, double* p) {
  *reinterpret_cast<typename V::Stored*>(p) = v.part[0];
  if constexpr (kParts<V> == 2) *reinterpret_cast<typename V::Stored*>(p + 4) = v.part[1];
}

using Quad = double __attribute__((vector_size(32)));
using Duo = double __attribute__((vector_size(16)));

/** The two halves of eight lanes, and of four. */
CGUIDE_INLINE void Halve(const Wide8& v, Quad* low, Quad* high) {
  *low = __builtin_shufflevector(v.part[0], v.part[0], 0, 1, 2, 3);
  *high = __builtin_shufflevector(v.part[0], v.part[0], 4, 5, 6, 7);
}
CGUIDE_INLINE void Halve(const Pair8& v, Quad* low, Quad* high) {
  *low = v.part[0];
  *high = v.part[1];
}
CGUIDE_INLINE void Halve(const Quad& v, Duo* low, Duo* high) {
  *low = __builtin_shufflevector(v, v, 0, 1);
  *high = __builtin_shufflevector(v, v, 2, 3);
}

/** The first numbers of eight pairs, and the second ones. */
CGUIDE_INLINE void Unzip(const Duo (&pair)[8], Wide8* first, Wide8* second) {
  Quad half[4];
  for (int i = 0; i < 4; ++i) {
    const int l = i / 2 * 4 + i % 2;
    half[i] = __builtin_shufflevector(pair[l], pair[l + 2], 0, 1, 2, 3);
  }
  const Wide8::Part even = __builtin_shufflevector(half[0], half[2], 0, 1, 2, 3, 4, 5, 6, 7),
                    odd = __builtin_shufflevector(half[1], half[3], 0, 1, 2, 3, 4, 5, 6, 7);
  first->part[0] = __builtin_shufflevector(even, odd, 0, 8, 2, 10, 4, 12, 6, 14);
  second->part[0] = __builtin_shufflevector(even, odd, 1, 9, 3, 11, 5, 13, 7, 15);
}
CGUIDE_INLINE void Unzip(const Duo (&pair)[8], Pair8* first, Pair8* second) {
  for (int i = 0; i < 2; ++i) {
    const Quad even = __builtin_shufflevector(pair[4 * i], pair[4 * i + 2], 0, 1, 2, 3),
               odd = __builtin_shufflevector(pair[4 * i + 1], pair[4 * i + 3], 0, 1, 2, 3);
    first->part[i] = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
    second->part[i] = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
  }
}

/** The largest of eight values: three comparisons deep, without branches. */
template <Lanes8 V>
CGUIDE_INLINE double Largest(const V& v) {
  Quad a, b;
  Halve(v, &a, &b);
  Duo c, d;
  Halve(a > b ? a : b, &c, &d);
  const Duo two = c > d ? c : d;
  return two[0] > two[1] ? two[0] : two[1];
}

/** Labels of lanes, kept in the last bits of their values, so that the largest value brings its own
 along. */
template <Lanes8 V>
struct Labels {
  typename V::Bits part[kParts<V>];
};
template <Lanes8 V>
CGUIDE_INLINE Labels<V> LaneNumbers() {
  Labels<V> labels;
  if constexpr (kParts<V> == 1) {
    labels.part[0] = typename V::Bits{0, 1, 2, 3, 4, 5, 6, 7};
  } else {
    labels.part[0] = typename V::Bits{0, 1, 2, 3};
    labels.part[1] = typename V::Bits{4, 5, 6, 7};
  }
  return labels;
}
template <Lanes8 V>
CGUIDE_INLINE Labels<V> operator+(const Labels<V>& labels, std::uint64_t n) {
  Labels<V> sum;
  sum.part[0] = labels.part[0] + n;
  if constexpr (kParts<V> == 2) sum.part[1] = labels.part[1] + n;
  return sum;
}

/** v with labels in place of the bits of `mask`, the last ones: finite numbers stay finite and move
 by at most 2^-52 mask of themselves. */
template <Lanes8 V>
CGUIDE_INLINE V Labelled(const V& v, const Labels<V>& labels, std::uint64_t mask) {
  V z;
  z.part[0] = (typename V::Part)(((typename V::Bits)v.part[0] & ~mask) |  // NOLINT: lanes' bits
                                 labels.part[0]);
  if constexpr (kParts<V> == 2) {
    z.part[1] = (typename V::Part)(((typename V::Bits)v.part[1] & ~mask) |  // NOLINT
                                   labels.part[1]);
  }
  return z;
}
CGUIDE_INLINE std::uint64_t LabelOf(double x, std::uint64_t mask) {
  std::uint64_t bits;
  __builtin_memcpy(&bits, &x, sizeof(bits));
  return bits & mask;
}

/** ((x0 + x4) + (x2 + x6)) + ((x1 + x5) + (x3 + x7)) */
template <Lanes8 V>
CGUIDE_INLINE double Sum(const V& v) {
  Quad a, b;
  Halve(v, &a, &b);
  Duo c, d;
  Halve(a + b, &c, &d);
  const Duo two = c + d;
  return two[0] + two[1];
}

/** p[0], p[step], ... p[5 step] and two zeros. */
template <Lanes8 V>
CGUIDE_INLINE V LoadSix(const double* p, std::size_t step = 1) {
  const double *q = p + 2 * step, *r = q + 2 * step;
  V v;
  if constexpr (kParts<V> == 1) {
    v.part[0] = typename V::Part{p[0], p[step], q[0], q[step], r[0], r[step], 0, 0};
  } else {
    v.part[0] = typename V::Part{p[0], p[step], q[0], q[step]};
    v.part[1] = typename V::Part{r[0], r[step], 0, 0};
  }
  return v;
}

/** y . (columns j .. j + 7) of six rows: ((y0 a0 + y1 a1) + (y2 a2 + y3 a3)) + (y4 a4 + y5 a5). */
template <Lanes8 V>
CGUIDE_INLINE V ColumnProducts(const double* const (&row)[6], std::size_t j, const double (&y)[6]) {
  return ((y[0] * Load<V>(row[0] + j) + y[1] * Load<V>(row[1] + j)) +
          (y[2] * Load<V>(row[2] + j) + y[3] * Load<V>(row[3] + j))) +
         (y[4] * Load<V>(row[4] + j) + y[5] * Load<V>(row[5] + j));
}
template <Lanes8 V>
CGUIDE_INLINE V ColumnProducts(const double* rows, std::size_t stride, std::size_t j,
                               const double (&y)[6]) {
  const double* const row[6] = {rows,
                                rows + stride,
                                rows + 2 * stride,
                                rows + 3 * stride,
                                rows + 4 * stride,
                                rows + 5 * stride};
  return ColumnProducts<V>(row, j, y);
}

}  // namespace cguide::numeric

#pragma GCC diagnostic pop
