#include <algorithm>

#include "cguide/numeric/clearance_internal.h"
#include "cguide/numeric/gjk_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

// Raises lo where the direction is better than the best so far.
void TryDirection(const Convex& a, const Convex& b, const Vector3d& n, DirectedClearance* result) {
  const double lo = Gap(a, b, n) - a.error - b.error;
  if (lo > result->lo) {
    result->lo = lo;
    result->n_W = n;
  }
}

// Lowers hi where the points, each proven in its set, are nearer.
void TryPoints(const Convex& a, const Convex& b, const Vector3d& p, const Vector3d& q,
               DirectedClearance* result) {
  const double hi = (p - q).norm() * (1 + 4 * kUnit) + a.error + b.error;
  if (hi < result->hi) {
    result->hi = hi;
    result->a_W = p;
    result->b_W = q;
  }
}

// Penetration depth along the axes at hand, an estimate from above.
void EstimateDepth(const Convex& a, const Convex& b, const GjkResult& gjk,
                   DirectedClearance* result) {
  const BoxAxis axis = BestBoxAxis(a, b);
  SeparationHint hint;
  hint.code = static_cast<signed char>(axis.code);
  result->n_W = HintDirection(a, b, hint);
  result->depth = -Gap(a, b, result->n_W);
  const double length = gjk.v.norm();
  if (!gjk.overlap && length > 0) {
    const Vector3d n = gjk.v / length;
    const double depth = -Gap(a, b, n);
    if (depth < result->depth) {
      result->depth = depth;
      result->n_W = n;
    }
  }
  result->depth = std::max(0.0, result->depth);
}

void SetOverlap(DirectedClearance* result) {
  result->overlap = true;
  result->lo = result->hi = 0;
}

DirectedClearance Overlapping(const Convex& a, const Convex& b, const GjkResult& gjk) {
  DirectedClearance result;
  const double error = a.error + b.error;
  result.a_W = a.c + gjk.a;
  result.b_W = b.c + gjk.b;
  EstimateDepth(a, b, gjk, &result);
  const bool balls_meet = !gjk.overlap && gjk.v.norm() + error < a.radius + b.radius;
  if (balls_meet || ProveTetrahedron(gjk, error) || ProveCommonPoint(a, b, 0) ||
      ProveOctahedron(a, b, error)) {
    SetOverlap(&result);
    return result;
  }
  // Touching as far as doubles can tell: the witnesses, convex combinations, bound the distance.
  const double bound = (result.a_W - result.b_W).norm() - a.radius - b.radius;
  result.lo = 0;
  result.hi = std::max(0.0, bound) + 2 * error;
  result.depth = 0;
  return result;
}

// A lower bound of the distance from the boxes around the cores alone, without looking at points.
double BoxBound(const Convex& a, const Convex& b) {
  SeparationHint hint;
  hint.code = static_cast<signed char>(BestBoxAxis(a, b).code);
  const Vector3d n = HintDirection(a, b, hint);
  return n.dot(a.c - b.c) - BoxExtent(a, n) - BoxExtent(b, n) - a.radius - b.radius - a.error -
         b.error;
}

void Absorb(const DirectedClearance& one, DirectedClearance* all) {
  if (all->overlap && (!one.overlap || one.depth <= all->depth)) return;
  const double lo = std::min(all->lo, one.lo);
  if (one.overlap || one.hi < all->hi) *all = one;
  all->lo = lo;
}

DirectedClearance Nothing() {
  DirectedClearance result;
  result.lo = result.hi = INFINITY;
  return result;
}

}  // namespace

DirectedClearance ConvexClearance(const Convex& a, const Convex& b, double cutoff) {
  const double error = a.error + b.error;
  const Vector3d D = a.c - b.c;
  DirectedClearance result;
  result.lo = D.norm() * (1 - 4 * kUnit) - a.reach - b.reach - error;
  result.hi = INFINITY;
  if (result.lo >= cutoff) return result;
  if (std::isfinite(cutoff)) {
    result.lo = std::max(result.lo, BoxBound(a, b));
    if (result.lo >= cutoff) return result;
  }
  result.lo = 0;
  GjkResult gjk;
  Gjk(a, b, D, INFINITY, &gjk);
  const double length = gjk.v.norm();
  if (gjk.overlap || length - error <= a.radius + b.radius) return Overlapping(a, b, gjk);
  const Vector3d n = gjk.v / length;
  TryPoints(a, b, a.c + gjk.a - a.radius * n, b.c + gjk.b + b.radius * n, &result);
  TryDirection(a, b, n, &result);
  if (result.hi - result.lo > 4 * error) {
    const Vector3d normal = SimplexNormal(gjk);
    if (!normal.isZero(0)) TryDirection(a, b, normal, &result);
  }
  if (result.hi - result.lo > 4 * error) {
    for (int code = 0; code < 6; ++code) {
      TryDirection(a, b, HintDirection(a, b, {static_cast<signed char>(code), Vector3d::Zero()}),
                   &result);
    }
    const BoxAxis axis = BestBoxAxis(a, b);
    TryDirection(a, b, HintDirection(a, b, {static_cast<signed char>(axis.code), Vector3d::Zero()}),
                 &result);
  }
  return result;
}

DirectedClearance HalfspaceClearance(const Convex& shape, const ObstaclePiece& piece) {
  DirectedClearance result;
  const double error = shape.error + HalfspaceError(piece, shape.c.lpNorm<1>() + shape.reach);
  const double lowest = LowestAlong(shape, piece.normal) - piece.offset;
  result.n_W = piece.normal;
  result.a_W = shape.c + CoreSupport(shape, -piece.normal) - shape.radius * piece.normal;
  result.b_W = result.a_W - std::max(0.0, lowest) * piece.normal;
  result.lo = std::max(0.0, lowest - error);
  result.hi = std::max(0.0, lowest + error);
  if (lowest < -error) {
    SetOverlap(&result);
    result.depth = -lowest;
  }
  return result;
}

DirectedClearance MeshClearance(const Convex& shape, const Mesh& mesh, double cutoff) {
  DirectedClearance all = Nothing();
  all.lo = cutoff;
  const double slack = shape.reach + shape.error;
  const auto radius = [&] { return all.overlap ? -INFINITY : slack + std::min(cutoff, all.hi); };
  VisitByDistance(mesh, shape.c, radius, [&](int t) {
    std::array<Vector3d, 3> corners;
    Absorb(ConvexClearance(shape, TriangleConvex(mesh, t, &corners), std::min(cutoff, all.hi)),
           &all);
  });
  if (all.overlap || !mesh.solid) return all;
  const Vector3d x = InnerPoint(shape);
  const auto winding = all.lo > 0 ? WindingNumber(mesh, x) : std::nullopt;
  if (winding && *winding == 0) return all;
  if (!winding) {
    all.lo = 0;
    return all;
  }
  all.a_W = all.b_W = x;
  all.depth = 2 * shape.reach;
  SetOverlap(&all);
  return all;
}

DirectedClearance BodyClearance(const World& world, const Pair& pair, double cutoff,
                                Workspace* workspace) {
  const Geometry& g = world.geometry();
  Workspace::Scratch& scratch = *workspace->scratch;
  DirectedClearance all = Nothing();
  for (int s = g.body_begin[pair.body]; s < g.body_begin[pair.body + 1]; ++s) {
    const Convex& shape = scratch.shapes[s];
    const double reach = std::min(cutoff, all.hi);
    if (pair.self) {
      for (int t = g.body_begin[pair.other]; t < g.body_begin[pair.other + 1]; ++t) {
        Absorb(ConvexClearance(shape, scratch.shapes[t], std::min(cutoff, all.hi)), &all);
      }
      continue;
    }
    for (int p = g.object_begin[pair.other]; p < g.object_begin[pair.other + 1]; ++p) {
      const ObstaclePiece& piece = g.pieces[p];
      if (piece.kind == PieceKind::kHalfspace) {
        Absorb(HalfspaceClearance(shape, piece), &all);
      } else if (BallApart(shape.c, shape.reach + shape.error + reach, piece)) {
        DirectedClearance far = Nothing();
        far.lo = reach;
        Absorb(far, &all);
      } else if (piece.kind == PieceKind::kMesh) {
        Absorb(MeshClearance(shape, *piece.mesh, reach), &all);
      } else {
        Absorb(ConvexClearance(shape, piece.convex, reach), &all);
      }
    }
  }
  return all;
}

Clearance PairClearance(const World& world, const Pair& pair, double cutoff, Workspace* workspace) {
  Clearance result = BodyClearance(world, pair, cutoff, workspace);
  result.lo = std::min(result.lo, result.hi);
  return result;
}

}  // namespace cguide::numeric
