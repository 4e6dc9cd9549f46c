#include "cguide/verify/edge_collision.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "cguide/exact/core/error.h"
#include "cguide/verify/edge_collision_internal.h"

namespace cguide::verify {

using collision_internal::Item;
using numeric::Geometry;
using numeric::World;

namespace {

std::vector<Item> AllItems(const Geometry& g, const numeric::PieceTree& tree) {
  std::vector<Item> items;
  for (int s = 0; s < static_cast<int>(g.shapes.size()); ++s) {
    if (!tree.nodes().empty()) items.push_back({s, -1, false, 0});
    for (const int p : tree.halfspaces()) items.push_back({s, p, false});
  }
  for (const auto& [i, j] : g.self_pairs) {
    for (int s = g.body_begin[i]; s < g.body_begin[i + 1]; ++s) {
      for (int t = g.body_begin[j]; t < g.body_begin[j + 1]; ++t) items.push_back({s, t, true});
    }
  }
  return items;
}

}  // namespace

EdgeWorkspace::Scratch::Scratch(const World& world)
    : point(world),
      all(AllItems(world.geometry(), world.geometry().piece_tree)),
      numbers(CertificateShapes(world)) {}

EdgeWorkspace::EdgeWorkspace(const World& world) : scratch(std::make_unique<Scratch>(world)) {}
EdgeWorkspace::~EdgeWorkspace() = default;
EdgeWorkspace::EdgeWorkspace(EdgeWorkspace&&) noexcept = default;
EdgeWorkspace& EdgeWorkspace::operator=(EdgeWorkspace&&) noexcept = default;

namespace collision_internal {

using Eigen::Vector3d;
using numeric::Convex;
using numeric::ObstaclePiece;
using numeric::Pair;
using numeric::PieceKind;

Pair CollisionDecider::PairOf(const Item& item) const {
  const int other = item.self ? g_.shapes[item.other].body : g_.pieces[item.other].object;
  return {g_.shapes[item.shape].body, other, item.self};
}

namespace {

/** A moving shape at one s as a placed set: its remainders, which then hold rounding alone, become
 the error of its points, |p| <= L about the body's frame. */
Convex Placed(const MovingShape& shape) {
  Convex placed = AtMiddle(shape);
  double error = shape.c.r.sum();
  const Vector3d half = shape.local->half;
  for (int j = 0; j < 3; ++j) error += half[j] * shape.A[j].r.sum();
  placed.error = (error + numeric::PlacementError(0, 0, placed.reach, placed.c.norm())) * kUp;
  return placed;
}

}  // namespace

// Kinematics at the point s alone; whatever is proved to meet there refutes.
const Item* CollisionDecider::FindMeeting(const std::vector<Item>& items, double s) {
  ++result_.leaves;
  EvaluateEdge<kDegree>(world_.tree(), edge_, {s, 0}, &x_.state);
  for (const Item& item : items) {
    if (Meets(item)) return &item;
  }
  return nullptr;
}

bool CollisionDecider::Meets(const Item& item) {
  const Convex a = Placed(Shape(item.shape));
  if (item.self) {
    numeric::SeparationHint hint;
    return DecideConvex(a, Placed(Shape(item.other)), 0, &hint, &x_.counts) == Verdict::kFails;
  }
  const ObstaclePiece& piece = g_.pieces[item.other];
  const double skin = Skin(item);
  numeric::SeparationHint hint;
  switch (piece.kind) {
    case PieceKind::kHalfspace:
      return DecideHalfspace(a, piece, skin, &x_.counts) == Verdict::kFails;
    case PieceKind::kMesh:
      return DecideMesh(a, *piece.mesh, skin, &x_.counts) == Verdict::kFails;
    case PieceKind::kConvex:
      break;
  }
  return DecideConvex(a, piece.convex, skin, &hint, &x_.counts) == Verdict::kFails;
}

/** An item for each piece that is not seen to be apart by boxes of the tree. */
void CollisionDecider::Expand(const Item& item) {
  if (item.node < 0) {
    x_.items.push_back(item);
    return;
  }
  const numeric::PieceTree::Node& node = g_.piece_tree.nodes()[item.node];
  const numeric::PieceTree::Corners box = BoxOf(Shape(item.shape));
  const auto meets = [&](const numeric::PieceTree::Corners& other) {
    return !numeric::BoxesApart(box,
                                options_.pose > 0 ? numeric::Widened(other, options_.pose) : other);
  };
  if (!meets(node.box)) return;
  if (node.count == 0) {
    Expand({item.shape, -1, false, node.first});
    Expand({item.shape, -1, false, node.first + 1});
  }
  const Vector3d middle = 0.5 * (box.first + box.second);
  for (int i = node.first; i < node.first + node.count; ++i) {
    const int piece = g_.piece_tree.order()[i];
    const numeric::PieceTree::Corners& other = g_.piece_tree.Box(piece);
    if (!meets(other)) continue;
    const Vector3d near = middle.cwiseMax(other.first).cwiseMin(other.second);
    x_.items.push_back({item.shape, piece, false, -1, (middle - near).squaredNorm()});
  }
}

// What of the items is not shown over the leaf. The nearest pieces of a shape come first: planes
// before them have many others behind.
std::vector<Item> CollisionDecider::OpenItems(const std::vector<Item>& items) {
  x_.items.clear();
  x_.shared.clear();
  for (const Item& item : items) Expand(item);
  const auto self =
      std::find_if(x_.items.begin(), x_.items.end(), [](const Item& item) { return item.self; });
  std::sort(x_.items.begin(), self, [](const Item& a, const Item& b) {
    return std::tie(a.shape, a.way, a.other) < std::tie(b.shape, b.way, b.other);
  });
  std::vector<Item> open;
  for (Item& item : x_.items) {
    if (Holds(&item)) {
      Note(item);
    } else {
      open.push_back(item);
    }
  }
  NoteShared();
  std::sort(open.begin(), open.end(), [](const Item& a, const Item& b) {
    return std::tie(a.self, a.shape, a.other) < std::tie(b.self, b.shape, b.other);
  });
  return open;
}

// Where a shape may be inside the box of a solid at the start, a ray shows that it is outside of
// it.
void CollisionDecider::NoteSides() {
  if (!options_.evidence) return;
  EvaluateEdge<kDegree>(world_.tree(), edge_, {0, 0}, &x_.state);
  for (int p = 0; p < static_cast<int>(g_.pieces.size()); ++p) {
    const ObstaclePiece& piece = g_.pieces[p];
    if (piece.kind != PieceKind::kMesh || !piece.mesh->solid || piece.mesh->nodes.empty()) continue;
    const numeric::MeshNode& node = piece.mesh->nodes[0];
    const Vector3d margin = Vector3d::Constant(1e-6);  // generous: a ray too many does no harm
    for (int s = 0; s < static_cast<int>(g_.shapes.size()); ++s) {
      const MovingShape shape = Move(g_.shapes[s], x_.state.X_WB[g_.shapes[s].body]);
      if (numeric::BoxesApart(BoxOf(shape), {node.lower - margin, node.upper + margin})) continue;
      for (const check::OutsideRay& ray : OutsideRays(x_.numbers[s], p)) {
        options_.evidence->outside.push_back(ray);
      }
    }
  }
}

void CollisionDecider::Split(const Leaf& leaf, std::vector<Item> items) {
  if (options_.evidence) options_.evidence->splits.insert(leaf);
  const double half = 0.5 * leaf.half;
  x_.tasks.push_back({{leaf.middle - half, half}, items});
  x_.tasks.push_back({{leaf.middle + half, half}, std::move(items)});
}

bool CollisionDecider::HasSolids() const {
  return std::any_of(g_.pieces.begin(), g_.pieces.end(), [](const ObstaclePiece& piece) {
    return piece.kind == PieceKind::kMesh && piece.mesh->solid;
  });
}

// Else says so in the result.
bool CollisionDecider::StartIsFree() {
  numeric::Place(world_, edge_.from, &x_.point);
  const numeric::FreeAnswer start = numeric::TestFree(world_, &x_.point);
  if (start.verdict == Verdict::kHolds) return true;
  result_.verdict = start.verdict;
  result_.pair = start.first;
  result_.s = 0;
  return false;
}

EdgeCollision CollisionDecider::Run() {
  // The first waypoint settles on which side of solids the robot starts.
  if (HasSolids() && !StartIsFree()) return result_;
  x_.shapes.resize(g_.shapes.size());
  x_.middles.resize(g_.shapes.size());
  x_.stamp.assign(g_.shapes.size(), -1);
  NoteSides();
  // Wide leaves first: their middles find a deep meeting before narrow ones close in on the instant
  // at which it begins, where nothing is certain.
  x_.tasks.clear();
  x_.tasks.push_back({{0.5, 0.5}, x_.all});
  while (!x_.tasks.empty()) {
    Task task = std::move(x_.tasks.front());
    x_.tasks.pop_front();
    if (task.leaf.half > options_.widest) {
      Split(task.leaf, std::move(task.items));
      continue;
    }
    ++result_.leaves;
    EvaluateEdge<kDegree>(world_.tree(), edge_, task.leaf, &x_.state);
    leaf_ = task.leaf;
    std::vector<Item> open = OpenItems(task.items);
    if (open.empty()) continue;
    if (const Item* meeting = FindMeeting(open, task.leaf.middle)) {
      result_.verdict = Verdict::kFails;
      result_.pair = PairOf(*meeting);
      result_.s = task.leaf.middle;
      return result_;
    }
    if (task.leaf.half <= options_.shortest || result_.leaves >= options_.max_leaves) {
      // Middles of leaves never are the start itself, where two may touch.
      if (!StartIsFree()) return result_;
      result_.verdict = Verdict::kUndecided;
      result_.pair = PairOf(open.front());
      result_.s = task.leaf.middle;
      return result_;
    }
    Split(task.leaf, std::move(open));
  }
  return result_;
}

}  // namespace collision_internal

EdgeCollision DecideEdgeCollision(const World& world, const Edge& edge,
                                  const EdgeCollisionOptions& options, EdgeWorkspace* workspace) {
  Require(options.shortest >= 0x1p-40, "leaves must not be shorter than 2^-40");
  return collision_internal::CollisionDecider(world, edge, options, workspace->scratch.get()).Run();
}

}  // namespace cguide::verify
