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
  Part part[1];
};
struct Pair8 {
  using Part = double __attribute__((vector_size(32)));
  using Bits = std::uint64_t __attribute__((vector_size(32)));
  Part part[2];
};

template <typename V>
inline constexpr int kParts = sizeof(V::part) / sizeof(typename V::Part);

template <typename V>
concept Lanes8 = sizeof(V) == 64 && requires {
  typename V::Part;
};

template <Lanes8 V>
CGUIDE_INLINE V Lanes(double x) {
  V v;
  for (auto& part : v.part) part = typename V::Part{} + x;
  return v;
}
template <Lanes8 V>
CGUIDE_INLINE V operator+(const V& x, const V& y) {
  V z;
  for (int i = 0; i < kParts<V>; ++i) z.part[i] = x.part[i] + y.part[i];
  return z;
}
template <Lanes8 V>
CGUIDE_INLINE V operator-(const V& x, const V& y) {
  V z;
  for (int i = 0; i < kParts<V>; ++i) z.part[i] = x.part[i] - y.part[i];
  return z;
}
template <Lanes8 V>
CGUIDE_INLINE V operator*(const V& x, const V& y) {
  V z;
  for (int i = 0; i < kParts<V>; ++i) z.part[i] = x.part[i] * y.part[i];
  return z;
}
template <Lanes8 V>
CGUIDE_INLINE V operator/(const V& x, const V& y) {
  V z;
  for (int i = 0; i < kParts<V>; ++i) z.part[i] = x.part[i] / y.part[i];
  return z;
}
template <Lanes8 V>
CGUIDE_INLINE V operator*(double x, const V& y) {
  V z;
  for (int i = 0; i < kParts<V>; ++i) z.part[i] = x * y.part[i];
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
  for (int i = 0; i < kParts<V>; ++i) z.part[i] = -x.part[i];
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
  for (int i = 0; i < kParts<V>; ++i) z.part[i] = x.part[i] > y.part[i] ? p.part[i] : q.part[i];
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
  for (int i = 0; i < kParts<V>; ++i) {
    z.part[i] =
        (typename V::Part)((typename V::Bits)x.part[i] & kMagnitude);  // NOLINT: lanes' bits
  }
  return z;
}

template <Lanes8 V>
CGUIDE_INLINE V Load(const double* p) {
  V v;
  __builtin_memcpy(&v, p, sizeof(V));
  return v;
}
template <Lanes8 V>
CGUIDE_INLINE void Store(const V& v, double* p) {
  __builtin_memcpy(p, &v, sizeof(V));
}

/** Of eight values the largest and its lane, by a tournament: three rounds deep. */
struct Champion {
  double value;
  int lane;
};
CGUIDE_INLINE Champion Better(const Champion& x, const Champion& y) {
  const bool second = y.value > x.value;
  return {second ? y.value : x.value, second ? y.lane : x.lane};
}
template <Lanes8 V>
CGUIDE_INLINE Champion Largest(const V& v) {
  double x[8];
  Store(v, x);
  const Champion a = Better({x[0], 0}, {x[1], 1}), b = Better({x[2], 2}, {x[3], 3}),
                 c = Better({x[4], 4}, {x[5], 5}), d = Better({x[6], 6}, {x[7], 7});
  return Better(Better(a, b), Better(c, d));
}

template <Lanes8 V>
CGUIDE_INLINE double Sum(const V& v) {
  double x[8];
  Store(v, x);
  return ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]));
}

/** y . (columns j .. j + 7) of six rows: ((y0 a0 + y1 a1) + (y2 a2 + y3 a3)) + (y4 a4 + y5 a5). */
template <Lanes8 V>
CGUIDE_INLINE V ColumnProducts(const double* rows, std::size_t stride, std::size_t j,
                               const double (&y)[6]) {
  const double* a = rows + j;
  return ((y[0] * Load<V>(a) + y[1] * Load<V>(a + stride)) +
          (y[2] * Load<V>(a + 2 * stride) + y[3] * Load<V>(a + 3 * stride))) +
         (y[4] * Load<V>(a + 4 * stride) + y[5] * Load<V>(a + 5 * stride));
}

}  // namespace cguide::numeric

#pragma GCC diagnostic pop
