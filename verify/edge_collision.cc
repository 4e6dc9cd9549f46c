#include "cguide/verify/edge_collision.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/collision_internal.h"
#include "cguide/numeric/gjk_internal.h"
#include "cguide/verify/moving_shape_internal.h"

namespace cguide::verify {

using Eigen::Vector3d;
using numeric::Convex;
using numeric::Geometry;
using numeric::ObstaclePiece;
using numeric::Pair;
using numeric::PieceKind;
using numeric::World;

namespace {

/** Two things to keep apart: a shape and a piece, or (self) two shapes. */
struct Item {
  int shape = -1;
  int other = -1;
  bool self = false;
  Vector3d n_W = Vector3d::Zero();  ///< the direction that came nearest to a proof; zero: none
};

struct Task {
  Leaf leaf;
  std::vector<Item> items;
};

/** n.x over a placed convex set, at most; |n| <= 1 + 8 u. The rounding of this line is within
 s.error (item 4 at PlacementError). */
double HighestStatic(const Convex& s, const Vector3d& n) {
  return n.dot(s.c) + numeric::CoreExtent(s, n) + s.radius * (1 + 16 * kUnit) +
         s.error * (1 + 16 * kUnit);
}

/** Box around a placed convex set, rounded outwards. */
void StaticBox(const Convex& s, Vector3d* lower, Vector3d* upper) {
  for (int i = 0; i < 3; ++i) {
    (*upper)[i] = HighestStatic(s, Vector3d::Unit(i));
    (*lower)[i] = -HighestStatic(s, -Vector3d::Unit(i));
  }
}

std::vector<Item> AllItems(const Geometry& g) {
  std::vector<Item> items;
  for (int s = 0; s < static_cast<int>(g.shapes.size()); ++s) {
    for (int p = 0; p < static_cast<int>(g.pieces.size()); ++p) items.push_back({s, p, false});
  }
  for (const auto& [i, j] : g.self_pairs) {
    for (int s = g.body_begin[i]; s < g.body_begin[i + 1]; ++s) {
      for (int t = g.body_begin[j]; t < g.body_begin[j + 1]; ++t) items.push_back({s, t, true});
    }
  }
  return items;
}

}  // namespace

struct EdgeWorkspace::Scratch {
  explicit Scratch(const World& world)
      : point(world), all(AllItems(world.geometry())), numbers(CertificateShapes(world)) {
    for (const ObstaclePiece& piece : world.geometry().pieces) {
      auto& [lower, upper] = boxes.emplace_back(Vector3d::Zero(), Vector3d::Zero());
      if (piece.kind == PieceKind::kConvex) StaticBox(piece.convex, &lower, &upper);
    }
  }
  numeric::Workspace point;
  TaylorState<kDegree> state;
  std::vector<MovingShape> shapes;
  std::vector<Convex> middles;  ///< of them
  std::vector<long> stamp;      ///< leaf for which a shape was moved last
  std::deque<Task> tasks;
  std::vector<Item> all;
  std::vector<std::pair<Vector3d, Vector3d>> boxes;  ///< of convex pieces, rounded outwards
  std::vector<int> numbers;                          ///< of shapes in certificates
  numeric::StageCounts counts;
};

EdgeWorkspace::EdgeWorkspace(const World& world) : scratch(std::make_unique<Scratch>(world)) {}
EdgeWorkspace::~EdgeWorkspace() = default;
EdgeWorkspace::EdgeWorkspace(EdgeWorkspace&&) noexcept = default;
EdgeWorkspace& EdgeWorkspace::operator=(EdgeWorkspace&&) noexcept = default;

namespace {

bool BoxesApart(const Vector3d& lower, const Vector3d& upper, const Vector3d& other_lower,
                const Vector3d& other_upper) {
  return (lower.array() > other_upper.array()).any() || (other_lower.array() > upper.array()).any();
}

class Decider {
 public:
  Decider(const World& world, const Edge& edge, const EdgeCollisionOptions& options,
          EdgeWorkspace::Scratch* scratch)
      : world_(world), g_(world.geometry()), edge_(edge), options_(options), x_(*scratch) {}

  EdgeCollision Run();

 private:
  Pair PairOf(const Item& item) const;
  double Skin(const Item& item) const;
  const MovingShape& Shape(int index);

  bool Holds(Item* item);
  bool HoldsStatic(const MovingShape& a, const Convex& middle, const Convex& b, double skin,
                   Item* item);
  bool HoldsMoving(const MovingShape& a, const MovingShape& b, Item* item);
  bool HoldsMesh(const MovingShape& a, const Convex& middle, const numeric::Mesh& mesh,
                 double skin);
  bool HoldsHalfspace(const MovingShape& a, const ObstaclePiece& piece, double skin);
  bool Above(const MovingShape& a, double offset, double skin, const Vector3d& n);
  bool Between(const MovingShape& a, const MovingShape& b, const Vector3d& n);
  bool HasSolids() const;
  bool StartIsFree();
  void NoteSides();
  void Note(const Item& item);

  const Item* FindMeeting(const std::vector<Item>& items, double s);
  bool Meets(const Item& item);
  void Split(const Leaf& leaf, std::vector<Item> items);

  const World& world_;
  const Geometry& g_;
  const Edge& edge_;
  const EdgeCollisionOptions& options_;
  EdgeWorkspace::Scratch& x_;
  EdgeCollision result_;
  Leaf leaf_;                         ///< at hand
  std::vector<check::Plane> planes_;  ///< that settled the item at hand; empty: its boxes did
};

Pair Decider::PairOf(const Item& item) const {
  const int other = item.self ? g_.shapes[item.other].body : g_.pieces[item.other].object;
  return {g_.shapes[item.shape].body, other, item.self};
}

double Decider::Skin(const Item& item) const {
  return item.self ? 0 : g_.PairSkin(g_.shapes[item.shape].body, g_.pieces[item.other].object);
}

const MovingShape& Decider::Shape(int index) {
  if (x_.stamp[index] != result_.leaves) {
    const numeric::BodyShape& shape = g_.shapes[index];
    x_.shapes[index] = Move(shape, x_.state.X_WB[shape.body]);
    x_.middles[index] = AtMiddle(x_.shapes[index]);
    x_.stamp[index] = result_.leaves;
  }
  return x_.shapes[index];
}

// Every point of the shape is strictly above the plane n.x = offset - skin for every t, or above it
// after a translation of skin along n, 1 - 8 u <= |n| <= 1 + 8 u; and so where the plane is moved
// by `pose`.
bool Decider::Above(const MovingShape& a, double offset, double skin, const Vector3d& n) {
  ++result_.tests;
  const double lowest = LowestOver(a, {n, offset, 0}) - options_.pose * (1 + 16 * kUnit);
  if (!(lowest > -skin * (1 - 16 * kUnit))) return false;
  ++result_.planes;
  // Half way between the two where rounding allows, so that as much of the obstacle as possible
  // lies behind.
  const bool wide = lowest > 0x1p-40 * (1 + std::abs(offset));
  planes_.push_back({n, wide ? offset + 0.5 * lowest : offset, 0});
  return true;
}

// The reference moves with the mean of the two supporting vertices.
bool Decider::Between(const MovingShape& a, const MovingShape& b, const Vector3d& n) {
  ++result_.tests;
  const Model2 low = LowestVertex(a, n), high = LowestVertex(b, -n);
  const double radii = 0.5 * (b.radius - a.radius);
  const MovingPlane plane{n, 0.5 * (low.c[0] - high.c[0]) + radii, 0.5 * (low.c[1] - high.c[1])};
  if (!(LowestOver(a, plane) > 0 && HighestOver(b, plane) < 0)) return false;
  ++result_.planes;
  planes_.push_back({n, plane.m0, plane.m1});
  return true;
}

/** Directions from b towards a worth trying, from the middle of the leaf: the separating axes of
 the boxes, then the closest points. Calls test(n) until it says yes. */
template <typename Test>
bool AnyDirection(const Convex& a, const Convex& b, Item* item, const Test& test) {
  const auto good = [&](const Vector3d& n) {
    item->n_W = n;
    return test(n);
  };
  if (!item->n_W.isZero(0) && test(item->n_W)) return true;
  const numeric::BoxAxis axis = numeric::BestBoxAxis(a, b);
  if (axis.gap > 0) {
    numeric::SeparationHint hint;
    hint.code = static_cast<signed char>(axis.code);
    if (good(numeric::HintDirection(a, b, hint))) return true;
  }
  const bool boxes = a.kind == numeric::CoreKind::kBox && b.kind == numeric::CoreKind::kBox;
  if (boxes && a.half.minCoeff() > 0 && b.half.minCoeff() > 0 && axis.gap <= 0) return false;
  numeric::GjkResult gjk;
  numeric::Gjk(a, b, a.c - b.c, INFINITY, &gjk);
  const double length = gjk.v.norm();
  return !gjk.overlap && length > 0 && good(gjk.v / length);
}

bool Decider::HoldsStatic(const MovingShape& a, const Convex& middle, const Convex& b, double skin,
                          Item* item) {
  return AnyDirection(middle, b, item,
                      [&](const Vector3d& n) { return Above(a, HighestStatic(b, n), skin, n); });
}

bool Decider::HoldsMoving(const MovingShape& a, const MovingShape& b, Item* item) {
  return AnyDirection(x_.middles[item->shape], x_.middles[item->other], item,
                      [&](const Vector3d& n) { return Between(a, b, n); });
}

bool Decider::HoldsHalfspace(const MovingShape& a, const ObstaclePiece& piece, double skin) {
  const double reach = a.lower.cwiseAbs().cwiseMax(a.upper.cwiseAbs()).sum();
  // Three products and two sums over the box, |n| <= 1 + 8 u: within 8 u of its reach.
  const Vector3d& n = piece.normal;
  const double lowest = n.cwiseProduct(a.lower).cwiseMin(n.cwiseProduct(a.upper)).sum();
  const double error = 8 * kUnit * reach + numeric::HalfspaceError(piece, reach);
  if (lowest - piece.offset > (options_.pose + error) * kUp) return true;
  return Above(a, piece.offset + numeric::HalfspaceError(piece, reach), skin, piece.normal);
}

// Triangles whose box the shape's box does not meet cannot touch it, nor can those behind a plane
// that served for another one.
bool Decider::HoldsMesh(const MovingShape& a, const Convex& middle, const numeric::Mesh& mesh,
                        double skin) {
  if (mesh.nodes.empty()) return true;
  const Vector3d margin = Vector3d::Constant((mesh.error + options_.pose) * kUp);
  std::vector<int> open{0};
  while (!open.empty()) {
    const numeric::MeshNode& node = mesh.nodes[open.back()];
    open.pop_back();
    if (BoxesApart(a.lower, a.upper, node.lower - margin, node.upper + margin)) continue;
    if (node.count == 0) {
      open.push_back(node.first);
      open.push_back(node.first + 1);
      continue;
    }
    for (int i = 0; i < node.count; ++i) {
      std::array<Vector3d, 3> corners;
      const Convex triangle = numeric::TriangleConvex(mesh, mesh.order[node.first + i], &corners);
      const bool behind = std::any_of(
          planes_.begin(), planes_.end(),
          [&](const check::Plane& plane) { return HighestStatic(triangle, plane.n) <= plane.m0; });
      if (behind) continue;
      Item none;
      const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      if (normal.norm() > 0) {
        none.n_W = normal.normalized();
        if (none.n_W.dot(a.c.c[0].head<3>().matrix() - triangle.c) < 0) none.n_W = -none.n_W;
      }
      if (!HoldsStatic(a, middle, triangle, skin, &none)) return false;
    }
  }
  return true;
}

bool Decider::Holds(Item* item) {
  planes_.clear();
  const MovingShape& a = Shape(item->shape);
  if (item->self) {
    const MovingShape& b = Shape(item->other);
    return BoxesApart(a.lower, a.upper, b.lower, b.upper) || HoldsMoving(a, b, item);
  }
  const ObstaclePiece& piece = g_.pieces[item->other];
  const double skin = Skin(*item);
  switch (piece.kind) {
    case PieceKind::kHalfspace:
      return HoldsHalfspace(a, piece, skin);
    case PieceKind::kMesh:
      // With a skin a shape thinner than it could pass through the triangles of a solid unseen, and
      // its side would no longer be that at s = 0: solids are kept strictly apart.
      return HoldsMesh(a, x_.middles[item->shape], *piece.mesh, piece.mesh->solid ? 0 : skin);
    case PieceKind::kConvex:
      break;
  }
  auto [lower, upper] = x_.boxes[item->other];
  if (options_.pose > 0) {
    lower = lower.array() - options_.pose * kUp - kUnit * lower.array().abs();
    upper = upper.array() + options_.pose * kUp + kUnit * upper.array().abs();
  }
  return BoxesApart(a.lower, a.upper, lower, upper) ||
         HoldsStatic(a, x_.middles[item->shape], piece.convex, skin, item);
}

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

// Kinematics at the point s alone; whatever is proved to meet there refutes.
const Item* Decider::FindMeeting(const std::vector<Item>& items, double s) {
  ++result_.leaves;
  EvaluateEdge<kDegree>(world_.tree(), edge_, {s, 0}, &x_.state);
  for (const Item& item : items) {
    if (Meets(item)) return &item;
  }
  return nullptr;
}

bool Decider::Meets(const Item& item) {
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

// Halfspaces are their own planes, and the checker looks at boxes by itself.
void Decider::Note(const Item& item) {
  const bool halfspace = !item.self && g_.pieces[item.other].kind == PieceKind::kHalfspace;
  if (!options_.evidence || planes_.empty() || halfspace) return;
  check::Node& node = options_.evidence->nodes[leaf_];
  const int shape = x_.numbers[item.shape];
  if (item.self) {
    node.self_apart.push_back({shape, x_.numbers[item.other], planes_});
  } else {
    node.apart.push_back({shape, item.other, planes_});
  }
}

// Where a shape may be inside the box of a solid at the start, a ray shows that it is outside of
// it.
void Decider::NoteSides() {
  if (!options_.evidence) return;
  EvaluateEdge<kDegree>(world_.tree(), edge_, {0, 0}, &x_.state);
  for (int p = 0; p < static_cast<int>(g_.pieces.size()); ++p) {
    const ObstaclePiece& piece = g_.pieces[p];
    if (piece.kind != PieceKind::kMesh || !piece.mesh->solid || piece.mesh->nodes.empty()) continue;
    const numeric::MeshNode& node = piece.mesh->nodes[0];
    const Vector3d margin = Vector3d::Constant(1e-6);  // generous: a ray too many does no harm
    for (int s = 0; s < static_cast<int>(g_.shapes.size()); ++s) {
      const MovingShape shape = Move(g_.shapes[s], x_.state.X_WB[g_.shapes[s].body]);
      if (BoxesApart(shape.lower, shape.upper, node.lower - margin, node.upper + margin)) continue;
      for (const check::OutsideRay& ray : OutsideRays(x_.numbers[s], p)) {
        options_.evidence->outside.push_back(ray);
      }
    }
  }
}

void Decider::Split(const Leaf& leaf, std::vector<Item> items) {
  if (options_.evidence) options_.evidence->splits.insert(leaf);
  const double half = 0.5 * leaf.half;
  x_.tasks.push_back({{leaf.middle - half, half}, items});
  x_.tasks.push_back({{leaf.middle + half, half}, std::move(items)});
}

bool Decider::HasSolids() const {
  return std::any_of(g_.pieces.begin(), g_.pieces.end(), [](const ObstaclePiece& piece) {
    return piece.kind == PieceKind::kMesh && piece.mesh->solid;
  });
}

// Else says so in the result.
bool Decider::StartIsFree() {
  numeric::Place(world_, edge_.from, &x_.point);
  const numeric::FreeAnswer start = numeric::TestFree(world_, &x_.point);
  if (start.verdict == Verdict::kHolds) return true;
  result_.verdict = start.verdict;
  result_.pair = start.first;
  result_.s = 0;
  return false;
}

EdgeCollision Decider::Run() {
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
    std::vector<Item> open;
    leaf_ = task.leaf;
    open.reserve(task.items.size());
    for (Item& item : task.items) {
      if (Holds(&item)) {
        Note(item);
      } else {
        open.push_back(item);
      }
    }
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

}  // namespace

EdgeCollision DecideEdgeCollision(const World& world, const Edge& edge,
                                  const EdgeCollisionOptions& options, EdgeWorkspace* workspace) {
  Require(options.shortest >= 0x1p-40, "leaves must not be shorter than 2^-40");
  return Decider(world, edge, options, workspace->scratch.get()).Run();
}

}  // namespace cguide::verify
