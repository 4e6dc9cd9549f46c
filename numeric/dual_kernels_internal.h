#pragma once

#include <cstddef>
#include <vector>

#include "cguide/numeric/friction.h"

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define CGUIDE_VECTOR_CLONES __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define CGUIDE_VECTOR_CLONES
#endif

namespace cguide::numeric {

/** Rays in a structure of arrays: coordinate k of ray s is data[k * capacity + s]. Empty slots hold
 zeros. */
class RayTable {
 public:
  void Reset() { size_ = 0; }
  int size() const { return size_; }
  /** Makes room for slots below n. */
  void Grow(int n);
  void Set(int slot, const Vector6d& y) {
    for (int k = 0; k < 6; ++k) data_[static_cast<std::size_t>(k) * capacity_ + slot] = y[k];
  }
  Vector6d Get(int slot) const {
    Vector6d y;
    for (int k = 0; k < 6; ++k) y[k] = data_[static_cast<std::size_t>(k) * capacity_ + slot];
    return y;
  }
  /** values()[s] = y_s . a for all slots s; the slots that are not below -threshold, into `list`
   (room for size()), ascending; their number. Each value is ((y0 a0 + y1 a1) + (y2 a2 + y3 a3)) +
   (y4 a4 + y5 a5), every operation rounded once. */
  int Multiply(const Vector6d& a, double threshold);
  const std::vector<double>& values() const { return values_; }
  double value(int slot) const { return values_[slot]; }
  void SetValue(int slot, double v) { values_[slot] = v; }
  const int* list() const { return list_.data(); }

 private:
  int size_ = 0;
  std::size_t capacity_ = 0;
  std::vector<double> data_, values_;
  std::vector<int> list_;
};

}  // namespace cguide::numeric
