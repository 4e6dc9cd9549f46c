#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "cguide/exact/triangle_distance.h"

namespace cguide::numeric {

/** A union of closed triangles whose corners are doubles, with a tree of boxes over it. Immutable;
 copies share the data. Degenerate triangles are segments or points. */
class TriangleTree {
 public:
  /** @throws Error where there is no triangle, an index is out of range or a used coordinate is
   not finite. */
  TriangleTree(const std::vector<Eigen::Vector3d>& vertices,
               const std::vector<std::array<int, 3>>& triangles);

  /** The triangles this tree was made of, placed by x -> R x + p over Q, as exact::MakeTriangleSet
   does (the errors of X are not looked at; R need not be rigid). Keeps the tree: linear in the
   number of triangles, in doubles; exact corners are computed where they are needed. */
  TriangleTree Placed(const exact::LinkPlacement& X) const;

  struct Data;
  const Data& data() const { return *data_; }

 private:
  explicit TriangleTree(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

  std::shared_ptr<const Data> data_;
};

/** The distance of two sets with a closest pair, and what it cost. */
struct TriangleTreeDistance : exact::TriangleDistance {
  long pairs = 0;       ///< of triangles bounded in doubles
  long candidates = 0;  ///< of those, pairs that doubles could not tell from the closest
  long features = 0;    ///< different feature pairs among these, decided in integers
};

/** Squared distance of two triangle sets, decided over Q: equal to exact::SquaredTriangleDistance
 (only the triangles count; of several closest pairs one is returned).

 The boxes of both trees and bounds of the triangles' distances in doubles leave the pairs that can
 be the closest. These mostly attain their distance at the same vertex and face, or the same two
 edges, seen from neighbouring triangles: each such pair of features is evaluated once.
 @throws Error where the thread does not round to nearest. */
TriangleTreeDistance SquaredTriangleDistance(const TriangleTree& a, const TriangleTree& b);

/** The same between the hull of a non-empty set of points (a single one included) and triangles.
 @throws Error where the set is empty or not finite. */
TriangleTreeDistance SquaredTriangleDistance(std::span<const Eigen::Vector3d> hull,
                                             const TriangleTree& b);

}  // namespace cguide::numeric
