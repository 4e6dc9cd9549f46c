#include "cguide/exact/cone.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace {

using Vector = std::vector<mpz_class>;

/** Which of the constraints met so far a ray satisfies with equality. */
class ZeroSet {
 public:
  explicit ZeroSet(std::size_t size) : words_((size + 63) / 64) {}
  void Insert(std::size_t i) { words_[i / 64] |= std::uint64_t{1} << i % 64; }
  int Count() const {
    int count = 0;
    for (std::uint64_t w : words_) count += __builtin_popcountll(w);
    return count;
  }
  ZeroSet Intersection(const ZeroSet& other) const {
    ZeroSet result = *this;
    for (std::size_t k = 0; k < words_.size(); ++k) result.words_[k] &= other.words_[k];
    return result;
  }
  bool IsSubsetOf(const ZeroSet& other) const {
    for (std::size_t k = 0; k < words_.size(); ++k) {
      if (words_[k] & ~other.words_[k]) return false;
    }
    return true;
  }

 private:
  std::vector<std::uint64_t> words_;
};

struct Ray {
  Vector x;
  ZeroSet zero;
  mpz_class value;  ///< of the constraint being added
};

mpz_class Dot(const Vector& a, const Vector& b) {
  mpz_class sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void MakePrimitive(Vector* v) {
  mpz_class divisor = 0;
  for (const mpz_class& x : *v) divisor = gcd(divisor, x);
  if (divisor < 2) return;
  for (mpz_class& x : *v) mpz_divexact(x.get_mpz_t(), x.get_mpz_t(), divisor.get_mpz_t());
}

/** s a + t b, primitive. */
Vector Combination(const mpz_class& s, const Vector& a, const mpz_class& t, const Vector& b) {
  Vector result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = s * a[i] + t * b[i];
  MakePrimitive(&result);
  return result;
}

struct Constraint {
  Vector h;
  bool equation = false;
};

/** The double description pair under construction: `rays_` are the extreme rays, modulo `lines_`,
 of the constraints added so far. */
class DoubleDescription {
 public:
  DoubleDescription(int dimension, std::size_t constraints)
      : dimension_(dimension), constraints_(constraints) {
    for (int i = 0; i < dimension; ++i) {
      lines_.emplace_back(dimension, mpz_class(0));
      lines_.back()[i] = 1;
    }
  }

  void Add(const Constraint& constraint) {
    const auto line = std::find_if(lines_.begin(), lines_.end(),
                                   [&](const Vector& l) { return Dot(constraint.h, l) != 0; });
    if (line != lines_.end()) {
      CutLine(constraint, static_cast<std::size_t>(line - lines_.begin()));
    } else {
      CutRays(constraint);
    }
    ++added_;
  }

  std::vector<Vector> TakeRays() {
    std::vector<Vector> result;
    for (Ray& r : rays_) result.push_back(std::move(r.x));
    return result;
  }
  std::vector<Vector> TakeLines() { return std::move(lines_); }

 private:
  /** The constraint halves the line `index`: everything else is moved along that line onto the
   hyperplane h.x = 0, which keeps extreme rays extreme modulo the other lines, and the half-line
   inside becomes a ray. It lies in every earlier constraint's hyperplane. */
  void CutLine(const Constraint& constraint, std::size_t index) {
    Vector cut = std::move(lines_[index]);
    lines_.erase(lines_.begin() + static_cast<std::ptrdiff_t>(index));
    mpz_class slope = Dot(constraint.h, cut);
    if (slope > 0) {
      for (mpz_class& x : cut) x = -x;
      slope = -slope;
    }
    const auto flatten = [&](const Vector& x) {
      return Combination(-slope, x, Dot(constraint.h, x), cut);
    };
    for (Vector& l : lines_) l = flatten(l);
    for (Ray& r : rays_) {
      r.x = flatten(r.x);
      r.zero.Insert(added_);
    }
    if (constraint.equation) return;
    ZeroSet zero(constraints_);
    for (std::size_t k = 0; k < added_; ++k) zero.Insert(k);
    rays_.push_back({std::move(cut), std::move(zero), 0});
  }

  void CutRays(const Constraint& constraint) {
    std::vector<std::size_t> inside, outside;
    for (std::size_t k = 0; k < rays_.size(); ++k) {
      rays_[k].value = Dot(constraint.h, rays_[k].x);
      if (rays_[k].value < 0) inside.push_back(k);
      if (rays_[k].value > 0) outside.push_back(k);
      if (rays_[k].value == 0) rays_[k].zero.Insert(added_);
    }
    std::vector<Ray> born;
    for (std::size_t p : outside) {
      for (std::size_t n : inside) {
        if (!Adjacent(p, n)) continue;
        const Ray &out = rays_[p], &in = rays_[n];
        Ray ray{Combination(out.value, in.x, -in.value, out.x), out.zero.Intersection(in.zero), 0};
        ray.zero.Insert(added_);
        born.push_back(std::move(ray));
      }
    }
    std::erase_if(
        rays_, [&](const Ray& r) { return r.value > 0 || (constraint.equation && r.value < 0); });
    for (Ray& ray : born) rays_.push_back(std::move(ray));
  }

  /** Two extreme rays span a face of dimension two iff no third ray lies in all the hyperplanes
   that hold both [Fukuda, Prodon 1996, Prop. 7]. Such a face needs at least dimension - lines - 2
   of them, which rules out most pairs at once. */
  bool Adjacent(std::size_t p, std::size_t n) const {
    const ZeroSet common = rays_[p].zero.Intersection(rays_[n].zero);
    if (common.Count() < dimension_ - static_cast<int>(lines_.size()) - 2) return false;
    for (std::size_t k = 0; k < rays_.size(); ++k) {
      if (k != p && k != n && common.IsSubsetOf(rays_[k].zero)) return false;
    }
    return true;
  }

  int dimension_;
  std::size_t constraints_;
  std::size_t added_ = 0;
  std::vector<Vector> lines_;
  std::vector<Ray> rays_;
};

Vector ToIntegers(const VectorXq& v, int dimension) {
  Require(v.size() == dimension, "every vector of a cone must have its dimension");
  const VectorXq primitive = Primitive(v);
  Vector result;
  for (const Rational& x : primitive) result.push_back(x.get_num());
  return result;
}

VectorXq ToRationals(const Vector& v) {
  VectorXq result(static_cast<Eigen::Index>(v.size()));
  for (std::size_t i = 0; i < v.size(); ++i) result[static_cast<Eigen::Index>(i)] = v[i];
  return result;
}

std::size_t Pivot(const Vector& v) {
  std::size_t k = 0;
  while (v[k] == 0) ++k;
  return k;
}

/** Clears coordinate `pivot` of v with the line, keeping v's direction modulo lines. */
void ReduceBy(const Vector& line, std::size_t pivot, Vector* v) {
  if ((*v)[pivot] == 0) return;
  const int sign = sgn(line[pivot]);
  *v = Combination(sign * line[pivot], *v, -sign * (*v)[pivot], line);
}

/** Brings independent lines to primitive reduced row echelon form, in place. */
void Echelon(std::vector<Vector>* lines) {
  for (std::size_t k = 0; k < lines->size(); ++k) {
    // The next pivot row is the one whose first non-zero coordinate comes first.
    const auto next =
        std::min_element(lines->begin() + static_cast<std::ptrdiff_t>(k), lines->end(),
                         [](const Vector& a, const Vector& b) { return Pivot(a) < Pivot(b); });
    std::swap((*lines)[k], *next);
    const std::size_t pivot = Pivot((*lines)[k]);
    if ((*lines)[k][pivot] < 0) {
      for (mpz_class& x : (*lines)[k]) x = -x;
    }
    for (std::size_t i = 0; i < lines->size(); ++i) {
      if (i != k) ReduceBy((*lines)[k], pivot, &(*lines)[i]);
    }
  }
}

/** Rays and lines of { x : h.x <= 0 or = 0 }, canonical. */
std::pair<std::vector<VectorXq>, std::vector<VectorXq>> Solve(
    int dimension, const std::vector<VectorXq>& inequalities,
    const std::vector<VectorXq>& equations) {
  Require(dimension >= 1, "a cone needs a space of at least one dimension");
  DoubleDescription pair(dimension, inequalities.size() + equations.size());
  for (const VectorXq& e : equations) pair.Add({ToIntegers(e, dimension), true});
  for (const VectorXq& h : inequalities) pair.Add({ToIntegers(h, dimension), false});
  std::vector<Vector> rays = pair.TakeRays(), lines = pair.TakeLines();
  Echelon(&lines);
  for (Vector& ray : rays) {
    for (const Vector& line : lines) ReduceBy(line, Pivot(line), &ray);
    MakePrimitive(&ray);
  }
  std::sort(rays.begin(), rays.end());
  std::pair<std::vector<VectorXq>, std::vector<VectorXq>> result;
  for (const Vector& ray : rays) result.first.push_back(ToRationals(ray));
  for (const Vector& line : lines) result.second.push_back(ToRationals(line));
  return result;
}

}  // namespace

GeneratorCone GeneratorsOf(const HalfspaceCone& cone) {
  auto [rays, lines] = Solve(cone.dimension, cone.facets, cone.equations);
  return {cone.dimension, std::move(rays), std::move(lines)};
}

HalfspaceCone FacetsOf(const GeneratorCone& cone) {
  auto [rays, lines] = Solve(cone.dimension, cone.rays, cone.lines);
  return {cone.dimension, std::move(rays), std::move(lines)};
}

GeneratorCone Minimal(const GeneratorCone& cone) { return GeneratorsOf(FacetsOf(cone)); }

Sign Side(const HalfspaceCone& cone, const VectorXq& v) {
  Sign worst = cone.equations.empty() ? Sign::kNegative : Sign::kZero;
  for (const VectorXq& e : cone.equations) {
    if (Dot(e, v) != 0) return Sign::kPositive;
  }
  for (const VectorXq& h : cone.facets) worst = std::max(worst, SignOf(Dot(h, v)));
  return worst;
}

}  // namespace cguide::exact
