#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "cguide/numeric/point_lanes_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

// Four doubles; the compiler splits it where registers are narrower.
typedef double Lane __attribute__((vector_size(32)));
typedef long long Mask __attribute__((vector_size(32)));

constexpr int kBlock = 8;

// One set of loops, compiled for the baseline and for AVX2. Contraction into fused operations is
// off for the whole library, so both give the same doubles.
#define CGUIDE_INLINE __attribute__((always_inline)) inline
#if defined(__x86_64__)
#define CGUIDE_WIDE __attribute__((target("avx2")))
#else
#define CGUIDE_WIDE
#endif

CGUIDE_INLINE void Load(const double* from, Lane* to) { std::memcpy(to, from, sizeof *to); }

CGUIDE_INLINE void Fill(double x, Lane* to) { *to = Lane{x, x, x, x}; }

struct Direction {
  const double* n;
  const double* origin;
};

struct Filled {
  Lane x, y, z;
};

CGUIDE_INLINE void FillAll(const double* from, Filled* to) {
  Fill(from[0], &to->x);
  Fill(from[1], &to->y);
  Fill(from[2], &to->z);
}

// Both halves of a block of n.p; `at` is its first x. Written out, so that it stays in registers.
CGUIDE_INLINE void Dot(const double* at, const Filled& n, Lane* low, Lane* high) {
  Lane x, y, z;
  Load(at, &x);
  Load(at + kBlock, &y);
  Load(at + 2 * kBlock, &z);
  *low = n.x * x + n.y * y + n.z * z;
  Load(at + 4, &x);
  Load(at + kBlock + 4, &y);
  Load(at + 2 * kBlock + 4, &z);
  *high = n.x * x + n.y * y + n.z * z;
}

// The same of n.(p - origin).
CGUIDE_INLINE void DotFrom(const double* at, const Filled& n, const Filled& origin, Lane* low,
                           Lane* high) {
  Lane x, y, z;
  Load(at, &x);
  Load(at + kBlock, &y);
  Load(at + 2 * kBlock, &z);
  *low = n.x * (x - origin.x) + n.y * (y - origin.y) + n.z * (z - origin.z);
  Load(at + 4, &x);
  Load(at + kBlock + 4, &y);
  Load(at + 2 * kBlock + 4, &z);
  *high = n.x * (x - origin.x) + n.y * (y - origin.y) + n.z * (z - origin.z);
}

// Keeps the greater value with its index, of equal ones the lower index.
CGUIDE_INLINE void Keep(const Lane& value, const Mask& index, Lane* best, Mask* at) {
  const Mask more = (value > *best) | ((value == *best) & (index < *at));
  *best = more ? value : *best;
  *at = more ? index : *at;
}

CGUIDE_INLINE int FarthestLoop(const double* data, int blocks, const double* direction) {
  Filled n;
  FillAll(direction, &n);
  Lane best0, best1, low, high;
  Dot(data, n, &best0, &best1);
  Mask at0 = {0, 1, 2, 3}, at1 = {4, 5, 6, 7}, index = at0;
  const Mask step = {kBlock, kBlock, kBlock, kBlock}, half = {4, 4, 4, 4};
  for (int i = 1; i < blocks; ++i) {
    index += step;
    Dot(data + 3 * kBlock * i, n, &low, &high);
    const Mask more0 = low > best0, more1 = high > best1;
    best0 = more0 ? low : best0;
    best1 = more1 ? high : best1;
    at0 = more0 ? index : at0;
    at1 = more1 ? index + half : at1;
  }
  Keep(best1, at1, &best0, &at0);
  Keep(__builtin_shufflevector(best0, best0, 2, 3, 0, 1),
       __builtin_shufflevector(at0, at0, 2, 3, 0, 1), &best0, &at0);
  Keep(__builtin_shufflevector(best0, best0, 1, 0, 3, 2),
       __builtin_shufflevector(at0, at0, 1, 0, 3, 2), &best0, &at0);
  return static_cast<int>(at0[0]);
}

CGUIDE_INLINE double GreatestLoop(const double* data, int blocks, const double* direction) {
  Filled n;
  FillAll(direction, &n);
  Lane best0, best1, low, high;
  Dot(data, n, &best0, &best1);
  for (int i = 1; i < blocks; ++i) {
    Dot(data + 3 * kBlock * i, n, &low, &high);
    best0 = low > best0 ? low : best0;
    best1 = high > best1 ? high : best1;
  }
  best0 = best1 > best0 ? best1 : best0;
  low = __builtin_shufflevector(best0, best0, 2, 3, 0, 1);
  best0 = low > best0 ? low : best0;
  return best0[1] > best0[0] ? best0[1] : best0[0];
}

CGUIDE_INLINE double LeastFromLoop(const double* data, int blocks, Direction direction) {
  Filled n, origin;
  FillAll(direction.n, &n);
  FillAll(direction.origin, &origin);
  Lane best0, best1, low, high;
  DotFrom(data, n, origin, &best0, &best1);
  for (int i = 1; i < blocks; ++i) {
    DotFrom(data + 3 * kBlock * i, n, origin, &low, &high);
    best0 = low < best0 ? low : best0;
    best1 = high < best1 ? high : best1;
  }
  best0 = best1 < best0 ? best1 : best0;
  low = __builtin_shufflevector(best0, best0, 2, 3, 0, 1);
  best0 = low < best0 ? low : best0;
  return best0[1] < best0[0] ? best0[1] : best0[0];
}

CGUIDE_INLINE void CollectLoop(const double* data, int blocks, Direction direction, double limit,
                               std::vector<int>* indices) {
  Filled n, origin;
  FillAll(direction.n, &n);
  FillAll(direction.origin, &origin);
  Lane most, low, high;
  Fill(limit, &most);
  for (int i = 0; i < blocks; ++i) {
    DotFrom(data + 3 * kBlock * i, n, origin, &low, &high);
    const Mask beyond = (low > most) & (high > most);
    if ((beyond[0] & beyond[1] & beyond[2] & beyond[3]) != 0) continue;
    for (int k = 0; k < kBlock; ++k) {
      if (!((k < 4 ? low[k] : high[k - 4]) > limit)) indices->push_back(kBlock * i + k);
    }
  }
}

CGUIDE_WIDE int FarthestWide(const double* d, int b, const double* n) {
  return FarthestLoop(d, b, n);
}
CGUIDE_WIDE double GreatestWide(const double* d, int b, const double* n) {
  return GreatestLoop(d, b, n);
}
CGUIDE_WIDE double LeastFromWide(const double* d, int b, Direction n) {
  return LeastFromLoop(d, b, n);
}
CGUIDE_WIDE void CollectWide(const double* d, int b, Direction n, double limit,
                             std::vector<int>* indices) {
  CollectLoop(d, b, n, limit, indices);
}

bool HasWideRegisters() {
#if defined(__x86_64__)
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
#else
  return false;
#endif
}

}  // namespace

PointLanes::PointLanes(std::span<const Vector3d> points)
    : size_(static_cast<int>(points.size())),
      blocks_((size_ + kBlock - 1) / kBlock),
      data_(std::make_unique_for_overwrite<double[]>(
          static_cast<std::size_t>(3 * kBlock * blocks_))) {
  double low[3], high[3], poison = 0;
  for (int k = 0; k < 3; ++k) low[k] = high[k] = points[0][k];
  for (int i = 0; i < kBlock * blocks_; ++i) {
    const double* p = points[i < size_ ? i : size_ - 1].data();
    double* at = data_.get() + 3 * kBlock * (i / kBlock) + i % kBlock;
    for (int k = 0; k < 3; ++k) {
      at[kBlock * k] = p[k];
      low[k] = p[k] < low[k] ? p[k] : low[k];
      high[k] = p[k] > high[k] ? p[k] : high[k];
      poison += 0 * p[k];  // NaN where p[k] is NaN or an infinity
    }
  }
  is_finite_ = poison == 0;
  lower_ = Vector3d(low[0], low[1], low[2]);
  upper_ = Vector3d(high[0], high[1], high[2]);
}

int PointLanes::Farthest(const Vector3d& n) const {
  const int index = HasWideRegisters() ? FarthestWide(data_.get(), blocks_, n.data())
                                       : FarthestLoop(data_.get(), blocks_, n.data());
  return std::min(index, size_ - 1);
}

double PointLanes::Greatest(const Vector3d& n) const {
  return HasWideRegisters() ? GreatestWide(data_.get(), blocks_, n.data())
                            : GreatestLoop(data_.get(), blocks_, n.data());
}

double PointLanes::LeastFrom(const Vector3d& origin, const Vector3d& n) const {
  const Direction direction{n.data(), origin.data()};
  return HasWideRegisters() ? LeastFromWide(data_.get(), blocks_, direction)
                            : LeastFromLoop(data_.get(), blocks_, direction);
}

void PointLanes::CollectWithin(const Vector3d& origin, const Vector3d& n, double limit,
                               std::vector<int>* indices) const {
  const Direction direction{n.data(), origin.data()};
  if (HasWideRegisters()) {
    CollectWide(data_.get(), blocks_, direction, limit, indices);
  } else {
    CollectLoop(data_.get(), blocks_, direction, limit, indices);
  }
  while (!indices->empty() && indices->back() >= size_) indices->pop_back();
}

}  // namespace cguide::numeric
