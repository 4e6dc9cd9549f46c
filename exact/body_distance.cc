#include "cguide/exact/body_distance.h"

#include <algorithm>
#include <limits>

#include "cguide/exact/convex_distance.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace {

template <typename... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <typename... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

ExactPiece Prepare(const Piece& piece, const PrepareOptions& options) {
  const LinkPlacement X = ExactPlacement(piece.X_WP);
  const auto mesh = [&](const auto& m, bool is_solid) {
    return ExactMesh{MakeTriangleSet(m.vertices, m.triangles, X), is_solid};
  };
  return std::visit(Overloaded{[&](const Halfspace& h) -> ExactPiece {
                                 const Vector3q normal = Transformed(X.R, Lift(h.normal));
                                 return ExactHalfspace{normal, Lift(h.offset) + Dot(normal, X.p)};
                               },
                               [&](const Surface& m) -> ExactPiece { return mesh(m, false); },
                               [&](const Solid& m) -> ExactPiece { return mesh(m, true); },
                               [&](const auto& convex) -> ExactPiece {
                                 return Moved(Bracket(convex, options.cylinder_sides), X);
                               }},
                    piece.geometry);
}

Rational AtLeastZero(const Rational& x) { return x < 0 ? Rational(0) : x; }

/** Gathers pair answers into the answer of a union: the least distance, the weakest verdict. */
class Gathering {
 public:
  Gathering(const Rational& threshold, const SeparateOptions& options)
      : threshold_(threshold), options_(options) {}
  const Rational& threshold() const { return threshold_; }
  const SeparateOptions& options() const { return options_; }

  /** Whether sets with bounds this far apart can be left out: they hold, and are not nearest. A gap
   of 0 proves nothing. */
  bool Skips(const BoundingBox& a, const BoundingBox& b) const {
    const double gap = GapBelow(a, b);
    return gap > 0 && gap > skip_;
  }

  void Add(const Separation& part) {
    const Rational lower = count_ == 0 ? part.lower : std::min(result_.lower, part.lower);
    if (count_ == 0 || part.upper < result_.upper) {
      result_ = part;
      skip_ = std::max(RoundUp(result_.upper), RoundUp(threshold_));
    }
    result_.lower = lower;
    Weaken(part.verdict);
    ++count_;
  }

  /** Both sets share a point for certain. */
  void Meet() {
    worst_ = Verdict::kFails;
    result_.lower = result_.upper = 0;
  }

  /** They may share a point, for all that is known. */
  void MayMeet() {
    Weaken(Verdict::kUndecided);
    result_.lower = 0;
  }

  Separation Take() {
    if (count_ == 0) result_.lower = result_.upper = -1;
    result_.verdict = worst_;
    return result_;
  }

 private:
  void Weaken(Verdict verdict) {
    if (worst_ == Verdict::kFails || verdict == Verdict::kHolds) return;
    worst_ = verdict;
  }

  Rational threshold_;
  const SeparateOptions& options_;
  Separation result_;
  Verdict worst_ = Verdict::kHolds;
  int count_ = 0;
  double skip_ = std::numeric_limits<double>::infinity();
};

ConvexDistance Distance(const Core& a, const Core& b, const SeparateOptions& options) {
  if (options.finder) {
    ConvexDistance found = options.finder(a.points, b.points);
    if (CheckConvexDistance(a.points, b.points, found)) return found;
  }
  return SquaredConvexDistance(a.points, b.points);
}

/** Two convex sets. Support functions move by at most the errors e with the points, so the true
 signed distance of the shapes is at least sd(outer) - r - e and at most sd(inner) - r + e. */
Separation SeparateConvex(const ConvexBracket& a, const ConvexBracket& b, const Rational& threshold,
                          const SeparateOptions& options) {
  const Rational r = a.radius + b.radius, e = a.error + b.error;
  const ConvexDistance inner = Distance(a.inner, b.inner, options);
  const bool same = a.is_exact && b.is_exact;
  const Rational outer = same ? inner.squared : Distance(a.outer(), b.outer(), options).squared;
  Separation result;
  result.a = inner.a;
  result.b = inner.b;
  result.lower = AtLeastZero(SqrtDown(outer) - r - e);
  result.upper = AtLeastZero(SqrtUp(inner.squared) - r + e);
  if (ExceedsReach(a.outer(), b.outer(), outer, r + threshold + e) == Verdict::kHolds) {
    result.verdict = Verdict::kHolds;
  } else if (ExceedsReach(a.inner, b.inner, inner.squared, r + threshold - e) == Verdict::kFails) {
    result.verdict = Verdict::kFails;
  }
  return result;
}

const Vector3q& Lowest(const Core& core, const Vector3q& normal) {
  return *std::min_element(
      core.points.begin(), core.points.end(),
      [&](const Vector3q& p, const Vector3q& q) { return Dot(normal, p) < Dot(normal, q); });
}

/** A convex set and a halfspace: the signed distance is (min n.p - offset)/|n|, less the radius. */
Separation SeparateHalfspace(const ConvexBracket& a, const ExactHalfspace& h,
                             const Rational& threshold) {
  const Rational nn = SquaredNorm(h.normal);
  const Rational outer = Dot(h.normal, Lowest(a.outer(), h.normal)) - h.offset;
  Separation result;
  result.a = Lowest(a.inner, h.normal);
  const Rational inner = Dot(h.normal, result.a) - h.offset;
  result.b = inner > 0 ? Vector3q(result.a - Scaled(inner / nn, h.normal)) : result.a;
  result.lower = AtLeastZero(AtLeastZero(outer) / SqrtUp(nn) - a.radius - a.error);
  result.upper = AtLeastZero(AtLeastZero(inner) / SqrtDown(nn) - a.radius + a.error);
  if (CompareWithRoot(outer, a.radius + threshold + a.error, nn) == Sign::kPositive) {
    result.verdict = Verdict::kHolds;
  } else if (CompareWithRoot(inner, a.radius + threshold - a.error, nn) != Sign::kPositive) {
    result.verdict = Verdict::kFails;
  }
  return result;
}

/** Where a convex set that may be inside a closed mesh is, as far as its core points tell.

 A core point at more than `error` from the surface keeps its winding number over all its true
 places. Inside and deeper than -threshold besides, it fails; outside, it settles the question (the
 triangles are asked about separately): a connected set that clears the surface is where its points
 are. */
Verdict OutsideSolid(const ConvexBracket& a, const TriangleSet& mesh, const Rational& threshold) {
  Verdict verdict = Verdict::kUndecided;
  for (const Vector3q& p : a.inner.points) {
    const std::optional<int> winding = WindingNumber(mesh, p);
    if (!winding) continue;
    const Rational squared = SquaredTriangleDistance(std::span(&p, 1), mesh).squared;
    const Rational depth = a.error + (*winding == 0 ? Rational(0) : AtLeastZero(-threshold));
    if (squared <= depth * depth) continue;
    if (*winding != 0) return Verdict::kFails;
    verdict = Verdict::kHolds;
    if (threshold >= 0) break;  // a further point inside would cross the triangles
  }
  return verdict;
}

void AddMesh(const ConvexBracket& a, const ExactMesh& mesh, int part_a, int part_b,
             Gathering* gathering) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < mesh.triangles.triangles.size(); ++k) {
    order.emplace_back(GapBelow(a.bounds, mesh.triangles.bounds[k]), k);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [gap, k] : order) {
    if (gathering->Skips(a.bounds, mesh.triangles.bounds[k])) break;
    ConvexBracket triangle;
    triangle.inner = TriangleCore(mesh.triangles.triangles[k]);
    Separation part = SeparateConvex(a, triangle, gathering->threshold(), gathering->options());
    part.part_a = part_a;
    part.part_b = part_b;
    gathering->Add(part);
  }
  if (!mesh.is_solid) return;
  const Verdict outside = OutsideSolid(a, mesh.triangles, gathering->threshold());
  if (outside == Verdict::kFails) gathering->Meet();
  if (outside == Verdict::kUndecided) gathering->MayMeet();
}

}  // namespace

PreparedModel PrepareModel(const Model& model, const PrepareOptions& options) {
  PreparedModel result;
  for (const Link& link : model.robot.links) {
    std::vector<ConvexBracket>& shapes = result.links.emplace_back();
    for (const LinkShape& shape : link.shapes) {
      shapes.push_back(
          Moved(Bracket(shape.geometry, options.cylinder_sides), ExactPlacement(shape.X_LS)));
    }
  }
  for (const Body& body : model.robot.bodies) result.bodies.push_back(body.links);
  for (const Object& object : model.objects) {
    std::vector<ExactPiece>& pieces = result.objects.emplace_back();
    for (const Piece& piece : object.pieces) pieces.push_back(Prepare(piece, options));
  }
  return result;
}

std::vector<ConvexBracket> PlaceBody(const PreparedModel& model, const RobotPlacement& placement,
                                     int body) {
  std::vector<ConvexBracket> result;
  for (int link : model.bodies.at(static_cast<std::size_t>(body))) {
    for (const ConvexBracket& shape : model.links[link]) {
      result.push_back(Moved(shape, placement.links.at(static_cast<std::size_t>(link))));
    }
  }
  return result;
}

Separation Separate(std::span<const ConvexBracket> body, std::span<const ExactPiece> object,
                    const Rational& threshold, const SeparateOptions& options) {
  Gathering gathering(threshold, options);
  for (std::size_t i = 0; i < body.size(); ++i) {
    for (std::size_t j = 0; j < object.size(); ++j) {
      const int part_a = static_cast<int>(i), part_b = static_cast<int>(j);
      const auto add = [&](Separation part) {
        part.part_a = part_a;
        part.part_b = part_b;
        gathering.Add(part);
      };
      std::visit(Overloaded{[&](const ConvexBracket& piece) {
                              if (gathering.Skips(body[i].bounds, piece.bounds)) return;
                              add(SeparateConvex(body[i], piece, threshold, options));
                            },
                            [&](const ExactHalfspace& piece) {
                              add(SeparateHalfspace(body[i], piece, threshold));
                            },
                            [&](const ExactMesh& piece) {
                              AddMesh(body[i], piece, part_a, part_b, &gathering);
                            }},
                 object[j]);
    }
  }
  return gathering.Take();
}

Separation Separate(std::span<const ConvexBracket> body, std::span<const ConvexBracket> other,
                    const Rational& threshold, const SeparateOptions& options) {
  Gathering gathering(threshold, options);
  for (std::size_t i = 0; i < body.size(); ++i) {
    for (std::size_t j = 0; j < other.size(); ++j) {
      if (gathering.Skips(body[i].bounds, other[j].bounds)) continue;
      Separation part = SeparateConvex(body[i], other[j], threshold, options);
      part.part_a = static_cast<int>(i);
      part.part_b = static_cast<int>(j);
      gathering.Add(part);
    }
  }
  return gathering.Take();
}

Separation BodyObjectSeparation(const PreparedModel& model, const RobotPlacement& placement,
                                int body, int object, const Rational& threshold) {
  return Separate(PlaceBody(model, placement, body),
                  model.objects.at(static_cast<std::size_t>(object)), threshold);
}

Separation BodyBodySeparation(const PreparedModel& model, const RobotPlacement& placement, int body,
                              int other, const Rational& threshold) {
  return Separate(PlaceBody(model, placement, body), PlaceBody(model, placement, other), threshold);
}

}  // namespace cguide::exact
