#include <algorithm>

#include "cguide/numeric/dual_kernels_internal.h"
#include "cguide/numeric/fp_guard.h"

namespace cguide::numeric {
namespace {

constexpr int kBlock = 16;  // slots whose largest value is asked before any of them is looked at

// count is a multiple of kBlock; largest[b] is of block b.
CGUIDE_VECTOR_CLONES void MultiplyBlocks(const double* data, std::size_t capacity, int count,
                                         const double* a, double* values, double* largest) {
  const double *y0 = data, *y1 = y0 + capacity, *y2 = y1 + capacity, *y3 = y2 + capacity,
               *y4 = y3 + capacity, *y5 = y4 + capacity;
  const double a0 = a[0], a1 = a[1], a2 = a[2], a3 = a[3], a4 = a[4], a5 = a[5];
  for (int begin = 0; begin < count; begin += kBlock) {
    double v[kBlock];
    for (int i = 0; i < kBlock; ++i) {
      const int s = begin + i;
      v[i] = ((y0[s] * a0 + y1[s] * a1) + (y2[s] * a2 + y3[s] * a3)) + (y4[s] * a4 + y5[s] * a5);
    }
    for (int i = 0; i < kBlock; ++i) values[begin + i] = v[i];
    for (int half = kBlock / 2; half > 0; half /= 2) {
      for (int i = 0; i < half; ++i) v[i] = v[i] > v[i + half] ? v[i] : v[i + half];
    }
    largest[begin / kBlock] = v[0];
  }
}

}  // namespace

void RayTable::Grow(int n) {
  if (n <= size_) return;
  if (static_cast<std::size_t>(n) > capacity_) {
    const std::size_t capacity = std::max<std::size_t>(
        256, (static_cast<std::size_t>(2) * n + kBlock - 1) / kBlock * kBlock);
    std::vector<double> data(6 * capacity, 0.0);
    for (std::size_t k = 0; k < 6; ++k) {
      std::copy_n(data_.begin() + static_cast<std::ptrdiff_t>(k * capacity_), size_,
                  data.begin() + static_cast<std::ptrdiff_t>(k * capacity));
    }
    data_ = std::move(data);
    capacity_ = capacity;
    values_.resize(capacity + capacity / kBlock);
    list_.resize(capacity);
  }
  for (std::size_t k = 0; k < 6; ++k) {
    std::fill(data_.begin() + static_cast<std::ptrdiff_t>(k * capacity_) + size_,
              data_.begin() + static_cast<std::ptrdiff_t>(k * capacity_) + n, 0.0);
  }
  size_ = n;
}

int RayTable::Multiply(const Vector6d& a, double threshold) {
  const int blocks = (size_ + kBlock - 1) / kBlock;
  double* const largest = values_.data() + capacity_;
  MultiplyBlocks(data_.data(), capacity_, blocks * kBlock, a.data(), values_.data(), largest);
  int found = 0;
  for (int b = 0; b < blocks; ++b) {
    if (largest[b] < -threshold) continue;
    const int end = std::min(size_, (b + 1) * kBlock);
    for (int s = b * kBlock; s < end; ++s) {
      list_[found] = s;
      found += values_[s] >= -threshold;
    }
  }
  return found;
}

}  // namespace cguide::numeric
