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

// n.p of half a block; `at` is its first x.
CGUIDE_INLINE void Dot(const double* at, const Lane* n, Lane* result) {
  Lane x, y, z;
  Load(at, &x);
  Load(at + kBlock, &y);
  Load(at + 2 * kBlock, &z);
  *result = n[0] * x + n[1] * y + n[2] * z;
}

CGUIDE_INLINE void DotFrom(const double* at, const Lane* n, const Lane* origin, Lane* result) {
  Lane x, y, z;
  Load(at, &x);
  Load(at + kBlock, &y);
  Load(at + 2 * kBlock, &z);
  *result = n[0] * (x - origin[0]) + n[1] * (y - origin[1]) + n[2] * (z - origin[2]);
}

CGUIDE_INLINE int FarthestLoop(const double* data, int blocks, const double* direction) {
  Lane n[3], best[2], dot;
  for (int k = 0; k < 3; ++k) Fill(direction[k], &n[k]);
  Mask block[2] = {Mask{0, 0, 0, 0}, Mask{0, 0, 0, 0}};
  for (int half = 0; half < 2; ++half) Dot(data + 4 * half, n, &best[half]);
  for (long long i = 1; i < blocks; ++i) {
    const Mask at = {i, i, i, i};
    for (int half = 0; half < 2; ++half) {
      Dot(data + 3 * kBlock * i + 4 * half, n, &dot);
      const Mask more = dot > best[half];
      best[half] = more ? dot : best[half];
      block[half] = more ? at : block[half];
    }
  }
  int index = 0;
  double value = -std::numeric_limits<double>::infinity();
  for (int half = 0; half < 2; ++half) {
    for (int k = 0; k < 4; ++k) {
      const int candidate = static_cast<int>(block[half][k]) * kBlock + 4 * half + k;
      if (best[half][k] > value || (best[half][k] == value && candidate < index)) {
        value = best[half][k];
        index = candidate;
      }
    }
  }
  return index;
}

CGUIDE_INLINE double GreatestLoop(const double* data, int blocks, const double* direction) {
  Lane n[3], best[2], dot;
  for (int k = 0; k < 3; ++k) Fill(direction[k], &n[k]);
  for (int half = 0; half < 2; ++half) Dot(data + 4 * half, n, &best[half]);
  for (int i = 1; i < blocks; ++i) {
    for (int half = 0; half < 2; ++half) {
      Dot(data + 3 * kBlock * i + 4 * half, n, &dot);
      best[half] = dot > best[half] ? dot : best[half];
    }
  }
  best[0] = best[1] > best[0] ? best[1] : best[0];
  return std::max({best[0][0], best[0][1], best[0][2], best[0][3]});
}

CGUIDE_INLINE double LeastFromLoop(const double* data, int blocks, Direction direction) {
  Lane n[3], origin[3], best[2], dot;
  for (int k = 0; k < 3; ++k) Fill(direction.n[k], &n[k]);
  for (int k = 0; k < 3; ++k) Fill(direction.origin[k], &origin[k]);
  for (int half = 0; half < 2; ++half) DotFrom(data + 4 * half, n, origin, &best[half]);
  for (int i = 1; i < blocks; ++i) {
    for (int half = 0; half < 2; ++half) {
      DotFrom(data + 3 * kBlock * i + 4 * half, n, origin, &dot);
      best[half] = dot < best[half] ? dot : best[half];
    }
  }
  best[0] = best[1] < best[0] ? best[1] : best[0];
  return std::min({best[0][0], best[0][1], best[0][2], best[0][3]});
}

CGUIDE_INLINE void CollectLoop(const double* data, int blocks, Direction direction, double limit,
                               std::vector<int>* indices) {
  Lane n[3], origin[3], most, dot[2];
  for (int k = 0; k < 3; ++k) Fill(direction.n[k], &n[k]);
  for (int k = 0; k < 3; ++k) Fill(direction.origin[k], &origin[k]);
  Fill(limit, &most);
  for (int i = 0; i < blocks; ++i) {
    for (int half = 0; half < 2; ++half) {
      DotFrom(data + 3 * kBlock * i + 4 * half, n, origin, &dot[half]);
    }
    const Mask beyond = (dot[0] > most) & (dot[1] > most);
    if ((beyond[0] & beyond[1] & beyond[2] & beyond[3]) != 0) continue;
    for (int k = 0; k < kBlock; ++k) {
      if (!(dot[k / 4][k % 4] > limit)) indices->push_back(kBlock * i + k);
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
