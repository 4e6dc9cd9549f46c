#include "cguide/numeric/wrench_cone.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "cguide/exact/core/error.h"
#include "cguide/exact/wrench.h"
#include "cguide/numeric/lanes_internal.h"

namespace cguide::numeric {
namespace {

constexpr std::uint64_t kMagnitude = ~std::uint64_t{0} >> 1;

/** The magnitude of x as an integer that orders like it. */
std::uint64_t Bits(double x) { return std::bit_cast<std::uint64_t>(x) & kMagnitude; }

/** Products of numbers outside 2^-900 .. 2^900 overflow or lose digits: exact arithmetic's
 * business. */
bool IsOrdinary(std::uint64_t bits) {
  const int field = static_cast<int>(bits >> 52);
  return field > 123 && field < 1923;
}

/** 2^(1022 - field), which brings the number into [1/2, 1); a normal double for ordinary ones. */
double ScaleOf(std::uint64_t bits) {
  return std::bit_cast<double>((std::uint64_t{2045} - (bits >> 52)) << 52);
}

// A component of p x u takes two products and a difference: its error is at most 2.01 u (|a| + |b|)
// with the two products a, b. Scaled by s with s |u|_inf < 1 it is at most 2.01 u s (|a| + |b|)
// <= 4.1 u |p|_inf. Products that underflow add 2^-1074 before scaling, below 2^-100 of an ordinary
// column.
double MomentError(double reach) { return 4.5 * 0x1p-53 * reach + 0x1p-100; }

/** Six rows of eight columns. */
template <typename V>
struct Block {
  V row[6];
};

/** What a pass over the columns finds; zero columns count for nothing. */
template <typename V>
struct Pass {
  V far = {};                ///< largest |p|
  V largest = Lanes<V>(1);   ///< of all entries, and
  V smallest = Lanes<V>(1);  ///< of the columns' largest ones
  V sum = {};                ///< NaN where an entry is
};

/** 2^(1022 - exponent field): a normal double for ordinary numbers. */
template <typename V>
CGUIDE_INLINE V ScaleOf(const V& x) {
  using Bits = typename V::Bits;
  using Part = typename V::Part;
  V scale;
  scale.part[0] = (Part)((2045 - ((Bits)x.part[0] >> 52)) << 52);  // NOLINT: lanes' bits
  if constexpr (kParts<V> == 2) {
    scale.part[1] = (Part)((2045 - ((Bits)x.part[1] >> 52)) << 52);  // NOLINT
  }
  return scale;
}

/** Scales the columns of a block to a largest entry in [1/2, 1) and stores them, their scales, and
 1 where a column is zero. Columns that are not ordinary get scales without meaning. */
template <typename V>
CGUIDE_INLINE void ScaleBlock(const Block<V>& block, double* e, std::size_t stride, Pass<V>* pass) {
  const V zero = {}, one = Lanes<V>(1);
  V largest = {};
  for (int i = 0; i < 6; ++i) {
    const V x = Absolute(block.row[i]);
    largest = Larger(x, largest);
    pass->sum += x;
  }
  pass->largest = Larger(largest, pass->largest);
  const V size = IfGreater(largest, zero, largest, one);
  pass->smallest = IfGreater(pass->smallest, size, size, pass->smallest);
  const V scale = ScaleOf(size);
  for (int i = 0; i < 6; ++i) Store(block.row[i] * scale, e + i * stride);
  Store(scale, e + 6 * stride);
  Store(IfGreater(largest, zero, zero, one), e + 7 * stride);
}

/** Whether all columns are ordinary or zero: no NaN, the largest entries within 2^-900 .. 2^900. */
template <typename V>
CGUIDE_INLINE bool AllOrdinary(const Pass<V>& pass) {
  const double sum = Sum(pass.sum);
  return sum == sum && Largest(pass.largest) <= 0x1p900 && -Largest(-pass.smallest) >= 0x1p-900;
}

/** Six consecutive doubles each of eight columns. */
template <typename V>
CGUIDE_INLINE void GatherColumns(const double* data, V (&row)[6]) {
  for (std::size_t i = 0; i < 6; i += 2) {
    Duo pair[8];
    for (std::size_t l = 0; l < 8; ++l) __builtin_memcpy(&pair[l], data + 6 * l + i, sizeof(Duo));
    Unzip(pair, &row[i], &row[i + 1]);
  }
}

static_assert(sizeof(AppliedForce) == 6 * sizeof(double), "p and u lie side by side");

template <typename V>
CGUIDE_INLINE void FillBlockFromForces(const double* forces, double* e, std::size_t stride,
                                       Pass<V>* pass) {
  V data[6];
  GatherColumns(forces, data);
  V *P = data, *U = data + 3;
  const Block<V> block{{U[0], U[1], U[2], P[1] * U[2] - P[2] * U[1], P[2] * U[0] - P[0] * U[2],
                        P[0] * U[1] - P[1] * U[0]}};
  for (int i = 0; i < 3; ++i) {
    pass->far = Larger(Absolute(P[i]), pass->far);
  }
  ScaleBlock(block, e, stride, pass);
}

template <typename V>
CGUIDE_INLINE void FillBlockFromWrenches(const double* wrenches, double* e, std::size_t stride,
                                         Pass<V>* pass) {
  Block<V> block;
  GatherColumns(wrenches, block.row);
  ScaleBlock(block, e, stride, pass);
}

/** The columns left over by whole blocks, followed by zeros. */
struct Tail {
  double data[48] = {};
  Tail(const double* first, std::size_t count) { std::copy_n(first, 6 * count, data); }
};

/** The scaled wrenches (u, p x u) of the forces. @return AllOrdinary, and in `reach` the largest
 * |p|_inf. */
template <typename V>
CGUIDE_INLINE bool ForcesKernel(const double* __restrict forces, std::size_t size,
                                double* __restrict e, std::size_t stride,
                                double* __restrict reach) {
  Pass<V> pass;
  const std::size_t whole = size / 8 * 8;
  for (std::size_t j = 0; j < whole; j += 8) {
    FillBlockFromForces(forces + 6 * j, e + j, stride, &pass);
  }
  if (whole < size) {
    const Tail tail(forces + 6 * whole, size - whole);
    FillBlockFromForces(tail.data, e + whole, stride, &pass);
  }
  *reach = Largest(pass.far);
  return AllOrdinary(pass);
}

template <typename V>
CGUIDE_INLINE bool WrenchesKernel(const double* __restrict wrenches, std::size_t size,
                                  double* __restrict e, std::size_t stride) {
  Pass<V> pass;
  const std::size_t whole = size / 8 * 8;
  for (std::size_t j = 0; j < whole; j += 8) {
    FillBlockFromWrenches(wrenches + 6 * j, e + j, stride, &pass);
  }
  if (whole < size) {
    const Tail tail(wrenches + 6 * whole, size - whole);
    FillBlockFromWrenches(tail.data, e + whole, stride, &pass);
  }
  return AllOrdinary(pass);
}

CGUIDE_DISPATCH(bool, FillFromForces, ForcesKernel,
                (const double* forces, std::size_t size, double* e, std::size_t stride,
                 double* reach),
                (forces, size, e, stride, reach))
CGUIDE_DISPATCH(bool, FillFromWrenches, WrenchesKernel,
                (const double* wrenches, std::size_t size, double* e, std::size_t stride),
                (wrenches, size, e, stride))

}  // namespace

WrenchCone WrenchCone::OfForces(std::span<const AppliedForce> forces) {
  WrenchCone cone;
  cone.AssignForces(forces);
  return cone;
}

WrenchCone WrenchCone::OfWrenches(std::span<const Vector6d> wrenches) {
  WrenchCone cone;
  cone.AssignWrenches(wrenches);
  return cone;
}

// Rows are a register apart from a whole number of them, so that they do not compete for the same
// lines of the cache.
void WrenchCone::Resize(int size) {
  size_ = size;
  padded_ = (size + kPad - 1) / kPad * kPad;
  stride_ = static_cast<std::size_t>(padded_) + kPad;
  entries_.resize(8 * stride_);
  is_finite_ = in_range_ = true;
  force_error_ = moment_error_ = 0;
}

void WrenchCone::AssignForces(std::span<const AppliedForce> forces) {
  Resize(static_cast<int>(forces.size()));
  const auto* data = reinterpret_cast<const double*>(forces.data());
  forces_.resize(forces.size());
  std::copy_n(data, 6 * forces.size(), reinterpret_cast<double*>(forces_.data()));
  wrenches_.clear();
  double reach = 0;
  const bool ordinary = FillFromForces(data, forces.size(), entries_.data(), stride_, &reach);
  moment_error_ = MomentError(reach);
  if (!ordinary) LookAtOddColumns();
}

void WrenchCone::AssignWrenches(std::span<const Vector6d> wrenches) {
  Resize(static_cast<int>(wrenches.size()));
  wrenches_.assign(wrenches.begin(), wrenches.end());
  forces_.clear();
  const bool ordinary = FillFromWrenches(reinterpret_cast<const double*>(wrenches.data()),
                                         wrenches.size(), entries_.data(), stride_);
  if (!ordinary) LookAtOddColumns();
}

// Where a column is not ordinary, zero generators excepted, floats decline, and it is asked whether
// the data are finite.
void WrenchCone::LookAtOddColumns() {
  for (int j = 0; j < size_; ++j) {
    const bool finite = forces_.empty() ? wrenches_[j].allFinite()
                                        : forces_[j].p.allFinite() && forces_[j].u.allFinite();
    const bool zero = forces_.empty() ? wrenches_[j].isZero(0) : forces_[j].u.isZero(0);
    is_finite_ = is_finite_ && finite;
    const Vector6d a = column(j);
    const double largest = a.lpNorm<Eigen::Infinity>();
    if (!zero && !(a.allFinite() && largest >= 0.5 && largest < 1)) in_range_ = false;
  }
  if (!is_finite_) in_range_ = false;
}

VectorXq WrenchCone::Exact(int j) const {
  Require(j >= 0 && j < size_, "no such generator");
  if (!forces_.empty()) return exact::WrenchOf(forces_[j]);
  VectorXq wrench(6);
  for (int i = 0; i < 6; ++i) wrench[i] = Lift(wrenches_[j][i]);
  return wrench;
}

std::vector<VectorXq> WrenchCone::ExactColumns() const {
  std::vector<VectorXq> columns;
  for (int j = 0; j < size_; ++j) columns.push_back(Exact(j));
  return columns;
}

WrenchCone::Vector6d WrenchCone::column(int j) const {
  Vector6d a;
  for (int i = 0; i < 6; ++i) a[i] = row(i)[j];
  return a;
}

WrenchDemand::WrenchDemand(const AppliedForce& force) : is_force_(true), force_(force) {
  const Eigen::Vector3d &p = force.p, &u = force.u;
  scaled_ << u[0], u[1], u[2], p[1] * u[2] - p[2] * u[1], p[2] * u[0] - p[0] * u[2],
      p[0] * u[1] - p[1] * u[0];
  is_finite_ = p.allFinite() && u.allFinite();
  moment_error_ = MomentError(p.lpNorm<Eigen::Infinity>());
  Scale();
}

WrenchDemand::WrenchDemand(const Vector6d& wrench) : scaled_(wrench), wrench_(wrench) {
  is_finite_ = wrench.allFinite();
  Scale();
}

void WrenchDemand::Scale() {
  std::uint64_t bits = 0;
  for (const double x : scaled_) bits = std::max(bits, Bits(x));
  if (!IsOrdinary(bits)) {
    in_range_ = bits == 0 && (!is_force_ || force_.u.isZero(0));
    return;
  }
  scaled_ *= ScaleOf(bits);
  exponent_ = static_cast<int>(bits >> 52) - 1022;
}

VectorXq WrenchDemand::Exact() const {
  if (is_force_) return exact::WrenchOf(force_);
  VectorXq wrench(6);
  for (int i = 0; i < 6; ++i) wrench[i] = Lift(wrench_[i]);
  return wrench;
}

}  // namespace cguide::numeric
