#include "cguide/numeric/triangle_distance.h"

#include <algorithm>
#include <map>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/convex_distance_internal.h"
#include "cguide/numeric/fp_guard.h"
#include "cguide/numeric/triangle_tree_internal.h"

namespace cguide::numeric {

using Eigen::Vector3d;

namespace {

// Bounds the squared gap of two boxes from below: each difference, square and sum is within u, in
// all below 8 u; what underflows is below 2^-1000.
bool Farther(const MeshNode& a, const MeshNode& b, double limit) {
  const Vector3d gap = (a.lower - b.upper).cwiseMax(b.lower - a.upper).cwiseMax(0.0);
  return gap.squaredNorm() > limit * limit * (1 + 32 * kUnit) + 0x1p-1000;
}

double SquaredGap(const MeshNode& a, const MeshNode& b) {
  return (a.lower - b.upper).cwiseMax(b.lower - a.upper).cwiseMax(0.0).squaredNorm();
}

// One side of the search: a tree, or a hull that is one item in one box.
struct Side {
  const TriangleTree::Data* tree = nullptr;
  PointSet hull;
  MeshNode hull_box;

  const MeshNode& node(int k) const { return tree ? tree->nodes[k] : hull_box; }
  const MeshNode& box(int item) const { return tree ? tree->boxes[item] : hull_box; }
  PointSet item(int k) const { return tree ? PointSet{tree->corners[k], nullptr} : hull; }
  double error() const { return tree ? tree->error : 0; }
  Vector3q ExactPoint(int item, int index) const {
    return tree ? tree->ExactCorner(item, index) : Lift(hull.points[index]);
  }
};

// A set of few points for the filter, which wants lanes.
struct Item {
  PointSet set;
  PointLanes lanes;

  explicit Item(const PointSet& from) : set(from) {
    if (set.lanes) return;
    lanes = PointLanes(set.points);
    set.lanes = &lanes;
  }
};

struct Candidate {
  int a = 0;
  int b = 0;
  double lo = 0;
  Simplex simplex;
};

class Search {
 public:
  // Corners are off by sqrt 3 times the error of their coordinates, and distances by their sum.
  Search(const Side& a, const Side& b) : a_(a), b_(b), slack_(2 * (a.error() + b.error())) {}

  TriangleTreeDistance Run() {
    Walk();
    Settle();
    return std::move(result_);
  }

 private:
  void Walk();
  void VisitLeaves(const MeshNode& a, const MeshNode& b);
  void VisitItems(int a, int b);
  void Settle();
  Simplex Decide(const Candidate& candidate) const;
  Rational Squared(const Candidate& candidate, const Simplex& simplex) const;
  std::vector<int> FeatureOf(const Candidate& candidate, const Simplex& simplex) const;
  void Accept(const Candidate& candidate, const Simplex& simplex, const Rational& squared);

  const Side& a_;
  const Side& b_;
  double slack_;
  double upper_ = INFINITY;  // The distance is at most this.
  bool meet_ = false;
  std::vector<Candidate> candidates_;
  TriangleTreeDistance result_;
};

// Depth first, the nearer pair of boxes first.
void Search::Walk() {
  std::vector<std::pair<int, int>> stack{{0, 0}};
  while (!stack.empty() && !meet_) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    const MeshNode &a = a_.node(i), &b = b_.node(j);
    if (Farther(a, b, upper_ + slack_)) continue;
    if (a.count > 0 && b.count > 0) {
      VisitLeaves(a, b);
      continue;
    }
    const bool split_a = b.count > 0 || (a.count == 0 && (a.upper - a.lower).squaredNorm() >
                                                             (b.upper - b.lower).squaredNorm());
    std::pair<int, int> near{split_a ? a.first : i, split_a ? j : b.first};
    std::pair<int, int> far{split_a ? a.first + 1 : i, split_a ? j : b.first + 1};
    if (SquaredGap(a_.node(far.first), b_.node(far.second)) <
        SquaredGap(a_.node(near.first), b_.node(near.second))) {
      std::swap(near, far);
    }
    stack.push_back(far);
    stack.push_back(near);
  }
}

void Search::VisitLeaves(const MeshNode& a, const MeshNode& b) {
  for (int i = a.first; i < a.first + a.count; ++i) {
    if (Farther(a_.box(i), b, upper_ + slack_)) continue;
    for (int j = b.first; j < b.first + b.count; ++j) {
      if (meet_) return;
      if (!Farther(a_.box(i), b_.box(j), upper_ + slack_)) VisitItems(i, j);
    }
  }
}

void Search::VisitItems(int a, int b) {
  ++result_.pairs;
  GjkResult gjk;
  const DistanceBounds bounds = BoundSets(a_.item(a), b_.item(b), upper_ + slack_, &gjk);
  if (bounds.lo > upper_ + slack_) return;
  upper_ = std::min(upper_, bounds.hi + slack_);
  candidates_.push_back({a, b, bounds.lo - slack_, SimplexOf(gjk)});
  if (!gjk.overlap) return;
  // Where sets meet all over, the first proof ends the search.
  const Simplex simplex = Decide(candidates_.back());
  if (Squared(candidates_.back(), simplex) != 0) return;
  meet_ = true;
  Accept(candidates_.back(), simplex, 0);
}

// A pair of items for signs, in doubles or over Q.
class ItemPair : public RationalPoints {
 public:
  ItemPair(const Side& side_a, const Side& side_b, const Candidate& candidate)
      : side_a_(side_a),
        side_b_(side_b),
        candidate_(candidate),
        a_(side_a.item(candidate.a)),
        b_(side_b.item(candidate.b)) {
    hulls.a = a_.set;
    hulls.b = b_.set;
    const double error = std::max(side_a.error(), side_b.error());
    if (error == 0) return;
    hulls.rational = this;
    // A rounded difference of points off by `error` is within u |d| + 2 error (1 + u) of the real
    // one, and that below u (|d| + blur).
    hulls.blur = 3 * error / kUnit;
  }
  ItemPair(const ItemPair&) = delete;
  ItemPair& operator=(const ItemPair&) = delete;

  Vector3q Get(bool of_b, int index) const override {
    return of_b ? side_b_.ExactPoint(candidate_.b, index) : side_a_.ExactPoint(candidate_.a, index);
  }

  HullPair hulls;

 private:
  const Side& side_a_;
  const Side& side_b_;
  const Candidate& candidate_;
  Item a_, b_;
};

Simplex Search::Decide(const Candidate& candidate) const {
  ItemPair pair(a_, b_, candidate);
  return DecideSimplex(&pair.hulls, candidate.simplex);
}

Rational Search::Squared(const Candidate& candidate, const Simplex& simplex) const {
  return SquaredDistance(ItemPair(a_, b_, candidate).hulls, simplex);
}

// What the simplex is made of, as points of the two sets: how many of A, those, those of B.
std::vector<int> Search::FeatureOf(const Candidate& candidate, const Simplex& simplex) const {
  std::vector<int> of_a, of_b;
  for (int k = 0; k < simplex.size; ++k) {
    const auto& [i, j] = simplex.corners[k];
    of_a.push_back(a_.tree ? a_.tree->vertex_ids[candidate.a][i] : i);
    of_b.push_back(b_.tree ? b_.tree->vertex_ids[candidate.b][j] : j);
  }
  for (std::vector<int>* ids : {&of_a, &of_b}) {
    std::sort(ids->begin(), ids->end());
    ids->erase(std::unique(ids->begin(), ids->end()), ids->end());
  }
  of_a.insert(of_a.begin(), static_cast<int>(of_a.size()));
  of_a.insert(of_a.end(), of_b.begin(), of_b.end());
  return of_a;
}

void Search::Accept(const Candidate& candidate, const Simplex& simplex, const Rational& squared) {
  std::vector<Vector3q> a, b;
  HullDistance distance;
  distance.size = simplex.size;
  for (int k = 0; k < simplex.size; ++k) {
    a.push_back(a_.ExactPoint(candidate.a, simplex.corners[k].i));
    b.push_back(b_.ExactPoint(candidate.b, simplex.corners[k].j));
    distance.corners[k] = {k, k};
  }
  exact::ConvexDistance closest = ClosestPoints(a, b, distance);
  result_.squared = squared;
  result_.a = std::move(closest.a);
  result_.b = std::move(closest.b);
  result_.index_a = a_.tree ? a_.tree->index[candidate.a] : -1;
  result_.index_b = b_.tree ? b_.tree->index[candidate.b] : -1;
}

// The distance of two items is that of the hulls of the features that attain it: where two pairs
// have the same features, they have the same distance.
void Search::Settle() {
  if (meet_) return;
  std::map<std::vector<int>, bool> seen;
  const Candidate* best = nullptr;
  Simplex best_simplex;
  Rational least;
  for (const Candidate& candidate : candidates_) {
    if (candidate.lo > upper_) continue;
    ++result_.candidates;
    const Simplex simplex = Decide(candidate);
    if (!seen.try_emplace(FeatureOf(candidate, simplex), true).second) continue;
    ++result_.features;
    const Rational squared = Squared(candidate, simplex);
    if (best && squared >= least) continue;
    best = &candidate;
    best_simplex = simplex;
    least = squared;
  }
  Accept(*best, best_simplex, least);
}

Side SideOf(const TriangleTree& tree) {
  Side side;
  side.tree = &tree.data();
  return side;
}

exact::TriangleSet ExactSet(const TriangleTree& tree) {
  exact::TriangleSet set;
  const TriangleTree::Data& data = tree.data();
  set.triangles.resize(data.corners.size());
  set.bounds.resize(data.corners.size());
  for (std::size_t k = 0; k < data.corners.size(); ++k) {
    const int index = data.index[k], triangle = static_cast<int>(k);
    for (int c = 0; c < 3; ++c) set.triangles[index][c] = data.ExactCorner(triangle, c);
    set.bounds[index] = exact::BoundsOf(set.triangles[index]);
  }
  return set;
}

}  // namespace

TriangleTreeDistance SquaredTriangleDistance(const TriangleTree& a, const TriangleTree& b) {
  RequireRoundToNearest();
  if (a.data().largest > kLargest || b.data().largest > kLargest) {
    return {exact::SquaredTriangleDistance(ExactSet(a), ExactSet(b))};
  }
  const Side side_a = SideOf(a), side_b = SideOf(b);
  return Search(side_a, side_b).Run();
}

TriangleTreeDistance SquaredTriangleDistance(std::span<const Vector3d> hull,
                                             const TriangleTree& b) {
  RequireRoundToNearest();
  Require(!hull.empty(), "an empty set has no distance");
  const PointLanes lanes(hull);
  Require(lanes.is_finite(), "a coordinate is not finite");
  const double largest =
      std::max(lanes.lower().cwiseAbs().maxCoeff(), lanes.upper().cwiseAbs().maxCoeff());
  if (largest > kLargest || b.data().largest > kLargest) {
    std::vector<Vector3q> points;
    for (const Vector3d& p : hull) points.push_back(Lift(p));
    return {exact::SquaredTriangleDistance(points, ExactSet(b))};
  }
  Side side;
  side.hull = {hull, &lanes};
  side.hull_box = {lanes.lower(), lanes.upper(), 0, 1};
  const Side side_b = SideOf(b);
  return Search(side, side_b).Run();
}

}  // namespace cguide::numeric
