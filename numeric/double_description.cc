#include "cguide/numeric/double_description.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>

namespace cguide::numeric {
namespace {

// The half-spaces whose plane holds a ray, as bits.
class PlaneSet {
 public:
  explicit PlaneSet(int words = 0) : words_(words, 0) {}
  void Add(int i) { words_[i / 64] |= std::uint64_t{1} << (i % 64); }
  static int CountCommon(const PlaneSet& a, const PlaneSet& b) {
    int count = 0;
    for (std::size_t w = 0; w < a.words_.size(); ++w) {
      count += std::popcount(a.words_[w] & b.words_[w]);
    }
    return count;
  }
  void SetCommon(const PlaneSet& a, const PlaneSet& b) {
    words_.resize(a.words_.size());
    for (std::size_t w = 0; w < words_.size(); ++w) words_[w] = a.words_[w] & b.words_[w];
  }
  bool Contains(const PlaneSet& other) const {
    std::uint64_t missing = 0;
    for (std::size_t w = 0; w < words_.size(); ++w) missing |= other.words_[w] & ~words_[w];
    return missing == 0;
  }

 private:
  std::vector<std::uint64_t> words_;
};

struct Ray {
  Vector6d y;
  PlaneSet planes;
  std::vector<int> adjacent;  ///< indices of rays that span a 2-face with this one
  double value = 0;           ///< y.a for the half-space being added
};

// The polar cone { y : y.a <= 0 for the generators added so far } = lines + cone(rays), rays
// extreme modulo the lines.
class PolarCone {
 public:
  PolarCone(std::span<const Vector6d> generators, double tolerance)
      : generators_(generators),
        tolerance_(tolerance),
        num_words_(1 + int(generators.size()) / 64) {
    for (int i = 0; i < 6; ++i) lines_.push_back(Vector6d::Unit(i));
  }

  void AddHalfspace(int i);
  ConeFacets Result() const;

 private:
  void CutLine(std::size_t line, int i, const Vector6d& a);
  void CutRays(int i);
  void Replace(int p, int q, int i);
  void ConnectOnPlane(const std::vector<int>& on_plane);
  void Compact();

  const std::span<const Vector6d> generators_;
  const double tolerance_;
  const int num_words_;
  std::vector<Vector6d> lines_;  // orthonormal
  std::vector<int> added_;
  std::vector<Ray> rays_;
};

void PolarCone::AddHalfspace(int i) {
  const Vector6d a = generators_[i].normalized();
  std::size_t line = lines_.size();
  double largest = tolerance_;
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    if (std::abs(lines_[l].dot(a)) > largest) {
      largest = std::abs(lines_[l].dot(a));
      line = l;
    }
  }
  if (line < lines_.size()) {
    CutLine(line, i, a);
  } else {
    for (Ray& ray : rays_) {
      ray.value = ray.y.dot(a);
      if (std::abs(ray.value) <= tolerance_) ray.value = 0;
    }
    CutRays(i);
  }
  added_.push_back(i);
}

// A line crosses the plane: one direction of the lineality space is lost and becomes a ray,
// everything else slides along it into the plane. The new ray lies in all earlier planes, and the
// cone is now a pyramid over what it was, so the ray is adjacent to all others.
void PolarCone::CutLine(std::size_t line, int i, const Vector6d& a) {
  // With orthonormal lines the projection of a onto their span is what crosses the plane; turning
  // the basis so that one line is along it leaves the others in the plane.
  Vector6d along = Vector6d::Zero();
  for (const Vector6d& l : lines_) along += l.dot(a) * l;
  along.normalize();
  lines_.erase(lines_.begin() + line);
  std::vector<Vector6d> rest;
  for (Vector6d l : lines_) {
    for (int pass = 0; pass < 2; ++pass) {
      l -= l.dot(along) * along;
      for (const Vector6d& r : rest) l -= l.dot(r) * r;
      l.normalize();
    }
    rest.push_back(l);
  }
  lines_ = std::move(rest);
  Ray ray{-along, PlaneSet(num_words_), {}, 0};
  for (const int plane : added_) ray.planes.Add(plane);
  const double slope = along.dot(a);
  for (Ray& other : rays_) {
    other.y -= (other.y.dot(a) / slope) * along;
    other.y.normalize();
    other.planes.Add(i);
    other.adjacent.push_back(static_cast<int>(rays_.size()));
    ray.adjacent.push_back(static_cast<int>(ray.adjacent.size()));
  }
  rays_.push_back(std::move(ray));
}

// Puts a ray into the plane, on the 2-face of p (outside) and q (inside). The new ray is adjacent
// to q; the others on the plane follow in ConnectOnPlane. Rays strictly inside keep their
// adjacencies: the smallest face that holds two of them does not lie in the new plane, and cutting
// it keeps its dimension.
void PolarCone::Replace(int p, int q, int i) {
  Ray ray{rays_[p].value * rays_[q].y - rays_[q].value * rays_[p].y, PlaneSet(), {q}, 0};
  ray.y.normalize();
  ray.planes.SetCommon(rays_[p].planes, rays_[q].planes);
  ray.planes.Add(i);
  *std::find(rays_[q].adjacent.begin(), rays_[q].adjacent.end(), p) =
      static_cast<int>(rays_.size());
  rays_.push_back(std::move(ray));
}

void PolarCone::CutRays(int i) {
  std::vector<int> outside, on_plane;
  for (int r = 0; r < static_cast<int>(rays_.size()); ++r) {
    if (rays_[r].value > 0) outside.push_back(r);
    if (rays_[r].value == 0) {
      rays_[r].planes.Add(i);
      on_plane.push_back(r);
    }
  }
  if (outside.empty()) return;
  for (const int p : outside) {
    // Replace appends to rays_, which may move rays_[p].
    for (std::size_t k = 0; k < rays_[p].adjacent.size(); ++k) {
      const int q = rays_[p].adjacent[k];
      if (rays_[q].value >= 0) continue;
      on_plane.push_back(static_cast<int>(rays_.size()));
      Replace(p, q, i);
    }
  }
  ConnectOnPlane(on_plane);
  Compact();
}

// Two rays of the plane are adjacent iff no third ray lies in all planes they share; such a third
// ray would lie in the new plane too, so only those are asked. Adjacent rays share at least d - 2
// planes, d the dimension of the pointed part, unless planes repeat, which only adds to the count.
void PolarCone::ConnectOnPlane(const std::vector<int>& on_plane) {
  const int needed = 6 - static_cast<int>(lines_.size()) - 2;
  PlaneSet common(num_words_);
  for (std::size_t i = 0; i < on_plane.size(); ++i) {
    for (std::size_t j = i + 1; j < on_plane.size(); ++j) {
      Ray &a = rays_[on_plane[i]], &b = rays_[on_plane[j]];
      if (PlaneSet::CountCommon(a.planes, b.planes) < needed) continue;
      if (std::find(a.adjacent.begin(), a.adjacent.end(), on_plane[j]) != a.adjacent.end())
        continue;
      common.SetCommon(a.planes, b.planes);
      const bool third = std::any_of(on_plane.begin(), on_plane.end(), [&](int r) {
        return r != on_plane[i] && r != on_plane[j] && rays_[r].planes.Contains(common);
      });
      if (third) continue;
      a.adjacent.push_back(on_plane[j]);
      b.adjacent.push_back(on_plane[i]);
    }
  }
}

void PolarCone::Compact() {
  std::vector<int> moved(rays_.size(), -1);
  int kept = 0;
  for (std::size_t r = 0; r < rays_.size(); ++r) {
    if (rays_[r].value > 0) continue;
    moved[r] = kept;
    if (static_cast<int>(r) != kept) rays_[kept] = std::move(rays_[r]);
    ++kept;
  }
  rays_.resize(kept);
  for (Ray& ray : rays_) {
    std::size_t size = 0;
    for (const int r : ray.adjacent) {
      if (moved[r] >= 0) ray.adjacent[size++] = moved[r];
    }
    ray.adjacent.resize(size);
  }
}

ConeFacets PolarCone::Result() const {
  ConeFacets result;
  result.equations = lines_;
  result.facets.reserve(rays_.size());
  for (const Ray& ray : rays_) result.facets.push_back(ray.y);
  return result;
}

}  // namespace

ConeFacets DualDescription(std::span<const Vector6d> generators, const DualOptions& options) {
  std::vector<int> order(generators.size());
  std::iota(order.begin(), order.end(), 0);
  std::mt19937_64 rng(1953);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[rng() % i]);
  PolarCone cone(generators, options.tolerance);
  for (const int i : order) {
    if (generators[i].norm() > 0) cone.AddHalfspace(i);
  }
  return cone.Result();
}

double FacetExcess(const ConeFacets& cone, const Vector6d& v) {
  double excess = -std::numeric_limits<double>::infinity();
  for (const Vector6d& h : cone.facets) excess = std::max(excess, h.dot(v));
  for (const Vector6d& e : cone.equations) excess = std::max(excess, std::abs(e.dot(v)));
  return excess;
}

}  // namespace cguide::numeric
