#include <algorithm>

#include "cguide/exact/contact_internal.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/projection.h"

namespace cguide::exact {
namespace internal {
namespace {

template <typename... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <typename... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

ConvexSet CoreSet(const ConvexShape& shape, const LinkPlacement& X) {
  const ConvexBracket bracket = Moved(Bracket(shape, 8), X);
  ConvexSet set;
  set.points = bracket.inner.points;
  set.faces = bracket.inner.faces;
  set.radius = bracket.radius;
  set.bounds = bracket.bounds;
  return set;
}

/** A box, or a cylinder by its box. */
ConvexSet FramedSet(SetKind kind, const Vector3q& half, const LinkPlacement& X) {
  ConvexSet set;
  set.kind = kind;
  set.half = half;
  set.X = X;
  std::vector<Vector3q> corners;
  for (int k = 0; k < 8; ++k) {
    Vector3q corner = half;
    for (int c = 0; c < 3; ++c) corner[c] *= k >> c & 1 ? 1 : -1;
    corners.push_back(Transformed(X.R, corner) + X.p);
  }
  set.bounds = BoundsOf(corners);
  return set;
}

class Collector {
 public:
  explicit Collector(ContactSets* sets) : sets_(sets) {}

  void Add(int object, const Piece& piece) {
    const LinkPlacement X = ExactPlacement(piece.X_WP);
    std::visit(Overloaded{[&](const Halfspace& h) {
                            ConvexSet set;
                            set.kind = SetKind::kHalfspace;
                            set.normal = Transformed(X.R, Lift(h.normal));
                            set.offset = Lift(h.offset) + Dot(set.normal, X.p);
                            Push(object, std::move(set));
                          },
                          [&](const Surface& m) { AddTriangles(object, -1, Triangles(m, X)); },
                          [&](const Solid& m) {
                            sets_->solids.push_back(Triangles(m, X));
                            AddTriangles(object, static_cast<int>(sets_->solids.size()) - 1,
                                         sets_->solids.back());
                          },
                          [&](const Box& b) {
                            Push(object,
                                 FramedSet(SetKind::kBox, Scaled(Rational(1, 2), Lift(b.size)), X));
                          },
                          [&](const Cylinder& c) {
                            const Rational radius = Lift(c.radius), half = Lift(c.length) / 2;
                            Push(object, FramedSet(SetKind::kCylinder, {radius, radius, half}, X));
                          },
                          [&](const auto& convex) { Push(object, CoreSet(convex, X)); }},
               piece.geometry);
  }

 private:
  template <typename Mesh>
  static TriangleSet Triangles(const Mesh& mesh, const LinkPlacement& X) {
    return MakeTriangleSet(mesh.vertices, mesh.triangles, X);
  }

  void AddTriangles(int object, int solid, const TriangleSet& mesh) {
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
      ConvexSet set;
      set.kind = SetKind::kTriangle;
      set.solid = solid;
      set.points.assign(mesh.triangles[k].begin(), mesh.triangles[k].end());
      set.bounds = mesh.bounds[k];
      Push(object, std::move(set));
    }
  }

  void Push(int object, ConvexSet set) {
    set.object = object;
    sets_->sets.push_back(std::move(set));
  }

  ContactSets* sets_;
};

Vector3q CoreFoot(const ConvexSet& set, const Vector3q& z) {
  const std::vector<Vector3q>& p = set.points;
  if (p.size() == 1) return p[0];
  if (p.size() == 2) return ClosestOnSegment(p[0], p[1], z);
  if (set.kind == SetKind::kTriangle) return ClosestOnTriangle(p[0], p[1], p[2], z);
  return ClosestOnHull(p, z);
}

Vector3q ToFrame(const ConvexSet& set, const Vector3q& z) {
  return Transformed(set.X.R.transpose(), z - set.X.p);
}

Vector3q FromFrame(const ConvexSet& set, const Vector3q& l) {
  return Transformed(set.X.R, l) + set.X.p;
}

/** A factor within `error` of length/sqrt(squared), and that error times the vector's length. */
struct Shrink {
  Rational factor, error;
};

/** v length/|v| as factor v: with lo <= |v| <= hi the factor length/hi is off by length (1/|v| -
 1/hi), on v by at most length (hi - lo)/hi. */
Shrink ShrinkTo(const Rational& length, const Rational& squared, int bits) {
  const Root root = RootOf(squared, bits);
  return {length / root.hi, length * (root.hi - root.lo) / root.hi};
}

Foot FootOnCylinder(const ConvexSet& set, const Vector3q& z, int bits) {
  Vector3q l = ToFrame(set, z);
  const Rational squared = l[0] * l[0] + l[1] * l[1];
  Foot foot;
  if (squared > set.half[0] * set.half[0]) {
    const Shrink shrink = ShrinkTo(set.half[0], squared, bits);
    l[0] *= shrink.factor;
    l[1] *= shrink.factor;
    foot.error = shrink.error;
  }
  l[2] = std::clamp(l[2], Rational(-set.half[2]), set.half[2]);
  foot.y = FromFrame(set, l);
  return foot;
}

}  // namespace

Rational ContactSets::Skin(int body, int object) const {
  const auto& listed = model.contact.may_touch;
  const bool touches = std::binary_search(listed.begin(), listed.end(), std::pair(body, object));
  return touches ? Lift(model.contact.skin) : Rational(0);
}

Root RootOf(const Rational& x, int bits) {
  if (mpz_perfect_square_p(x.get_num_mpz_t()) && mpz_perfect_square_p(x.get_den_mpz_t())) {
    mpz_class num, den;
    mpz_sqrt(num.get_mpz_t(), x.get_num_mpz_t());
    mpz_sqrt(den.get_mpz_t(), x.get_den_mpz_t());
    const Rational root(num, den);
    return {root, root};
  }
  return {SqrtDown(x, bits), SqrtUp(x, bits)};
}

Sign CompareRoots(const Rational& a, const Rational& b, const Rational& m) {
  if (m < 0) return -CompareRoots(b, a, -m);
  // Both sides of sqrt(a) against sqrt(b) + m are >= 0 and may be squared.
  return CompareWithRoot(a - b - m * m, 2 * m, b);
}

Rational DirectionError(const Vector3q& w, const Rational& error) {
  if (error == 0) return 0;
  const Rational length = SqrtDown(SquaredNorm(w));
  if (length <= error) return 2;
  return 2 * error / (2 * length - error);
}

Foot ClosestPoint(const ConvexSet& set, const Vector3q& z, int bits) {
  switch (set.kind) {
    case SetKind::kHalfspace:
      return {ClosestOnHalfspace(set.normal, set.offset, z)};
    case SetKind::kBox:
      return {FromFrame(set, ClosestOnBox(set.half, ToFrame(set, z)))};
    case SetKind::kCylinder:
      return FootOnCylinder(set, z, bits);
    case SetKind::kPoints:
    case SetKind::kTriangle:
      break;
  }
  const Vector3q core = CoreFoot(set, z), v = z - core;
  if (set.radius == 0) return {core};
  const Rational squared = SquaredNorm(v);
  if (squared <= set.radius * set.radius) return {z};
  const Shrink shrink = ShrinkTo(set.radius, squared, bits);
  return {core + Scaled(shrink.factor, v), shrink.error};
}

Sign Candidate::Compare(const Rational& bound) const {
  return sign > 0 ? -CompareWithRoot(inset + bound, 1, squared)
                  : CompareWithRoot(-(inset + bound), 1, squared);
}

namespace {

/** Fields that every candidate has. */
Candidate Start(const ConvexSet& set, const PlacedSite& site) {
  Candidate c;
  c.set = &set;
  c.error_y = c.error_w = c.error_d = site.error;
  return c;
}

/** The least depth of x under the planes of a hull exceeds `error`: no truth is outside. */
bool DeepInHull(const ConvexSet& set, const Vector3q& x, const Rational& error) {
  if (set.faces.empty() || set.radius != 0) return false;
  return std::all_of(set.faces.begin(), set.faces.end(), [&](const std::array<int, 3>& f) {
    const Vector3q& a = set.points[f[0]];
    const Vector3q n = Cross(set.points[f[1]] - a, set.points[f[2]] - a);
    return CompareWithRoot(Dot(n, a - x), error, SquaredNorm(n)) == Sign::kPositive;
  });
}

void ApproachHalfspace(const PlacedSite& site, Candidate* c) {
  const ConvexSet& set = *c->set;
  const Rational excess = Dot(set.normal, site.x) - set.offset, nn = SquaredNorm(set.normal);
  c->sign = excess < 0 ? -1 : 1;
  c->squared = excess * excess / nn;
  c->w = set.normal;
  c->error_w = 0;
  c->y = site.x - Scaled(excess / nn, set.normal);
}

void ApproachPoints(const PlacedSite& site, int bits, Candidate* c, bool* inside) {
  const ConvexSet& set = *c->set;
  const Vector3q core = CoreFoot(set, site.x);
  c->w = site.x - core;
  c->squared = SquaredNorm(c->w);
  c->inset = set.radius;
  c->y = core;
  *inside = DeepInHull(set, site.x, site.error) || c->SurelyBelow(0);
  if (set.radius == 0 || c->squared == 0) return;
  // The boundary point along w: a projection, hence 1-Lipschitz, where x is outside.
  const Shrink shrink = ShrinkTo(set.radius, c->squared, bits);
  c->y = core + Scaled(shrink.factor, c->w);
  c->error_y += shrink.error;
  if (!c->SurelyAbove(0)) c->error_y += set.radius * DirectionError(c->w, site.error);
}

/** x is over a single face of a box, up to its error: where the true x is outside it is over the
 same one, so its normal has no error. */
bool ApproachBoxFace(const ConvexSet& set, const Vector3q& l, const Rational& error, Candidate* c) {
  int face = -1;
  for (int k = 0; k < 3; ++k) {
    if (abs(l[k]) + error <= set.half[k]) continue;
    if (face >= 0 || set.half[k] <= error) return false;
    face = k;
  }
  if (face < 0) return false;
  const Rational excess = std::max(Rational(abs(l[face]) - set.half[face]), Rational(0));
  c->w = Scaled(Rational(sgn(l[face])), set.X.R.col(face));
  c->error_w = 0;
  c->squared = excess * excess;
  return true;
}

void ApproachBox(const PlacedSite& site, Candidate* c, bool* inside) {
  const ConvexSet& set = *c->set;
  const Vector3q l = ToFrame(set, site.x), clamped = ClosestOnBox(set.half, l);
  c->y = FromFrame(set, clamped);
  *inside = true;
  for (int k = 0; k < 3; ++k) *inside = *inside && abs(l[k]) + site.error < set.half[k];
  if (ApproachBoxFace(set, l, site.error, c)) return;
  c->w = site.x - c->y;
  c->squared = SquaredNorm(c->w);
}

void ApproachCylinder(const PlacedSite& site, int bits, Candidate* c, bool* inside) {
  const ConvexSet& set = *c->set;
  const Rational &e = site.error, &R = set.half[0], &h = set.half[2];
  const Vector3q l = ToFrame(set, site.x);
  const Rational squared = l[0] * l[0] + l[1] * l[1], height = abs(l[2]);
  const Foot foot = FootOnCylinder(set, site.x, bits);
  c->y = foot.y;
  c->error_y += foot.error;
  const bool in_disc = R >= e && squared <= (R - e) * (R - e), in_height = height + e <= h;
  *inside = R > e && squared < (R - e) * (R - e) && height + e < h;
  if (in_disc && height >= h && h > e) {  // over a cap
    c->w = Scaled(Rational(sgn(l[2])), set.X.R.col(2));
    c->error_w = 0;
    c->squared = (height - h) * (height - h);
  } else if (in_height && squared >= R * R) {  // beside the mantle: d = |radial part| - R
    c->w = Transformed(set.X.R, Vector3q{l[0], l[1], Rational(0)});
    c->squared = squared;
    c->inset = R;
  } else {
    c->w = site.x - foot.y;
    c->squared = SquaredNorm(c->w);
    c->error_w += foot.error;
    c->error_d += foot.error;
  }
}

}  // namespace

Candidate Approach(const ConvexSet& set, const PlacedSite& site, int bits, bool* inside) {
  Candidate c = Start(set, site);
  *inside = false;
  if (set.kind == SetKind::kHalfspace) {
    ApproachHalfspace(site, &c);
  } else if (set.kind == SetKind::kBox) {
    ApproachBox(site, &c, inside);
  } else if (set.kind == SetKind::kCylinder) {
    ApproachCylinder(site, bits, &c, inside);
  } else {
    ApproachPoints(site, bits, &c, inside);
  }
  if (IsZero(c.w)) {  // x lies in the set as placed: any normal
    c.w = {0, 0, 1};
    c.error_w = 2;
  }
  return c;
}

}  // namespace internal

ContactScene::ContactScene(const Model& model) {
  Require(model.contact.model == ContactModel::kSites,
          "exact contacts are those of sites, not of nearest pairs");
  auto sets = std::make_shared<internal::ContactSets>();
  sets->model = model;
  internal::Collector collector(sets.get());
  for (std::size_t i = 0; i < model.objects.size(); ++i) {
    for (const Piece& piece : model.objects[i].pieces) collector.Add(static_cast<int>(i), piece);
  }
  for (const Link& link : model.robot.links) {
    auto& shapes = sets->links.emplace_back();
    if (model.contact.skin == 0) continue;
    for (const LinkShape& shape : link.shapes) {
      shapes.push_back(Moved(Bracket(shape.geometry, 32), ExactPlacement(shape.X_LS)));
    }
  }
  sets_ = std::move(sets);
}

}  // namespace cguide::exact
