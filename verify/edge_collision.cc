#include "cguide/verify/edge_collision.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <tuple>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/collision_internal.h"
#include "cguide/numeric/gjk_internal.h"
#include "cguide/verify/moving_shape_internal.h"
#include "cguide/verify/piece_tree_internal.h"

namespace cguide::verify {

using Eigen::Vector3d;
using numeric::Convex;
using numeric::Geometry;
using numeric::ObstaclePiece;
using numeric::Pair;
using numeric::PieceKind;
using numeric::World;

namespace {

/** Two things to keep apart: a shape and a piece, or (self) two shapes; or a shape and all pieces
 below a node of the tree. */
struct Item {
  int shape = -1;
  int other = -1;
  bool self = false;
  int node = -1;
  double way = 0;  ///< squared, from the middle of the shape's box to the piece's box
  Vector3d n_W = Vector3d::Zero();  ///< the direction that came nearest to a proof; zero: none
};

struct Task {
  Leaf leaf;
  std::vector<Item> items;
};

std::vector<Item> AllItems(const Geometry& g, const PieceTree& tree) {
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

/** A plane that shapes are strictly above, with the pieces that are behind it. */
struct SharedPlane {
  check::Plane plane;
  std::vector<int> shapes;
  int piece = -1;    ///< for which it was made
  int serves = 0;    ///< pairs of a shape and a piece
  int refused = -1;  ///< the last shape that is not above it
};

}  // namespace

struct EdgeWorkspace::Scratch {
  explicit Scratch(const World& world)
      : point(world),
        tree(world.geometry()),
        all(AllItems(world.geometry(), tree)),
        numbers(CertificateShapes(world)) {}
  numeric::Workspace point;
  TaylorState<kDegree> state;
  std::vector<MovingShape> shapes;
  std::vector<Convex> middles;  ///< of them
  std::vector<long> stamp;      ///< leaf for which a shape was moved last
  std::deque<Task> tasks;
  PieceTree tree;
  std::vector<Item> all;
  std::vector<Item> items;          ///< of the leaf at hand, one for each piece
  std::vector<SharedPlane> shared;  ///< of the leaf at hand
  std::vector<int> numbers;         ///< of shapes in certificates
  numeric::StageCounts counts;
};

EdgeWorkspace::EdgeWorkspace(const World& world) : scratch(std::make_unique<Scratch>(world)) {}
EdgeWorkspace::~EdgeWorkspace() = default;
EdgeWorkspace::EdgeWorkspace(EdgeWorkspace&&) noexcept = default;
EdgeWorkspace& EdgeWorkspace::operator=(EdgeWorkspace&&) noexcept = default;

namespace {

PieceTree::Corners BoxOf(const MovingShape& shape) { return {shape.lower, shape.upper}; }

/** The number of fewest decimals in [low, high], and the highest of them. */
double FewestDecimals(double low, double high) {
  double scale = 1;
  for (int k = 0; k < 12; ++k, scale *= 10) {
    const double x = std::floor(high * scale) / scale;
    if (x >= low && x <= high) return x + 0.0;  // no -0
  }
  return high;
}

/** Three decimals of each component, not longer than n. */
Vector3d Shortened(const Vector3d& n) {
  Vector3d few;
  for (int i = 0; i < 3; ++i) few[i] = std::trunc(n[i] * 1000) / 1000 + 0.0;  // no -0
  return few;
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
  template <typename Test>
  bool TestShortFirst(const Vector3d& n, double skin, const Test& test) const;
  bool IsServed(const MovingShape& a, const Item& item, const Convex& piece);
  PieceTree::Corners PieceBox(int piece) const;
  void Expand(const Item& item);
  std::vector<Item> OpenItems(const std::vector<Item>& items);
  void NoteShared();
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
  std::vector<check::Plane> planes_;  ///< that settled the item at hand; empty: others did
  bool may_share_ = false;            ///< the last of them may serve other pieces
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
  // Up to 0.75 of the way from the obstacle to the shape where rounding allows, so that as much of
  // the obstacles as possible lies behind. The shape is strictly above that plane too: rounding
  // m0 costs at most 2 u (|offset| + lowest), far less than the rest of the way.
  const bool wide = lowest > 0x1p-40 * (1 + std::abs(offset));
  planes_.push_back(
      {n, wide ? FewestDecimals(offset + 0.5 * lowest, offset + 0.75 * lowest) : offset, 0});
  may_share_ = wide;
  return true;
}

// Whether the piece is behind a plane that the shape is above by what was shown for another piece,
// or, as is shown now, above as another shape is. Where the shape is hardly above, the checker,
// whose bounds are a little different, might not see it.
bool Decider::IsServed(const MovingShape& a, const Item& item, const Convex& piece) {
  constexpr double kRoom = 1e-4;
  for (SharedPlane& shared : x_.shared) {
    if (shared.refused == item.shape) continue;
    const check::Plane& plane = shared.plane;
    if (!(HighestStatic(piece, plane.n) <= plane.m0)) continue;
    if (shared.shapes.back() != item.shape) {
      ++result_.tests;
      if (!(LowestOver(a, {plane.n, plane.m0, 0}) > kRoom + options_.pose * (1 + 16 * kUnit))) {
        shared.refused = item.shape;
        continue;
      }
      shared.shapes.push_back(item.shape);
    }
    ++shared.serves;
    return true;
  }
  return false;
}

// The reference moves with the mean of the two supporting vertices, but for an eighth of the way
// between them, that its numbers may be short.
bool Decider::Between(const MovingShape& a, const MovingShape& b, const Vector3d& n) {
  ++result_.tests;
  const Model2 low = LowestVertex(a, n), high = LowestVertex(b, -n);
  const double radii = 0.5 * (b.radius - a.radius);
  MovingPlane plane{n, 0.5 * (low.c[0] - high.c[0]) + radii, 0.5 * (low.c[1] - high.c[1])};
  if (options_.evidence) {
    const double way = low.c[0] + high.c[0] - a.radius - b.radius, slack = way / 16;
    if (!(slack > 0)) return false;
    plane.m0 = FewestDecimals(plane.m0 - slack, plane.m0 + slack);
    plane.m1 = FewestDecimals(plane.m1 - slack, plane.m1 + slack);
  }
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

// Short directions make short certificates. A skin is along a unit vector.
template <typename Test>
bool Decider::TestShortFirst(const Vector3d& n, double skin, const Test& test) const {
  return (options_.evidence && skin == 0 && test(Shortened(n))) || test(n);
}

bool Decider::HoldsStatic(const MovingShape& a, const Convex& middle, const Convex& b, double skin,
                          Item* item) {
  return AnyDirection(middle, b, item, [&](const Vector3d& way) {
    return TestShortFirst(
        way, skin, [&](const Vector3d& n) { return Above(a, HighestStatic(b, n), skin, n); });
  });
}

bool Decider::HoldsMoving(const MovingShape& a, const MovingShape& b, Item* item) {
  return AnyDirection(
      x_.middles[item->shape], x_.middles[item->other], item, [&](const Vector3d& way) {
        return TestShortFirst(way, 0, [&](const Vector3d& n) { return Between(a, b, n); });
      });
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
    if (BoxesApart(BoxOf(a), {node.lower - margin, node.upper + margin})) continue;
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
    return BoxesApart(BoxOf(a), BoxOf(b)) || HoldsMoving(a, b, item);
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
  return BoxesApart(BoxOf(a), PieceBox(item->other)) || IsServed(a, *item, piece.convex) ||
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
  if (planes_.empty()) return;
  const bool convex = !item.self && g_.pieces[item.other].kind == PieceKind::kConvex;
  if (convex && may_share_) {
    x_.shared.push_back({planes_.back(), {item.shape}, item.other, 1});
    return;
  }
  const bool halfspace = !item.self && g_.pieces[item.other].kind == PieceKind::kHalfspace;
  if (!options_.evidence || halfspace) return;
  check::Node& node = options_.evidence->nodes[leaf_];
  const int shape = x_.numbers[item.shape];
  if (item.self) {
    node.self_apart.push_back({shape, x_.numbers[item.other], planes_});
  } else {
    if (convex) planes_.back().m0 = 0;  // the checker takes the piece's highest point
    node.apart.push_back({shape, item.other, planes_});
  }
}

void Decider::NoteShared() {
  if (!options_.evidence || x_.shared.empty()) return;
  check::Node& node = options_.evidence->nodes[leaf_];
  for (const SharedPlane& shared : x_.shared) {
    if (shared.serves == 1) {
      node.apart.push_back({x_.numbers[shared.shapes[0]], shared.piece, {{shared.plane.n, 0, 0}}});
      continue;
    }
    check::SharedPlane noted{shared.plane, {}};
    for (const int shape : shared.shapes) noted.shapes.push_back(x_.numbers[shape]);
    node.above.push_back(std::move(noted));
  }
}

PieceTree::Corners Decider::PieceBox(int piece) const {
  const PieceTree::Corners& box = x_.tree.Box(piece);
  return options_.pose > 0 ? Widened(box, options_.pose) : box;
}

/** An item for each piece that is not seen to be apart by boxes of the tree. */
void Decider::Expand(const Item& item) {
  if (item.node < 0) {
    x_.items.push_back(item);
    return;
  }
  const PieceTree::Node& node = x_.tree.nodes()[item.node];
  const PieceTree::Corners box = BoxOf(Shape(item.shape));
  const auto meets = [&](const PieceTree::Corners& other) {
    return !BoxesApart(box, options_.pose > 0 ? Widened(other, options_.pose) : other);
  };
  if (!meets(node.box)) return;
  if (node.count == 0) {
    Expand({item.shape, -1, false, node.first});
    Expand({item.shape, -1, false, node.first + 1});
  }
  const Vector3d middle = 0.5 * (box.first + box.second);
  for (int i = node.first; i < node.first + node.count; ++i) {
    const int piece = x_.tree.order()[i];
    const PieceTree::Corners& other = x_.tree.Box(piece);
    if (!meets(other)) continue;
    const Vector3d near = middle.cwiseMax(other.first).cwiseMin(other.second);
    x_.items.push_back({item.shape, piece, false, -1, (middle - near).squaredNorm()});
  }
}

// What of the items is not shown over the leaf. The nearest pieces of a shape come first: planes
// before them have many others behind.
std::vector<Item> Decider::OpenItems(const std::vector<Item>& items) {
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
      if (BoxesApart(BoxOf(shape), {node.lower - margin, node.upper + margin})) continue;
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

}  // namespace

EdgeCollision DecideEdgeCollision(const World& world, const Edge& edge,
                                  const EdgeCollisionOptions& options, EdgeWorkspace* workspace) {
  Require(options.shortest >= 0x1p-40, "leaves must not be shorter than 2^-40");
  return Decider(world, edge, options, workspace->scratch.get()).Run();
}

}  // namespace cguide::verify
