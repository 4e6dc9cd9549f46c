#pragma once

#include <Eigen/Core>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace cguide::fuzz {

/** Reads structured values from a fuzzer's bytes; zeros once they are used up. Few bytes a value,
 so that mutations of bytes are mutations of meaning. */
class ByteStream {
 public:
  ByteStream(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  std::uint8_t Byte() { return at_ < size_ ? data_[at_++] : 0; }
  bool done() const { return at_ >= size_; }
  int Below(int n) { return Byte() % n; }

  /** k/8 between -2 and 2, or k/2^20 now and then. */
  double Grid() {
    const double k = static_cast<double>(Byte() % 33) - 16;
    return Byte() % 16 == 0 ? std::ldexp(k * 257 + Byte(), -20) : k / 8;
  }

  /** A grid value, sometimes a few ulps or 2^-20 to 2^-60 beside it. */
  double NearGrid() {
    double x = Grid();
    const int kind = Byte() % 8;
    if (kind == 0) {
      const int ulps = Byte() % 7 - 3;
      for (int i = 0; i < std::abs(ulps); ++i) x = std::nextafter(x, ulps < 0 ? -10 : 10);
    }
    if (kind == 1) x += std::ldexp(Byte() % 3 - 1, -20 - Byte() % 41);
    return x;
  }

  /** Any eight bytes as a double now and then, else NearGrid. */
  double Wild() {
    if (Byte() % 64 != 0) return NearGrid();
    std::uint64_t bits = 0;
    for (int i = 0; i < 8; ++i) bits = bits << 8 | Byte();
    return std::bit_cast<double>(bits);
  }

  Eigen::Vector3d Point() {
    const double x = NearGrid(), y = NearGrid(), z = NearGrid();
    return {x, y, z};
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

}  // namespace cguide::fuzz
