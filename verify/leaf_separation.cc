#include <algorithm>
#include <cmath>

#include "cguide/numeric/gjk_internal.h"
#include "cguide/verify/edge_collision_internal.h"

namespace cguide::verify::collision_internal {

using Eigen::Vector3d;
using numeric::Convex;
using numeric::ObstaclePiece;
using numeric::PieceKind;

namespace {

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

}  // namespace

double CollisionDecider::Skin(const Item& item) const {
  return item.self ? 0 : g_.PairSkin(g_.shapes[item.shape].body, g_.pieces[item.other].object);
}

const MovingShape& CollisionDecider::Shape(int index) {
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
bool CollisionDecider::Above(const MovingShape& a, double offset, double skin, const Vector3d& n) {
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
bool CollisionDecider::IsServed(const MovingShape& a, const Item& item, const Convex& piece) {
  constexpr double kRoom = 1e-4;
  for (SharedPlane& shared : x_.shared) {
    if (shared.refused == item.shape) continue;
    const check::Plane& plane = shared.plane;
    if (!(numeric::HighestStatic(piece, plane.n) <= plane.m0)) continue;
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
bool CollisionDecider::Between(const MovingShape& a, const MovingShape& b, const Vector3d& n) {
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

// Short directions make short certificates. A skin is along a unit vector.
template <typename Test>
bool CollisionDecider::TestShortFirst(const Vector3d& n, double skin, const Test& test) const {
  return (options_.evidence && skin == 0 && test(Shortened(n))) || test(n);
}

bool CollisionDecider::HoldsStatic(const MovingShape& a, const Convex& middle, const Convex& b,
                                   double skin, Item* item) {
  return AnyDirection(middle, b, item, [&](const Vector3d& way) {
    return TestShortFirst(way, skin, [&](const Vector3d& n) {
      return Above(a, numeric::HighestStatic(b, n), skin, n);
    });
  });
}

bool CollisionDecider::HoldsMoving(const MovingShape& a, const MovingShape& b, Item* item) {
  return AnyDirection(
      x_.middles[item->shape], x_.middles[item->other], item, [&](const Vector3d& way) {
        return TestShortFirst(way, 0, [&](const Vector3d& n) { return Between(a, b, n); });
      });
}

bool CollisionDecider::HoldsHalfspace(const MovingShape& a, const ObstaclePiece& piece,
                                      double skin) {
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
bool CollisionDecider::HoldsMesh(const MovingShape& a, const Convex& middle,
                                 const numeric::Mesh& mesh, double skin) {
  if (mesh.nodes.empty()) return true;
  const Vector3d margin = Vector3d::Constant((mesh.error + options_.pose) * kUp);
  std::vector<int> open{0};
  while (!open.empty()) {
    const numeric::MeshNode& node = mesh.nodes[open.back()];
    open.pop_back();
    if (numeric::BoxesApart(BoxOf(a), {node.lower - margin, node.upper + margin})) continue;
    if (node.count == 0) {
      open.push_back(node.first);
      open.push_back(node.first + 1);
      continue;
    }
    for (int i = 0; i < node.count; ++i) {
      std::array<Vector3d, 3> corners;
      const Convex triangle = numeric::TriangleConvex(mesh, mesh.order[node.first + i], &corners);
      const bool behind =
          std::any_of(planes_.begin(), planes_.end(), [&](const check::Plane& plane) {
            return numeric::HighestStatic(triangle, plane.n) <= plane.m0;
          });
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

bool CollisionDecider::Holds(Item* item) {
  planes_.clear();
  const MovingShape& a = Shape(item->shape);
  if (item->self) {
    const MovingShape& b = Shape(item->other);
    return numeric::BoxesApart(BoxOf(a), BoxOf(b)) || HoldsMoving(a, b, item);
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
  return numeric::BoxesApart(BoxOf(a), PieceBox(item->other)) || IsServed(a, *item, piece.convex) ||
         HoldsStatic(a, x_.middles[item->shape], piece.convex, skin, item);
}

// Halfspaces are their own planes, and the checker looks at boxes by itself.
void CollisionDecider::Note(const Item& item) {
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

void CollisionDecider::NoteShared() {
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

numeric::PieceTree::Corners CollisionDecider::PieceBox(int piece) const {
  const numeric::PieceTree::Corners& box = g_.piece_tree.Box(piece);
  return options_.pose > 0 ? numeric::Widened(box, options_.pose) : box;
}

}  // namespace cguide::verify::collision_internal
