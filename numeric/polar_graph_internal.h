#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace cguide::numeric {

/** The combinatorial half of the double description method: which planes hold each extreme ray of
 the polar cone { y : y.a_i <= 0 for the half-spaces added so far } (pointed), and which rays are
 adjacent, that is, span a face of dimension two. Numbers are the caller's: it says on which side of
 the next plane every ray lies, and makes the coordinates of new rays. If all sides are right, so
 are the rays and their planes: nothing here is rounded.

 Rays live in slots, which are reused; nothing moves. All storage is kept by Reset. */
class PolarGraph {
 public:
  /** No ray; planes 0 .. num_planes - 1; `dimension` of the space. */
  void Reset(int num_planes, int dimension);

  /** The cone of the half-spaces of `basis`, whose normals are `dimension` independent ones: slot k
   is the ray in all of their planes but basis[k]. */
  void StartSimplex(std::span<const int> basis);

  /** All slots are below this; some are empty. */
  int num_slots() const { return num_slots_; }
  bool alive(int slot) const { return alive_[slot] != 0; }
  int num_words() const { return words_; }
  std::span<const std::uint64_t> planes(int slot) const {
    return {planes_.data() + static_cast<std::size_t>(slot) * words_,
            static_cast<std::size_t>(words_)};
  }
  bool Holds(int plane, int slot) const { return planes(slot)[plane / 64] >> (plane % 64) & 1; }

  /** Sides of the next plane: the lists below, filled by the caller; every other ray is strictly
   inside. `outside` in `is_outside` too. */
  struct Sides {
    std::vector<int> outside, on_plane;
  };
  Sides* sides() { return &sides_; }

  /** Adds a half-space. `born(slot, p, q)` is called for every new ray, which lies on the face of
   p (outside) and q (inside). Afterwards rays outside are gone; the planes of their slots can be
   read until the next Cut. */
  template <typename Born>
  void Cut(int plane, const Born& born);

 private:
  struct List {
    std::int32_t begin = 0, size = 0, capacity = 0;  // capacity: none or a power of two from 8 on
  };
  enum class Side : std::int8_t { kInside, kOnPlane, kOutside };

  int NewSlot();
  void Insert(int plane, int slot) {
    planes_[static_cast<std::size_t>(slot) * words_ + plane / 64] |= std::uint64_t{1} << plane % 64;
  }
  std::int32_t* Neighbours(int slot) { return pool_.data() + lists_[slot].begin; }
  void Push(int slot, int neighbour) {
    List& list = lists_[slot];
    if (list.size == list.capacity) Widen(slot);
    pool_[static_cast<std::size_t>(list.begin) + list.size++] = neighbour;
  }
  void Widen(int slot);
  void Release(int slot);
  int Bear(int plane, int p, int q);
  void BeginCut(int plane);
  void EndCut(int plane);
  void Connect(int plane);
  void FillColumns(int plane);
  void ConnectRow(int row);
  std::uint64_t Sharing(int row, int word, int needed) const;
  bool HaveNoThird(int row, int other) const;
  bool IsSimple(int row) const { return row_begin_[row + 1] - row_begin_[row] == dimension_ - 2; }
  const std::uint64_t* Column(int plane) const {
    return columns_.data() + static_cast<std::size_t>(plane) * row_words_;
  }
  /** The bits of a word that stand for rows. */
  std::uint64_t RowsOf(int word) const {
    const int rows = num_rows_ - 64 * word;
    return rows >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << rows) - 1;
  }

  int words_ = 0, dimension_ = 0, num_slots_ = 0;
  std::vector<std::uint64_t> planes_;
  std::vector<std::uint8_t> alive_;
  std::vector<Side> side_;
  std::vector<List> lists_;
  std::vector<std::int32_t> pool_;
  std::vector<std::vector<std::int32_t>> free_blocks_;  // by logarithm of the capacity
  std::vector<int> free_slots_;
  Sides sides_;

  // Of the rays on the plane being added ("rows"): planes of each, and per plane its rows as bits.
  int num_rows_ = 0, num_old_rows_ = 0, row_words_ = 0;
  std::vector<std::int32_t> row_planes_, row_begin_, row_of_slot_;
  std::vector<std::uint64_t> columns_, known_;
};

template <typename Born>
void PolarGraph::Cut(int plane, const Born& born) {
  if (sides_.outside.empty()) {
    for (const int slot : sides_.on_plane) Insert(plane, slot);
    return;
  }
  BeginCut(plane);
  for (const int p : sides_.outside) {
    const int degree = lists_[p].size;
    for (int k = 0; k < degree; ++k) {
      const int q = Neighbours(p)[k];
      if (side_[q] == Side::kInside) born(Bear(plane, p, q), p, q);
    }
  }
  EndCut(plane);
}

}  // namespace cguide::numeric
