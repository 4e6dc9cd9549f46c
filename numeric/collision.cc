#include "cguide/numeric/collision_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

Verdict DecidePiece(const Convex& shape, const ObstaclePiece& piece, double skin,
                    SeparationHint* hint, StageCounts* counts) {
  switch (piece.kind) {
    case PieceKind::kConvex:
      return DecideConvex(shape, piece.convex, skin, hint, counts);
    case PieceKind::kHalfspace:
      return DecideHalfspace(shape, piece, skin, counts);
    case PieceKind::kMesh:
      return DecideMesh(shape, *piece.mesh, skin, counts);
  }
  return Verdict::kUndecided;
}

// Keeps the worst verdict; true where nothing can change any more.
bool Note(Verdict verdict, const Pair& pair, FreeAnswer* answer) {
  if (verdict == Verdict::kHolds) return false;
  if (verdict == Verdict::kFails || answer->verdict == Verdict::kHolds) {
    *answer = {verdict, pair};
  }
  return verdict == Verdict::kFails;
}

Verdict Worse(Verdict a, Verdict b) {
  if (a == Verdict::kFails || b == Verdict::kFails) return Verdict::kFails;
  return a == Verdict::kHolds ? b : a;
}

Verdict DecideBodyPiece(const Geometry& g, int body, int p, Workspace::Scratch* scratch) {
  Verdict verdict = Verdict::kHolds;
  const ObstaclePiece& piece = g.pieces[p];
  const double skin = g.PairSkin(body, piece.object);
  const int num_pieces = static_cast<int>(g.pieces.size());
  const bool single = g.body_begin[body + 1] - g.body_begin[body] == 1;
  for (int s = g.body_begin[body]; s < g.body_begin[body + 1]; ++s) {
    const Convex& shape = scratch->shapes[s];
    if (!single && BallApart(shape.c, shape.reach + shape.error, piece)) {
      ++scratch->counts.spheres;
      continue;
    }
    verdict = Worse(verdict, DecidePiece(shape, piece, skin, &scratch->hints[s * num_pieces + p],
                                         &scratch->counts));
    if (verdict == Verdict::kFails) return verdict;
  }
  return verdict;
}

// Centres and radii hold their errors but for the rounding of this line, 8 u of the squares.
bool BallsApart(const Vector3d& a, const Vector3d& b, double radii) {
  return (a - b).squaredNorm() > radii * radii * (1 + 16 * kUnit);
}

Verdict DecideSelf(const Geometry& g, int index, Workspace::Scratch* scratch) {
  const auto [i, j] = g.self_pairs[index];
  if (BallsApart(scratch->centers[i], scratch->centers[j], scratch->radii[i] + scratch->radii[j])) {
    ++scratch->counts.spheres;
    return Verdict::kHolds;
  }
  Verdict verdict = Verdict::kHolds;
  SeparationHint* hint = &scratch->hints[g.self_hint_begin[index]];
  const int begin = g.body_begin[i], end = g.body_begin[i + 1];
  const int other_begin = g.body_begin[j], other_end = g.body_begin[j + 1];
  const bool single = end - begin == 1 && other_end - other_begin == 1;
  for (int s = begin; s < end; ++s) {
    for (int t = other_begin; t < other_end; ++t, ++hint) {
      const Convex &a = scratch->shapes[s], &b = scratch->shapes[t];
      if (!single && BallsApart(a.c, b.c, a.reach + a.error + b.reach + b.error)) {
        ++scratch->counts.spheres;
        continue;
      }
      verdict = Worse(verdict, DecideConvex(a, b, 0, hint, &scratch->counts));
      if (verdict == Verdict::kFails) return verdict;
    }
  }
  return verdict;
}

}  // namespace

Verdict DecideHalfspace(const Convex& shape, const ObstaclePiece& piece, double skin,
                        StageCounts* counts) {
  const double lowest = LowestAlong(shape, piece.normal) - piece.offset;
  const double error = shape.error + HalfspaceError(piece, shape.c.lpNorm<1>() + shape.reach);
  if (lowest > error - skin) {
    ++counts->boxes;
    return Verdict::kHolds;
  }
  // The shortest way out of a halfspace is along its normal, by the depth of the deepest point.
  if (lowest < -error - skin) {
    ++counts->meets;
    return Verdict::kFails;
  }
  ++counts->undecided;
  return Verdict::kUndecided;
}

FreeAnswer TestFree(const World& world, Workspace* workspace) {
  const Geometry& g = world.geometry();
  Workspace::Scratch* scratch = workspace->scratch.get();
  FreeAnswer answer;
  for (int body = 0; body < g.num_bodies; ++body) {
    if (scratch->radii[body] < 0) continue;
    g.NearPieces(scratch->centers[body], scratch->radii[body], &scratch->near);
    scratch->counts.spheres += static_cast<long>(g.pieces.size() - scratch->near.size());
    for (const int p : scratch->near) {
      const Pair pair{body, g.pieces[p].object, false};
      if (Note(DecideBodyPiece(g, body, p, scratch), pair, &answer)) return answer;
    }
  }
  for (int i = 0; i < static_cast<int>(g.self_pairs.size()); ++i) {
    const Pair pair{g.self_pairs[i].first, g.self_pairs[i].second, true};
    if (Note(DecideSelf(g, i, scratch), pair, &answer)) return answer;
  }
  return answer;
}

std::vector<Pair> AllPairs(const World& world) {
  std::vector<Pair> pairs;
  const Geometry& g = world.geometry();
  for (int body = 0; body < g.num_bodies; ++body) {
    for (int object = 0; object < g.num_objects; ++object) pairs.push_back({body, object, false});
  }
  for (const auto& [i, j] : world.model().self_pairs) pairs.push_back({i, j, true});
  return pairs;
}

}  // namespace cguide::numeric
