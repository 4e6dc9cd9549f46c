#include <Eigen/Geometry>
#include <algorithm>

#include "cguide/numeric/gjk_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

constexpr int kMaxIterations = 96;

// A face of the simplex that may hold its closest point to the origin: members and weights.
struct Candidate {
  double squared = INFINITY;
  int size = 0;
  int index[4] = {0, 0, 0, 0};
  double weight[4] = {0, 0, 0, 0};
};

Vector3d Combine(const DifferencePoint* s, const Candidate& c) {
  Vector3d v = Vector3d::Zero();
  for (int i = 0; i < c.size; ++i) v += c.weight[i] * s[c.index[i]].w;
  return v;
}

void Offer(const DifferencePoint* s, Candidate c, Candidate* best) {
  c.squared = Combine(s, c).squaredNorm();
  if (c.squared < best->squared) *best = c;
}

void OfferVertex(const DifferencePoint* s, int i, Candidate* best) {
  Offer(s, {0, 1, {i, 0, 0, 0}, {1, 0, 0, 0}}, best);
}

void OfferEdge(const DifferencePoint* s, int i, int j, Candidate* best) {
  const Vector3d e = s[j].w - s[i].w;
  const double along = -e.dot(s[i].w), length = e.squaredNorm();
  if (!(along > 0) || !(along < length)) return;
  const double t = along / length;
  Offer(s, {0, 2, {i, j, 0, 0}, {1 - t, t, 0, 0}}, best);
}

// The origin's barycentric coordinates in the triangle's plane, each computed by the edge normal
// form, offered where all are positive.
void OfferTriangle(const DifferencePoint* s, int i, int j, int k, Candidate* best) {
  const Vector3d &a = s[i].w, &b = s[j].w, &c = s[k].w;
  const Vector3d n = (b - a).cross(c - a);
  const double wa = n.dot(b.cross(c)), wb = n.dot(c.cross(a)), wc = n.dot(a.cross(b));
  if (!(wa > 0) || !(wb > 0) || !(wc > 0)) return;
  const double sum = wa + wb + wc;
  Offer(s, {0, 3, {i, j, k, 0}, {wa / sum, wb / sum, wc / sum, 0}}, best);
}

// Offers the origin itself as a combination of all four points where it is inside the tetrahedron
// in plain floats; flat ones never qualify.
bool InsideTetrahedron(const DifferencePoint* s, Candidate* inside) {
  const Vector3d a = s[1].w - s[0].w, b = s[2].w - s[0].w, c = s[3].w - s[0].w;
  const double volume = a.dot(b.cross(c));
  const double scale = a.norm() * b.norm() * c.norm();
  if (!(std::abs(volume) > 1e-13 * scale)) return false;
  const double sign = volume < 0 ? -1 : 1;
  const Vector3d &p = s[0].w, &q = s[1].w, &r = s[2].w, &t = s[3].w;
  const double weight[4] = {sign * q.dot(r.cross(t)), sign * p.dot(t.cross(r)),
                            sign * p.dot(q.cross(t)), sign * p.dot(r.cross(q))};
  const double sum = weight[0] + weight[1] + weight[2] + weight[3];
  if (*std::min_element(weight, weight + 4) < 0 || !(sum > 0)) return false;
  *inside = {
      0, 4, {0, 1, 2, 3}, {weight[0] / sum, weight[1] / sum, weight[2] / sum, weight[3] / sum}};
  return true;
}

// The best of the faces that hold the newest point: the point nearest to the origin has left the
// old simplex, because the newest one is strictly on the origin's side of it. No region is ruled
// out beforehand, so a flat simplex does no harm.
Candidate ClosestNewFace(const DifferencePoint* s, int n) {
  Candidate best;
  const int last = n - 1;
  OfferVertex(s, last, &best);
  for (int i = 0; i < last; ++i) OfferEdge(s, i, last, &best);
  for (int i = 0; i < last; ++i) {
    for (int j = i + 1; j < last; ++j) OfferTriangle(s, i, j, last, &best);
  }
  return best;
}

// The best of all faces, for when rounding has made the above untrue.
Candidate ClosestFace(const DifferencePoint* s, int n) {
  Candidate best;
  for (int size = 1; size <= n; ++size) {
    const Candidate candidate = ClosestNewFace(s, size);
    if (candidate.squared < best.squared) best = candidate;
  }
  return best;
}

bool Repeated(const GjkResult& r, const DifferencePoint& p) {
  for (int i = 0; i < r.size; ++i) {
    if (r.simplex[i].w == p.w) return true;
  }
  return false;
}

void Reduce(const Candidate& c, GjkResult* r) {
  DifferencePoint kept[4];
  r->v.setZero();
  r->a.setZero();
  r->b.setZero();
  for (int i = 0; i < c.size; ++i) {
    kept[i] = r->simplex[c.index[i]];
    r->v += c.weight[i] * kept[i].w;
    r->a += c.weight[i] * kept[i].a;
    r->b += c.weight[i] * kept[i].b;
  }
  r->size = c.size;
  std::copy(kept, kept + c.size, r->simplex);
}

template <typename Support>
void Iterate(const Support& support, const Vector3d& v0, double tiny, double enough, GjkResult* r) {
  r->v = v0.squaredNorm() > 0 ? v0 : Vector3d::UnitX();
  r->size = 0;
  double best = INFINITY;
  for (r->iterations = 0; r->iterations < kMaxIterations; ++r->iterations) {
    DifferencePoint p;
    support(r->v, &p);
    const double bound = r->v.dot(p.w), squared = r->v.squaredNorm();
    if (bound > 0 && bound * bound > enough * enough * squared) {
      r->separated = true;
      return;
    }
    // v.w = |v|^2 says that no point of A - B is nearer; v0 is no point of A - B, so not at first.
    if (r->size > 0 && (squared - bound <= 2 * kUnit * squared || Repeated(*r, p))) return;
    r->simplex[r->size++] = p;
    Candidate inside;
    if (r->size == 4 && InsideTetrahedron(r->simplex, &inside)) {
      Reduce(inside, r);
      r->overlap = true;
      return;
    }
    Candidate face = ClosestNewFace(r->simplex, r->size);
    if (face.squared >= best) face = ClosestFace(r->simplex, r->size);
    if (r->iterations > 0 && face.squared >= best) {
      r->size -= 1;  // No progress: rounding rules from here. v still belongs to the old simplex.
      return;
    }
    best = face.squared;
    Reduce(face, r);
    if (best <= tiny * tiny) {
      r->overlap = true;
      return;
    }
  }
}

}  // namespace

void Gjk(const Convex& a, const Convex& b, const Vector3d& v0, double enough, GjkResult* r) {
  const Vector3d offset = a.c - b.c;
  const auto support = [&](const Vector3d& v, DifferencePoint* p) {
    p->a = CoreSupport(a, -v);
    p->b = CoreSupport(b, v);
    p->w = offset + p->a - p->b;
  };
  Iterate(support, v0, 4 * kUnit * (offset.norm() + a.reach + b.reach), enough, r);
}

Vector3d SimplexNormal(const GjkResult& gjk) {
  const auto edge = [&gjk](int k) -> Vector3d {
    const DifferencePoint &p = gjk.simplex[0], &q = gjk.simplex[k];
    return (q.a - p.a) - (q.b - p.b);
  };
  if (gjk.size < 2 || gjk.size > 3) return Vector3d::Zero();
  const Vector3d e = edge(1);
  Vector3d n = gjk.size == 3 ? e.cross(edge(2)) : e.cross(gjk.simplex[0].w.cross(e));
  if (n.dot(gjk.simplex[0].w) < 0) n = -n;
  const double length = n.norm();
  return length > 1e-140 ? Vector3d(n / length) : Vector3d(Vector3d::Zero());
}

int Farthest(const PointSet& set, const Vector3d& n) {
  if (set.lanes) return set.lanes->Farthest(n);
  int best = 0;
  double value = -INFINITY;
  for (int i = 0; i < static_cast<int>(set.points.size()); ++i) {
    const double dot = n.dot(set.points[i]);
    if (dot > value) {
      value = dot;
      best = i;
    }
  }
  return best;
}

void Gjk(const PointSet& a, const PointSet& b, const Vector3d& v0, double enough, GjkResult* r) {
  const auto support = [&](const Vector3d& v, DifferencePoint* p) {
    p->i = Farthest(a, -v);
    p->j = Farthest(b, v);
    p->a = a.points[p->i];
    p->b = b.points[p->j];
    p->w = p->a - p->b;
  };
  Iterate(support, v0, 0, enough, r);
}

}  // namespace cguide::numeric
