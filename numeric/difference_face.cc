#include <algorithm>
#include <vector>

#include "cguide/numeric/difference_face_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

// The filter. u = kUnit; all operations round once. A Bounded holds a computed vector and m with
// |exact component| <= m and |computed component| <= m, up to factors 1 + O(u), and its error is
// measured as a multiple of u m, component by component:
//   difference of two points            1      rounded once; blur m covers points that are rounded
//   e = difference of two of those      2.1    1 + the subtraction
//   x * y, of errors p and q            p + q + 2.1   two products, one subtraction, each within
//                                              u(1 + O(u)) of m_x m_y; M sums both products
//   n of three corners, e x e           6.3
//   n of two, e x (w_0 x e)             2.1 + (1 + 2.1 + 2.1) + 2.1 = 9.4
//   n of one                            1
//   n . d, of errors p and q            p + q + 3.1   times u sum m_n m_d
// The largest sums: n of two corners with d: 9.4 + 2.1 + 3.1 = 14.6; n of three with w x w
// (1 + 1 + 2.1 = 4.1): 6.3 + 4.1 + 3.1 = 13.5; w.(w x w): 8.2. All are below 15, and the relative
// errors of the bound itself, below 30 u, leave them below kFactor. Underflow: each of fewer than
// 100 products can lose 2^-1075, later multiplied by at most three factors below 2^63: less than
// 2^-860. Overflow: coordinates <= 2^60 give products below 2^400.
constexpr double kFactor = 16 * kUnit;
constexpr double kUnderflow = 0x1p-860;

Bounded Difference(const Vector3d& p, const Vector3d& q, double blur) {
  const Vector3d d = p - q;
  return {d, d.cwiseAbs().array() + blur};
}

Bounded Minus(const Bounded& p, const Bounded& q) {
  return {p.value - q.value, p.magnitude + q.magnitude};
}

Vector3d CrossOfMagnitudes(const Vector3d& p, const Vector3d& q) {
  return {p[1] * q[2] + p[2] * q[1], p[2] * q[0] + p[0] * q[2], p[0] * q[1] + p[1] * q[0]};
}

Vector3d Cross(const Vector3d& p, const Vector3d& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

Bounded Cross(const Bounded& p, const Bounded& q) {
  return {Cross(p.value, q.value), CrossOfMagnitudes(p.magnitude, q.magnitude)};
}

Bounded Negated(const Bounded& p) { return {-p.value, p.magnitude}; }

// The sign of p.q, 0 where the bound does not carry it (NaN included).
int FilteredSign(const Bounded& p, const Bounded& q) {
  const double value = p.value.dot(q.value);
  const double bound = kFactor * p.magnitude.dot(q.magnitude) + kUnderflow;
  return value > bound ? 1 : value < -bound ? -1 : 0;
}

}  // namespace

Face::Face(HullPair* hulls, const Simplex& simplex) : hulls_(hulls), simplex_(simplex) {
  for (int k = 0; k < simplex.size; ++k) {
    const auto& [i, j] = simplex.corners[k];
    w_[k] = Difference(hulls->a.points[i], hulls->b.points[j], hulls->blur);
  }
  const auto& [i0, j0] = simplex.corners[0];
  for (int k = 1; k < simplex.size; ++k) {
    const auto& [i, j] = simplex.corners[k];
    // Differences within one set keep an edge shared by both corners exact, near contact too.
    if (j == j0) {
      e_[k - 1] = Difference(hulls->a.points[i], hulls->a.points[i0], hulls->blur);
    } else if (i == i0) {
      e_[k - 1] = Difference(hulls->b.points[j0], hulls->b.points[j], hulls->blur);
    } else {
      e_[k - 1] = Minus(Difference(hulls->a.points[i], hulls->a.points[i0], hulls->blur),
                        Difference(hulls->b.points[j], hulls->b.points[j0], hulls->blur));
    }
  }
}

const IntegerFace& Face::Exact() {
  if (!exact_) exact_ = MakeIntegerFace(*hulls_, simplex_);
  return *exact_;
}

bool Face::OrientNormal() {
  if (simplex_.size == 1) n_ = w_[0];
  if (simplex_.size == 2) n_ = Cross(e_[0], Cross(w_[0], e_[0]));
  if (simplex_.size == 3) n_ = Cross(e_[0], e_[1]);
  int sign = hulls_->filter ? FilteredSign(n_, w_[0]) : 0;
  if (sign == 0) {
    ++hulls_->exact_signs;
    if (Exact().divisor == 0) return false;
    meets_ = Exact().height == 0;
    sign = Exact().flipped ? -1 : 1;
  }
  if (sign < 0 && simplex_.size == 3) {
    n_ = Negated(n_);
    std::swap(w_[1], w_[2]);  // and with them the weights below: they keep n = e_1 x e_2
  }
  return true;
}

bool Face::WeightsNonNegative() {
  if (simplex_.size == 1) return true;
  bool certain = hulls_->filter;
  const auto positive = [&](const Bounded& p, const Bounded& q) {
    const int sign = certain ? FilteredSign(p, q) : 0;
    certain = certain && sign != 0;
    return sign >= 0;
  };
  if (simplex_.size == 2) {
    if (!positive(e_[0], w_[1]) || !positive(Negated(e_[0]), w_[0])) return false;
  } else {
    if (!positive(n_, Cross(w_[1], w_[2])) || !positive(n_, Cross(w_[2], w_[0])) ||
        !positive(n_, Cross(w_[0], w_[1]))) {
      return false;
    }
  }
  if (certain) return true;
  ++hulls_->exact_signs;
  const std::array<mpz_class, 4> weights = IntegerWeights(Exact());
  return std::all_of(weights.begin(), weights.end(), [](const mpz_class& x) { return x >= 0; });
}

// The origin is the combination of the four corners with the weights w_1.(w_2 x w_3) ...; inside
// where they have one sign.
bool Face::HoldsOrigin() {
  meets_ = true;
  if (hulls_->filter) {
    const Bounded low = Cross(w_[2], w_[3]), high = Cross(w_[0], w_[1]);
    const int signs[4] = {FilteredSign(w_[1], low), -FilteredSign(w_[0], low),
                          FilteredSign(w_[3], high), -FilteredSign(w_[2], high)};
    const auto [least, greatest] = std::minmax_element(signs, signs + 4);
    if (*least * *greatest < 0) return false;
    if (*least * *greatest > 0) return true;
  }
  ++hulls_->exact_signs;
  const std::array<mpz_class, 4> weights = IntegerWeights(Exact());
  mpz_class sum = 0;
  for (const mpz_class& x : weights) {
    if (x < 0) return false;
    sum += x;
  }
  return sum > 0;
}

bool Face::HoldsNearest() {
  if (simplex_.size == 4) return HoldsOrigin();
  return OrientNormal() && WeightsNonNegative();
}

// n.w is the same for all corners, so n.(a_i - a_i0) = n.(b_j - b_j0); where one index is shared
// with a corner already known, the other term is zero without arithmetic.
void Face::MarkKnownTies(std::array<bool, 4>* of_a, std::array<bool, 4>* of_b) const {
  const auto equal = [this](int Corner::*side, int k, int l) {
    return simplex_.corners[k].*side == simplex_.corners[l].*side;
  };
  (*of_a)[0] = (*of_b)[0] = true;
  for (int round = 0; round < 2; ++round) {
    for (int k = 1; k < simplex_.size; ++k) {
      for (int l = 0; l < simplex_.size; ++l) {
        if ((*of_a)[l] && equal(&Corner::i, k, l)) (*of_a)[k] = true;
        if ((*of_b)[l] && equal(&Corner::j, k, l)) (*of_b)[k] = true;
      }
      if ((*of_a)[k] || (*of_b)[k]) (*of_a)[k] = (*of_b)[k] = true;
    }
  }
}

// The points of one set that may lie beyond the plane through the first corner: all but those that
// a bound for the whole set, kFactor times its largest magnitude, keeps inside it.
void Face::CollectNear(const PointSet& set, const Bounded& n, const Vector3d& origin,
                       std::vector<int>* near) const {
  const Vector3d farness = set.lanes->Farness(origin).array() + hulls_->blur;
  const double bound = kFactor * n.magnitude.dot(farness) * (1 + 8 * kUnit) + kUnderflow;
  if (hulls_->filter) {
    set.lanes->CollectWithin(origin, n.value, bound, near);
  } else {
    for (int i = 0; i < set.lanes->size(); ++i) near->push_back(i);
  }
}

// Index of a point of A with n.(a_i - a_i0) < 0, or of B with n.(b_j - b_j0) > 0, the farthest one
// as far as doubles can tell; -1 where there is none.
int Face::Beyond(bool of_b, const std::array<bool, 4>& known) {
  const PointSet& set = of_b ? hulls_->b : hulls_->a;
  const auto index_of = [&](int k) { return of_b ? simplex_.corners[k].j : simplex_.corners[k].i; };
  const Vector3d& origin = set.points[index_of(0)];
  const Bounded n = of_b ? Negated(n_) : n_;
  std::vector<int> near, ties;
  CollectNear(set, n, origin, &near);
  int beyond = -1;
  double lowest = 0;
  for (const int i : near) {
    bool settled = false;
    for (int k = 0; k < simplex_.size; ++k) settled |= known[k] && index_of(k) == i;
    if (settled) continue;
    const Bounded d = Difference(set.points[i], origin, hulls_->blur);
    const int sign = hulls_->filter ? FilteredSign(n, d) : 0;
    if (sign == 0) ties.push_back(i);
    if (sign >= 0) continue;
    const double value = n.value.dot(d.value);
    if (value < lowest) beyond = i, lowest = value;
  }
  if (beyond >= 0) return beyond;
  for (const int i : ties) {
    ++hulls_->exact_signs;
    const int sign = sgn(Dot(Exact().n, IntegerDifference(*hulls_, of_b, i, index_of(0))));
    if ((of_b ? -sign : sign) < 0) return i;
  }
  return -1;
}

std::optional<Corner> Face::Violator() {
  std::array<bool, 4> known_a{}, known_b{};
  MarkKnownTies(&known_a, &known_b);
  const int i = Beyond(false, known_a), j = Beyond(true, known_b);
  if (i < 0 && j < 0) return std::nullopt;
  return Corner{i < 0 ? simplex_.corners[0].i : i, j < 0 ? simplex_.corners[0].j : j};
}

}  // namespace cguide::numeric
