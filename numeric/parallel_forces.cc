#include <algorithm>
#include <cmath>

#include "cguide/numeric/round_cones_internal.h"

// Forces lambda_i f along the weight f balance it where the line of f through the centre of mass
// meets the hull of the points of contact, all within f's reach: the oldest criterion of all, and
// on even ground with one coefficient the only one. Here it decides over integers what it can, and
// declines the rest.
//
// With c_i = r_i x f the wrench of f at i is (f, c_i), and v = (f, 0) is the combination with
// weights lambda iff sum lambda_i = 1 and sum lambda_i c_i = 0: whether the origin is in the hull
// of the c_i, which lie in the plane across f. Two coordinates of them tell.
//
// Inside, all at forces in the interior of their cones: v is interior. Each lambda f is split into
// three forces around f that are admissible too; those at three points off a line span R^6.
// On an edge of the hull, and outside it: the torque about the line through the two contacts of the
// edge sees nothing of them. Where f is on or beyond the boundary of the cones: the plane that
// touches the cone there, as y = (h, 0).
namespace cguide::numeric {
namespace {

using exact::StabilityReason;
using exact::StabilityResult;

struct Point {
  int contact = -1;
  mpz_class x, y;

  bool is_zero() const { return x == 0 && y == 0; }
  mpz_class size() const { return abs(x) + abs(y); }
};

mpz_class Turn(const Point& a, const Point& b) {
  mpz_class result = a.x * b.y;
  mpz_submul(result.get_mpz_t(), a.y.get_mpz_t(), b.x.get_mpz_t());
  return result;
}

/** Where the origin lies in the hull of points, and which of them say so. */
struct Support {
  enum class Place { kInside, kOn, kOutside };
  Place place = Place::kOutside;
  std::vector<std::pair<int, mpz_class>> weights;  ///< contacts and positive weights; none outside
  int edge[2] = {-1, -1};  ///< contacts of an edge of the hull, at or before the origin; or none
};

class SupportFinder {
 public:
  explicit SupportFinder(const std::vector<Point>& points) : points_(points) {}

  Support Find() {
    LookAround();
    if (first_ == nullptr) {
      if (zero_ != nullptr) StandOn(*zero_);
      return std::move(support_);
    }
    Classify();
    if (support_.place != Support::Place::kInside && zero_ != nullptr) {
      support_.weights.clear();
      if (support_.place == Support::Place::kOutside) SetEdge(*zero_, *right_);
      StandOn(*zero_);
    }
    if (support_.place == Support::Place::kOutside) FindEdge();
    return std::move(support_);
  }

 private:
  // The first point and, of those left and right of it, the ones farthest round; of points in one
  // direction the nearest.
  void LookAround() {
    for (const Point& p : points_) {
      if (p.is_zero()) {
        zero_ = &p;
      } else if (first_ == nullptr) {
        first_ = &p;
      } else {
        LookAt(p);
      }
    }
  }

  void LookAt(const Point& p) {
    const int side = sgn(Turn(*first_, p));
    if (side != 0) {
      const Point*& far = side > 0 ? left_ : right_;
      const int beyond = far == nullptr ? side : sgn(Turn(*far, p));
      if (beyond == side || (beyond == 0 && p.size() < far->size())) far = &p;
    } else if (sgn(first_->x) != sgn(p.x) || sgn(first_->y) != sgn(p.y)) {
      opposite_ = &p;
    } else if (p.size() < first_->size()) {
      first_ = &p;
    }
  }

  void Classify() {
    const int turn = left_ && right_ ? sgn(Turn(*left_, *right_)) : 0;
    if (turn > 0) return Enclose(*first_, *left_, *right_);
    if (turn < 0 && opposite_) return Enclose(*opposite_, *right_, *left_);
    const bool aligned = left_ && right_ && turn == 0;
    if (aligned && opposite_) {
      support_.place = Support::Place::kInside;
      AddPair(*left_, *right_);
      AddPair(*first_, *opposite_);
      return;
    }
    if (aligned || (opposite_ && !(left_ && right_))) {
      support_.place = Support::Place::kOn;
      const Point &a = aligned ? *right_ : *first_, &b = aligned ? *left_ : *opposite_;
      AddPair(a, b);
      SetEdge(a, b);
      if (right_ == nullptr) right_ = first_;
      return;
    }
    if (right_ == nullptr) right_ = first_;
  }

  // The origin is inside the triangle a, b, c.
  void Enclose(const Point& a, const Point& b, const Point& c) {
    support_.place = Support::Place::kInside;
    support_.weights.emplace_back(a.contact, Turn(b, c));
    support_.weights.emplace_back(b.contact, Turn(c, a));
    support_.weights.emplace_back(c.contact, Turn(a, b));
  }

  // The origin is between a and b.
  void AddPair(const Point& a, const Point& b) {
    support_.weights.emplace_back(a.contact, b.size());
    support_.weights.emplace_back(b.contact, a.size());
  }

  void StandOn(const Point& p) {
    support_.place = Support::Place::kOn;
    support_.weights.emplace_back(p.contact, 1);
  }

  void SetEdge(const Point& a, const Point& b) {
    support_.edge[0] = a.contact;
    support_.edge[1] = b.contact;
  }

  // All points are within less than half a turn to the left of right_; the hull's edge from there
  // that has them on the other side than the origin.
  void FindEdge() {
    const Point* end = nullptr;
    for (const Point& p : points_) {
      if (sgn(Turn(*right_, p)) <= 0) continue;
      if (end == nullptr) {
        end = &p;
        continue;
      }
      const mpz_class ax = end->x - right_->x, ay = end->y - right_->y;
      const mpz_class bx = p.x - right_->x, by = p.y - right_->y;
      if (ax * by > ay * bx) end = &p;
    }
    if (end != nullptr) SetEdge(*right_, *end);
  }

  const std::vector<Point>& points_;
  const Point *zero_ = nullptr, *first_ = nullptr, *left_ = nullptr, *right_ = nullptr,
              *opposite_ = nullptr;
  Support support_;
};

/** x in doubles up to a power of two. */
double Significand(const mpz_class& x, long* exponent) {
  return mpz_get_d_2exp(exponent, x.get_mpz_t());
}

class ParallelForces {
 public:
  explicit ParallelForces(const IntegerEquilibrium& e) : e_(e) {
    for (const IntegerCone& cone : e.cones) side_.push_back(SignInCone(cone, e.f));
  }

  std::optional<StabilityResult> Decide() {
    const std::optional<int> rank = RankOf(e_);
    if (!rank) return std::nullopt;
    result_.rank = *rank;
    Support support = SupportFinder(Points(1)).Find();
    if (support.place == Support::Place::kInside) return Hold(support);
    const bool grazing = std::find(side_.begin(), side_.end(), 0) != side_.end();
    if (grazing) support = SupportFinder(Points(0)).Find();
    if (support.place == Support::Place::kOutside ? Fails(support) : Ties(support)) {
      return std::move(result_);
    }
    return std::nullopt;
  }

 private:
  const IntegerCone& ConeOf(int contact) const {
    return e_.cones[static_cast<std::size_t>(e_.contacts[static_cast<std::size_t>(contact)].cone)];
  }

  /** The contacts whose cones hold f with at least this sign. */
  std::vector<Point> Points(int least) const {
    int drop = 0;
    for (int k = 1; k < 3; ++k) {
      if (cmpabs(e_.f[k], e_.f[drop]) > 0) drop = k;
    }
    const int a = (drop + 1) % 3, b = (drop + 2) % 3;
    std::vector<Point> points;
    for (std::size_t i = 0; i < e_.contacts.size(); ++i) {
      if (side_[static_cast<std::size_t>(e_.contacts[i].cone)] < least) continue;
      Integer3 c = Cross(e_.contacts[i].arm, e_.f);
      points.push_back({static_cast<int>(i), std::move(c[a]), std::move(c[b])});
    }
    return points;
  }

  static int cmpabs(const mpz_class& a, const mpz_class& b) {
    return mpz_cmpabs(a.get_mpz_t(), b.get_mpz_t());
  }

  // weight/(3 total) of the force u at a contact.
  void AddForce(int contact, const Integer3& u, const Rational& weight) {
    exact::ContactForce& force = result_.forces.emplace_back();
    force.contact = contact;
    for (int k = 0; k < 3; ++k) force.f[k] = weight * u[k];
  }

  /** The k for which f 2^k + e, |e| <= sqrt 2, should be admissible. |u|^2 w^2 and s^2 (1 + mu^2)
   change by at most about 4 |u| ww (1 + mu^2) |e|, and differ by the part `room` of |u|^2 ww. */
  unsigned ShiftFor(const IntegerCone& cone) const {
    const mpz_class along = Dot(e_.f, cone.w), ff = Dot(e_.f, e_.f);
    const mpz_class needed = ff * cone.ww * cone.den;
    long a, b, c;
    const double room =
        Significand(along * along * cone.sum - needed, &a) / Significand(needed, &b);
    const double f = std::sqrt(Significand(ff, &c));
    const double ratio = 16 * (1 + cone.mu * cone.mu) / (room * f);
    const double log = std::log2(ratio) - static_cast<double>(a - b) - 0.5 * static_cast<double>(c);
    return static_cast<unsigned>(std::clamp(std::ceil(log) + 1, 0.0, 4096.0));
  }

  /** f 2^k moved by unit steps across its largest entry, so that the three are independent. */
  bool Split(int contact, const Rational& weight) {
    const IntegerCone& cone = ConeOf(contact);
    const unsigned shift = ShiftFor(cone);
    int drop = 0;
    for (int k = 1; k < 3; ++k) {
      if (cmpabs(e_.f[k], e_.f[drop]) > 0) drop = k;
    }
    Integer3 u[3];
    for (Integer3& v : u) {
      for (int k = 0; k < 3; ++k) v[k] = e_.f[k] << shift;
    }
    for (int k = 0; k < 2; ++k) {
      const int axis = (drop + 1 + k) % 3;
      u[k][axis] += 1;
      u[2][axis] -= 1;
    }
    Rational part = weight / 3;
    mpq_div_2exp(part.get_mpq_t(), part.get_mpq_t(), shift);
    for (const Integer3& v : u) {
      if (SignInCone(cone, v) < 0) return false;
      AddForce(contact, v, part);
    }
    return true;
  }

  Rational Share(const Support& support, const mpz_class& weight) const {
    mpz_class total = 0;
    for (const auto& [contact, w] : support.weights) total += w;
    Rational share(weight, total);
    share.canonicalize();
    return share * e_.weight;
  }

  std::optional<StabilityResult> Hold(const Support& support) {
    for (const auto& [contact, weight] : support.weights) {
      if (!Split(contact, Share(support, weight))) return std::nullopt;
    }
    result_.verdict = Verdict::kHolds;
    return std::move(result_);
  }

  bool Separate(const Integer3& y_f, const Integer3& y_m, int gain) {
    if (sgn(numeric::Dot(y_f, e_.f)) != gain || !IsPolar(e_, y_f, y_m)) return false;
    result_.separator = ToMetres(e_, y_f, y_m);
    return true;
  }

  /** The torque about the line through two contacts, in either sense. */
  bool SeparateByEdge(const int (&edge)[2], int gain) {
    if (edge[0] < 0) return false;
    const Integer3& r = e_.contacts[static_cast<std::size_t>(edge[0])].arm;
    Integer3 axis = e_.contacts[static_cast<std::size_t>(edge[1])].arm;
    for (int k = 0; k < 3; ++k) axis[k] -= r[k];
    Integer3 y_f = Cross(r, axis);
    for (int sense = 0; sense < 2; ++sense) {
      if (Separate(y_f, axis, gain)) return true;
      for (int k = 0; k < 3; ++k) axis[k] = -axis[k], y_f[k] = -y_f[k];
    }
    return false;
  }

  bool Ties(const Support& support) {
    for (const auto& [contact, weight] : support.weights) {
      AddForce(contact, e_.f, Share(support, weight));
    }
    result_.reason = StabilityReason::kRank;
    if (result_.rank < 6) return true;
    result_.reason = StabilityReason::kBoundary;
    if (SeparateByEdge(support.edge, 0)) return true;
    for (std::size_t i = 0; i < side_.size(); ++i) {
      if (side_[i] == 0 && SeparateByTangent(e_.cones[i])) return true;
    }
    return false;
  }

  bool Fails(const Support& support) {
    result_.verdict = Verdict::kFails;
    if (SeparateByEdge(support.edge, 1)) return true;
    for (std::size_t i = 0; i < side_.size(); ++i) {
      if (side_[i] < 0 && SeparateBeyond(e_.cones[i])) return true;
    }
    return false;
  }

  /** f is on the boundary: minus the gradient of s^2 (1 + mu^2) - |u|^2 ww there, times den. */
  bool SeparateByTangent(const IntegerCone& cone) {
    const mpz_class a = cone.den * cone.ww, b = cone.sum * Dot(e_.f, cone.w);
    Integer3 y_f;
    for (int k = 0; k < 3; ++k) y_f[k] = a * e_.f[k] - b * cone.w[k];
    return Separate(y_f, {}, 0);
  }

  /** f is beyond: alpha t - beta w for t = ww f - (f.w) w across w, which the cone never drives iff
   beta^2 ww den >= alpha^2 |t|^2 num. The more bits beta has, the nearer y is to the boundary. */
  bool SeparateBeyond(const IntegerCone& cone) {
    constexpr std::size_t kBits = 160;
    const mpz_class along = Dot(e_.f, cone.w);
    Integer3 t;
    for (int k = 0; k < 3; ++k) t[k] = cone.ww * e_.f[k] - along * cone.w[k];
    mpz_class squared = Dot(t, t) * cone.num;
    const mpz_class divisor = cone.ww * cone.den;
    const std::size_t have = mpz_sizeinbase(squared.get_mpz_t(), 2),
                      less = mpz_sizeinbase(divisor.get_mpz_t(), 2);
    const auto shift =
        static_cast<unsigned>(have > less + 2 * kBits ? 0 : (less + 2 * kBits - have) / 2 + 1);
    squared <<= 2 * shift;
    const mpz_class beta = sqrt(mpz_class(squared / divisor)) + 1;
    Integer3 y_f;
    for (int k = 0; k < 3; ++k) y_f[k] = (t[k] << shift) - beta * cone.w[k];
    return Separate(y_f, {}, 1);
  }

  const IntegerEquilibrium& e_;
  std::vector<int> side_;  ///< of each cone, where f is
  StabilityResult result_;
};

}  // namespace

std::optional<StabilityResult> DecideByParallelForces(const IntegerEquilibrium& e) {
  return ParallelForces(e).Decide();
}

}  // namespace cguide::numeric
