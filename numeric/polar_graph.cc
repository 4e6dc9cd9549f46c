#include <algorithm>
#include <numeric>

#include "cguide/numeric/polar_graph_internal.h"

namespace cguide::numeric {

void PolarGraph::Reset(int num_planes, int dimension) {
  words_ = std::max(1, (num_planes + 63) / 64);
  dimension_ = dimension;
  num_slots_ = 0;
  planes_.clear();
  alive_.clear();
  side_.clear();
  lists_.clear();
  pool_.clear();
  row_of_slot_.clear();
  for (auto& blocks : free_blocks_) blocks.clear();
  free_slots_.clear();
  sides_.outside.clear();
  sides_.on_plane.clear();
}

void PolarGraph::StartSimplex(std::span<const int> basis) {
  const int n = static_cast<int>(basis.size());
  for (int k = 0; k < n; ++k) {
    const int slot = NewSlot();
    for (int j = 0; j < n; ++j) {
      if (j != k) Insert(basis[j], slot);
    }
  }
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      if (j != k) Push(k, j);
    }
  }
}

int PolarGraph::NewSlot() {
  int slot = num_slots_;
  if (!free_slots_.empty()) {
    slot = free_slots_.back();
    free_slots_.pop_back();
    std::fill_n(planes_.begin() + static_cast<std::ptrdiff_t>(slot) * words_, words_, 0);
    lists_[slot].size = 0;
  } else {
    ++num_slots_;
    planes_.resize(static_cast<std::size_t>(num_slots_) * words_, 0);
    alive_.push_back(0);
    side_.push_back(Side::kInside);
    lists_.push_back({});
    row_of_slot_.push_back(-1);
  }
  alive_[slot] = 1;
  return slot;
}

void PolarGraph::Widen(int slot) {
  List& list = lists_[slot];
  const int log_capacity = list.capacity == 0 ? 3 : std::countr_zero(unsigned(list.capacity)) + 1;
  if (static_cast<int>(free_blocks_.size()) <= log_capacity) free_blocks_.resize(log_capacity + 1);
  std::int32_t begin = static_cast<std::int32_t>(pool_.size());
  if (auto& blocks = free_blocks_[log_capacity]; !blocks.empty()) {
    begin = blocks.back();
    blocks.pop_back();
  } else {
    pool_.resize(pool_.size() + (std::size_t{1} << log_capacity));
  }
  std::copy_n(pool_.begin() + list.begin, list.size, pool_.begin() + begin);
  if (list.capacity > 0) free_blocks_[log_capacity - 1].push_back(list.begin);
  list.begin = begin;
  list.capacity = 1 << log_capacity;
}

void PolarGraph::Release(int slot) {
  alive_[slot] = 0;
  side_[slot] = Side::kInside;
  free_slots_.push_back(slot);
}

void PolarGraph::BeginCut(int plane) {
  for (const int slot : sides_.outside) side_[slot] = Side::kOutside;
  for (const int slot : sides_.on_plane) {
    Insert(plane, slot);
    side_[slot] = Side::kOnPlane;
    // Edges to rays outside are lost; what replaces them is found by Connect.
  }
  num_old_rows_ = static_cast<int>(sides_.on_plane.size());
  for (const int slot : sides_.on_plane) {
    List& list = lists_[slot];
    std::int32_t* const first = Neighbours(slot);
    list.size = static_cast<std::int32_t>(
        std::remove_if(first, first + list.size,
                       [&](std::int32_t s) { return side_[s] == Side::kOutside; }) -
        first);
  }
}

// The new ray is adjacent to q; its neighbours on the plane follow in Connect. Rays strictly inside
// keep their adjacencies: the smallest face that holds two of them does not lie in the new plane,
// and cutting it keeps its dimension.
int PolarGraph::Bear(int plane, int p, int q) {
  const int slot = NewSlot();
  const std::uint64_t *a = planes_.data() + static_cast<std::size_t>(p) * words_,
                      *b = planes_.data() + static_cast<std::size_t>(q) * words_;
  std::uint64_t* const c = planes_.data() + static_cast<std::size_t>(slot) * words_;
  for (int w = 0; w < words_; ++w) c[w] = a[w] & b[w];
  Insert(plane, slot);
  side_[slot] = Side::kOnPlane;
  std::int32_t* const neighbours = Neighbours(q);
  *std::find(neighbours, neighbours + lists_[q].size, p) = slot;
  Push(slot, q);
  sides_.on_plane.push_back(slot);
  return slot;
}

void PolarGraph::EndCut(int plane) {
  Connect(plane);
  for (const int slot : sides_.on_plane) side_[slot] = Side::kInside;
  for (const int slot : sides_.outside) Release(slot);
}

void PolarGraph::FillColumns(int plane) {
  num_rows_ = static_cast<int>(sides_.on_plane.size());
  row_words_ = (num_rows_ + 63) / 64;
  columns_.assign(static_cast<std::size_t>(words_) * 64 * row_words_, 0);
  row_planes_.clear();
  row_begin_.clear();
  for (int row = 0; row < num_rows_; ++row) {
    const int slot = sides_.on_plane[row];
    row_of_slot_[slot] = row;
    row_begin_.push_back(static_cast<std::int32_t>(row_planes_.size()));
    const auto set = planes(slot);
    for (int w = 0; w < words_; ++w) {
      for (std::uint64_t bits = set[w]; bits != 0; bits &= bits - 1) {
        const int j = 64 * w + std::countr_zero(bits);
        if (j == plane) continue;  // of all rows: tells nothing
        row_planes_.push_back(j);
        columns_[static_cast<std::size_t>(j) * row_words_ + row / 64] |= std::uint64_t{1}
                                                                         << row % 64;
      }
    }
  }
  row_begin_.push_back(static_cast<std::int32_t>(row_planes_.size()));
}

// Two rays of the plane are adjacent iff no third ray lies in all planes they share [Fukuda, Prodon
// 1996, Prop. 7]; such a third ray would lie in the new plane too, so only those are asked.
//
// Mostly nothing need be asked. A ray in precisely dimension - 1 planes is "simple": it is extreme,
// so those are independent, and any dimension - 2 of them meet in a plane of dimension two. Another
// ray in these is adjacent to it.
void PolarGraph::Connect(int plane) {
  FillColumns(plane);
  known_.resize(row_words_);
  for (int row = 0; row < num_rows_; ++row) ConnectRow(row);
  for (const int slot : sides_.on_plane) row_of_slot_[slot] = -1;
}

// Rows that share `needed` planes with the row, the new one not counted, among the rows of a word.
// They are counted 64 at a time in unary: level k holds those found in at least k of its planes so
// far.
std::uint64_t PolarGraph::Sharing(int row, int word, int needed) const {
  std::uint64_t one = 0, two = 0, three = 0;
  for (std::int32_t k = row_begin_[row]; k < row_begin_[row + 1]; ++k) {
    const std::uint64_t column = Column(row_planes_[k])[word];
    three |= two & column;
    two |= one & column;
    one |= column;
  }
  return needed == 3 ? three : needed == 2 ? two : needed == 1 ? one : ~std::uint64_t{0};
}

bool PolarGraph::HaveNoThird(int row, int other) const {
  for (int word = 0; word < row_words_; ++word) {
    std::uint64_t held = RowsOf(word);
    for (std::int32_t k = row_begin_[row]; k < row_begin_[row + 1]; ++k) {
      const std::uint64_t* const column = Column(row_planes_[k]);
      if (column[other / 64] >> other % 64 & 1) held &= column[word];
    }
    if (word == row / 64) held &= ~(std::uint64_t{1} << row % 64);
    if (word == other / 64) held &= ~(std::uint64_t{1} << other % 64);
    if (held != 0) return false;
  }
  return true;
}

// Rows behind this one that are adjacent to it and are not known to be. Adjacent rays share planes
// of rank dimension - 2, so at least that many, the new one among them.
void PolarGraph::ConnectRow(int row) {
  const int slot = sides_.on_plane[row];
  const int needed = std::max(0, dimension_ - 3);
  const bool is_simple = IsSimple(row);
  if (row < num_old_rows_) {
    std::fill(known_.begin(), known_.end(), 0);
    for (int k = 0; k < lists_[slot].size; ++k) {
      const int r = row_of_slot_[Neighbours(slot)[k]];
      if (r >= 0) known_[r / 64] |= std::uint64_t{1} << r % 64;
    }
  } else if (row == num_old_rows_) {
    std::fill(known_.begin(), known_.end(), 0);
  }
  for (int word = row / 64; word < row_words_; ++word) {
    std::uint64_t candidates = Sharing(row, word, needed) & RowsOf(word) & ~known_[word];
    if (word == row / 64) candidates &= ~std::uint64_t{1} << row % 64;
    for (; candidates != 0; candidates &= candidates - 1) {
      const int other = 64 * word + std::countr_zero(candidates);
      if (!is_simple && !IsSimple(other) && !HaveNoThird(row, other)) continue;
      Push(slot, sides_.on_plane[other]);
      Push(sides_.on_plane[other], slot);
    }
  }
}

}  // namespace cguide::numeric
