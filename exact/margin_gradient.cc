#include "cguide/exact/margin_gradient.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "cguide/exact/balance_checker_internal.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/mp_interval_internal.h"

namespace cguide::exact {
namespace {

using internal::MpInterval;
using internal::MpVector;

constexpr mpfr_prec_t kBits = 128;

MpInterval At(const Rational& x) { return MpInterval(x, kBits); }

MpVector Cross(const MpVector& a, const Vector3q& b) {
  return {a[1] * At(b[2]) - a[2] * At(b[1]), a[2] * At(b[0]) - a[0] * At(b[2]),
          a[0] * At(b[1]) - a[1] * At(b[0])};
}

/** Sum of the larger ends of |a_k|^2. */
Rational SquaredBound(const MpVector& a) {
  Rational sum = 0;
  for (const MpInterval& x : a) {
    const Rational largest = std::max(Rational(abs(x.Lower())), Rational(abs(x.Upper())));
    sum += largest * largest;
  }
  return sum;
}

EnclosedVector Rounded(const MpVector& a) {
  EnclosedVector result;
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = {RoundDown(a[k].Lower()), RoundUp(a[k].Upper())};
  }
  return result;
}

Vector3q SeenAt(const EquilibriumQuery& query, std::size_t contact, const Vector6q& y) {
  const Vector3q y_f = y.head(3), y_m = y.tail(3);
  return y_f + exact::Cross(y_m, query.contacts[contact].p - query.com);
}

/** s >= 0 with g.u <= -s w.u for every admissible u: floats propose the largest, the cone's own
 test decides; 0 where none was shown. */
Rational RoomAt(const FrictionCone& cone, const Vector3q& g) {
  Eigen::Vector3d w, seen;
  for (int k = 0; k < 3; ++k) w[k] = NearestDouble(cone.w[k]), seen[k] = NearestDouble(g[k]);
  const double length = w.norm(), along = seen.dot(w) / length;
  const double across = (seen - along / length * w).norm();
  const double room = -(along + NearestDouble(cone.mu) * across) / length;
  for (const double share : {1 - 0x1p-20, 0.5}) {
    if (!(room > 0) || !std::isfinite(room)) return 0;
    const Rational s = Lift(share * room);
    if (IsNeverDrivenBy(cone, g + Scaled(s, cone.w))) return s;
  }
  return 0;
}

/** The steps of CheckMarginGradient, each of which may fail. */
class GradientChecker {
 public:
  GradientChecker(const EquilibriumQuery& query, const MarginGradientEvidence& evidence)
      : query_(query),
        evidence_(evidence),
        up_(Scaled(-1, query.gravity)),
        w_(Scaled(-query.mass, query.gravity)) {}

  std::optional<MarginGradientBox> Check() {
    if (!EncloseMargin() || !EncloseDirection() || !EncloseWrench() || !BoundForces()) {
      return std::nullopt;
    }
    MarginGradientBox box;
    box.com_m = bounds_;
    MpVector com = h_;
    for (MpInterval& x : com) x = -x;
    box.com = Rounded(com);
    for (std::size_t k = 0; k < query_.contacts.size(); ++k) {
      const double reach = RoundUp(SqrtUp(SquaredBound(y_m_)) * force_[k]);
      const Enclosure all{-reach, reach};
      box.contact.push_back({all, all, all});
    }
    return ApplyMoved(&box) ? std::optional(std::move(box)) : std::nullopt;
  }

 private:
  bool EncloseMargin();
  bool EncloseDirection();
  void Turn(const Vector3q& d, const Rational& bound);
  void SetDirection();
  /** h.a; by the components of h it would be wider. */
  MpInterval AlongH(const Vector3q& a) const {
    return x_ * At(exact::Dot(h0_, a)) + MpInterval(z_lo_, z_hi_, kBits) * At(exact::Dot(t0_, a));
  }
  std::optional<Rational> CosineInside() const;
  std::optional<Rational> CosineOutside();
  Rational Cosine(const Vector3q& p) const;
  void SetReference(const Vector3q& h);
  bool EncloseWrench();
  bool BoundForces();
  MpVector WrenchMoment(const MpInterval& k) const;
  Rational Reach(const MovedSeparator& moved, const Rational& size, const MpVector& y_m) const;
  bool ApplyMoved(MarginGradientBox* box) const;

  const EquilibriumQuery& query_;
  const MarginGradientEvidence& evidence_;
  const Vector3q up_, w_;
  ComRegion region_;
  Enclosure bounds_;
  Rational lo_, hi_;
  std::size_t binding_ = 0;  // of the outer bounds
  Vector3q h0_, t0_;         // normal to up and to each other, about 1 long
  Rational h0_squared_, t0_squared_;
  Rational z_lo_, z_hi_;  // h = x h0 + z t0
  MpInterval m_{kBits}, x_{kBits};
  MpVector h_, y_m_;
  std::array<MpVector, 2> y_m_end_;  // at the ends of what y_m.w may be
  std::vector<Rational> force_;      // of each contact: bound on |f_k|
};

bool GradientChecker::EncloseMargin() {
  auto region = CheckComRegion(query_, up_, evidence_.region);
  if (!region) return false;
  region_ = std::move(*region);
  const auto is_interior = [](const DisplacedBalance& c) { return !c.base_weight.empty(); };
  const auto& corners = evidence_.region.corners;
  if (std::none_of(corners.begin(), corners.end(), is_interior)) return false;
  bounds_ = MarginBounds(region_);
  if (!std::isfinite(bounds_.lo) || !std::isfinite(bounds_.hi)) return false;
  if (bounds_.lo > bounds_.hi || (bounds_.lo <= 0 && bounds_.hi >= 0)) return false;
  lo_ = Lift(bounds_.lo);
  hi_ = Lift(bounds_.hi);
  m_ = MpInterval(lo_, hi_, kBits);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < region_.outer.size(); ++j) {
    const DisplacementBound& bound = region_.outer[j];
    const double b = NearestDouble(bound.b) / std::sqrt(NearestDouble(SquaredNorm(bound.h)));
    if (b >= least) continue;
    least = b;
    binding_ = j;
  }
  return std::isfinite(least);
}

void GradientChecker::SetReference(const Vector3q& h) {
  const auto unit = [](const Vector3q& a) {
    return Scaled(Lift(NearestDouble(1 / SqrtUp(SquaredNorm(a)))), a);
  };
  h0_ = unit(h);
  t0_ = unit(exact::Cross(up_, h0_));
  h0_squared_ = SquaredNorm(h0_);
  t0_squared_ = SquaredNorm(t0_);
}

/** Of the angle between p and h0, from below. */
Rational GradientChecker::Cosine(const Vector3q& p) const {
  return exact::Dot(p, h0_) / SqrtUp(Rational(SquaredNorm(p) * h0_squared_));
}

/** h = (a p + b q) with p, q neighbours and a, b >= 0 has 1 = h.h <= (a + b) hi: on the way to it
 the chord is within hi of 0. The least cosine of such parts of chords: at their ends, as the
 directions of a cosine above a positive one are a convex cone. */
std::optional<Rational> GradientChecker::CosineInside() const {
  std::optional<Rational> least;
  const std::vector<Vector3q>& corners = region_.inner;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3q &a = corners[i], edge = corners[(i + 1) % corners.size()] - a;
    const Rational squared = SquaredNorm(edge);
    const Rational foot = -exact::Dot(a, edge) / squared;
    const Rational room = (hi_ * hi_ - SquaredNorm(a + Scaled(foot, edge))) / squared;
    if (room < 0) continue;
    const Rational half = SqrtUp(room);
    const Rational from = std::max(Rational(0), Rational(foot - half));
    const Rational to = std::min(Rational(1), Rational(foot + half));
    if (from > to) continue;
    for (const Rational& s : {from, to}) {
      const Rational cosine = Cosine(a + Scaled(s, edge));
      if (!least || cosine < *least) least = cosine;
    }
  }
  return least;
}

/** For the nearest point p of the polygon, p.h <= hi < 0. Makes -p the reference. */
std::optional<Rational> GradientChecker::CosineOutside() {
  std::optional<Vector3q> nearest;
  const std::vector<Vector3q>& corners = region_.inner;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3q &a = corners[i], edge = corners[(i + 1) % corners.size()] - a;
    const Rational squared = SquaredNorm(edge);
    Rational s = squared == 0 ? Rational(0) : Rational(-exact::Dot(a, edge) / squared);
    s = std::clamp(s, Rational(0), Rational(1));
    const Vector3q p = a + Scaled(s, edge);
    if (!nearest || SquaredNorm(p) < SquaredNorm(*nearest)) nearest = p;
  }
  if (!nearest || IsZero(*nearest)) return std::nullopt;
  SetReference(Scaled(-1, *nearest));
  return Rational(-hi_ / SqrtUp(SquaredNorm(*nearest)));
}

void GradientChecker::SetDirection() {
  const Rational low = z_lo_ * z_lo_, high = z_hi_ * z_hi_;
  const Rational least = sgn(z_lo_) * sgn(z_hi_) > 0 ? std::min(low, high) : Rational(0);
  const MpInterval squared(least, std::max(low, high), kBits);
  x_ = Sqrt(((At(1) - At(t0_squared_) * squared) / At(h0_squared_)).NonNegative());
  const MpInterval z(z_lo_, z_hi_, kBits);
  for (int k = 0; k < 3; ++k) {
    h_[static_cast<std::size_t>(k)] = x_ * At(h0_[k]) + z * At(t0_[k]);
  }
}

/** h.d <= bound narrows z. */
void GradientChecker::Turn(const Vector3q& d, const Rational& bound) {
  const Rational along = exact::Dot(h0_, d), across = exact::Dot(t0_, d);
  if (across == 0) return;
  const Rational reach = (At(bound) - x_ * At(along)).Upper() / abs(across);
  if (across > 0) z_hi_ = std::min(z_hi_, reach);
  if (across < 0) z_lo_ = std::max(z_lo_, Rational(-reach));
}

bool GradientChecker::EncloseDirection() {
  if (hi_ > 0) SetReference(region_.outer[binding_].h);
  const auto cosine = hi_ > 0 ? CosineInside() : CosineOutside();
  if (!cosine || *cosine <= 0) return false;
  const Rational sine_squared = std::max(Rational(0), Rational(1 - *cosine * *cosine));
  z_hi_ = SqrtUp(Rational(sine_squared / t0_squared_));
  z_lo_ = -z_hi_;
  SetDirection();
  for (int round = 0; round < 3; ++round) {
    for (const Vector3q& d : region_.inner) Turn(d, hi_);
    for (const DisplacementBound& line : region_.outer) {
      // m h.h_j <= b_j, divided by |m|.
      const bool near = (line.b > 0) == (hi_ > 0);
      const Rational least = near ? lo_ : hi_;
      const Rational size = abs(least);
      Turn(hi_ > 0 ? line.h : Scaled(-1, line.h), line.b / size);
    }
    if (z_lo_ > z_hi_) return false;
    SetDirection();
  }
  return true;
}

bool GradientChecker::EncloseWrench() {
  const internal::BalanceChecker checker(query_, evidence_.region.basis);
  std::optional<Rational> lo, hi;
  for (const TwistedBalance& twisted : evidence_.twisted) {
    const Vector3q& d = twisted.balance.displacement;
    if (twisted.twist == 0 || exact::Dot(d, up_) != 0) return false;
    Vector6q v = internal::DemandAt(query_, d);
    v.tail(3) += Scaled(twisted.twist, w_);
    if (!checker.Holds(twisted.balance, v)) return false;
    const Rational reach = (m_ - AlongH(d)).Upper() / abs(twisted.twist);
    if (twisted.twist > 0 && (!hi || reach < *hi)) hi = reach;
    if (twisted.twist < 0 && (!lo || -reach > *lo)) lo = -reach;
  }
  if (!lo || !hi || *lo > *hi) return false;
  y_m_ = WrenchMoment(MpInterval(*lo, *hi, kBits));
  y_m_end_ = {WrenchMoment(At(*lo)), WrenchMoment(At(*hi))};
  return true;
}

/** y_m of h and k = y_m.w: (h x w + k w)/|w|^2, as w x (h x w) = |w|^2 h for h normal to w. */
MpVector GradientChecker::WrenchMoment(const MpInterval& k) const {
  const MpInterval squared = At(SquaredNorm(w_));
  MpVector y_m = Cross(h_, w_);
  for (int i = 0; i < 3; ++i) {
    MpInterval& x = y_m[static_cast<std::size_t>(i)];
    x = (x + k * At(w_[i])) / squared;
  }
  return y_m;
}

bool GradientChecker::BoundForces() {
  force_.assign(query_.contacts.size(), 0);
  const Vector6q away = -evidence_.pole;
  for (const Vector6q* y : {&away, &evidence_.region.separators[binding_]}) {
    // -y.v(m h) >= room w.f for each contact.
    const Vector3q y_f = y->head(3), y_m = y->tail(3);
    const MpInterval supply = -(At(exact::Dot(y_f, w_)) + m_ * AlongH(exact::Cross(w_, y_m)));
    for (std::size_t k = 0; k < query_.contacts.size(); ++k) {
      const ExactContact& contact = query_.contacts[k];
      if (!contact.certain) continue;
      const Rational room = RoomAt(contact.cone, SeenAt(query_, k, *y));
      if (room == 0 && y == &away) return false;
      if (room == 0) continue;
      const Rational along = std::max(Rational(0), supply.Upper()) / room;
      const Rational slope = (1 + contact.cone.mu * contact.cone.mu) / SquaredNorm(contact.cone.w);
      const Rational force = along * SqrtUp(slope);
      force_[k] = y == &away ? force : std::min(force_[k], force);
    }
  }
  return true;
}

/** What a moved separator says of the component of f_k x y_m along its shift: an upper bound times
 the direction's sign, for y_m with k = y_m.w at one end of its interval. */
Rational GradientChecker::Reach(const MovedSeparator& moved, const Rational& size,
                                const MpVector& y_m) const {
  const Vector3q moved_f = moved.y.head(3), moved_m = moved.y.tail(3);
  const MpInterval seen = At(exact::Dot(moved_f, w_)) + m_ * AlongH(exact::Cross(w_, moved_m));
  MpVector turned = y_m;
  for (std::size_t j = 0; j < 3; ++j) turned[j] = turned[j] - At(moved_m[static_cast<int>(j)]);
  const Rational& force = force_[static_cast<std::size_t>(moved.contact)];
  return (-seen).Upper() / size + SqrtUp(SquaredBound(turned)) * force;
}

/** f_k x y_m is affine in y_m.w: the larger of the bounds at the two ends holds between them. */
bool GradientChecker::ApplyMoved(MarginGradientBox* box) const {
  std::map<std::array<int, 3>, std::array<Rational, 2>> reaches;
  for (const MovedSeparator& moved : evidence_.moved) {
    if (moved.contact < 0 || moved.contact >= static_cast<int>(query_.contacts.size()))
      return false;
    const auto along = [&](int i) { return moved.shift[i] != 0; };
    if (along(0) + along(1) + along(2) != 1) return false;
    const int i = along(0) ? 0 : along(1) ? 1 : 2;
    EquilibriumQuery shifted = query_;
    shifted.contacts[static_cast<std::size_t>(moved.contact)].p += moved.shift;
    if (!ArePolar(shifted, {moved.y})) return false;
    const Rational size = abs(moved.shift[i]);
    std::array<Rational, 2> reach;
    for (std::size_t end = 0; end < 2; ++end) reach[end] = Reach(moved, size, y_m_end_[end]);
    const auto [place, is_new] =
        reaches.try_emplace({moved.contact, i, sgn(moved.shift[i])}, reach);
    if (is_new) continue;
    for (std::size_t end = 0; end < 2; ++end) {
      place->second[end] = std::min(place->second[end], reach[end]);
    }
  }
  for (const auto& [key, reach] : reaches) {
    const auto [contact, i, sign] = key;
    const Rational bound = std::max(reach[0], reach[1]);
    Enclosure& component =
        box->contact[static_cast<std::size_t>(contact)][static_cast<std::size_t>(i)];
    if (sign > 0) component.hi = std::min(component.hi, RoundUp(bound));
    if (sign < 0) component.lo = std::max(component.lo, RoundDown(-bound));
  }
  return true;
}

}  // namespace

std::optional<MarginGradientBox> CheckMarginGradient(const EquilibriumQuery& query,
                                                     const MarginGradientEvidence& evidence) {
  Require(query.com_error == 0, "a gradient is that of a centre of mass without error");
  for (const ExactContact& contact : query.contacts) {
    Require(contact.error_p == 0 && contact.error_w == 0,
            "a gradient is that of contacts without errors");
  }
  return GradientChecker(query, evidence).Check();
}

}  // namespace cguide::exact
