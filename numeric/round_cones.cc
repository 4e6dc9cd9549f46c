#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cguide/exact/core/rational.h"
#include "cguide/numeric/dyadic_internal.h"
#include "cguide/numeric/round_cones_internal.h"

namespace cguide::numeric {
namespace {

// Of what is larger compared with its last bit the integers would grow without need: such numbers
// are no contacts of a robot.
constexpr int kMaxBits = 256;

/** The integers of numbers that share a unit. */
class Lifting {
 public:
  void Add(const Eigen::Vector3d& v) {
    for (int i = 0; i < 3; ++i) Add(Split(v[i]));
  }

  bool fits() const { return highest_ - unit() <= kMaxBits; }
  int unit() const { return lowest_ == Dyadic::kNone ? 0 : lowest_; }

 private:
  void Add(const Dyadic& x) {
    if (x.mantissa == 0) return;
    const int top =
        x.exponent +
        static_cast<int>(std::bit_width(static_cast<std::uint64_t>(std::abs(x.mantissa))));
    highest_ = lowest_ == Dyadic::kNone ? top : std::max(highest_, top);
    lowest_ = std::min(lowest_, x.exponent);
  }

  int lowest_ = Dyadic::kNone;
  int highest_ = 0;
};

void SetVector(const Eigen::Vector3d& v, int unit, Integer3* result) {
  for (int i = 0; i < 3; ++i) SetInteger(Split(v[i]), unit, &(*result)[i]);
}

/** The normal as exact::ExactContact has it: x - y, signed, where the stored numbers are without
 error, and n_W otherwise. */
bool IsDirection(const Contact& contact) {
  return contact.error == 0 && contact.radius == 0 && contact.normal_error < 0 &&
         contact.distance != 0;
}

bool LiftCone(const Contact& contact, IntegerCone* cone) {
  Lifting lifting;
  Integer3 y;
  if (IsDirection(contact)) {
    lifting.Add(contact.x_W);
    lifting.Add(contact.y_W);
    if (!lifting.fits()) return false;
    SetVector(contact.x_W, lifting.unit(), &cone->w);
    SetVector(contact.y_W, lifting.unit(), &y);
    for (int i = 0; i < 3; ++i) {
      cone->w[i] -= y[i];
      if (contact.distance < 0) cone->w[i] = -cone->w[i];
    }
  } else {
    lifting.Add(contact.n_W);
    if (!lifting.fits()) return false;
    SetVector(contact.n_W, lifting.unit(), &cone->w);
  }
  cone->ww = Dot(cone->w, cone->w);
  if (cone->ww == 0) return false;
  const Dyadic mu = Split(contact.friction);
  const int shift = mu.mantissa == 0 ? 0 : mu.exponent;
  if (std::abs(shift) > kMaxBits) return false;
  cone->mu = contact.friction;
  long exponent;
  cone->n = ToDoubles(cone->w, &exponent).normalized();
  SetInteger(mu, std::min(shift, 0), &cone->num);
  cone->num *= cone->num;
  cone->den = mpz_class(1) << static_cast<unsigned>(-2 * std::min(shift, 0));
  cone->sum = cone->num + cone->den;
  return true;
}

bool SameCone(const Contact& a, const Contact& b) {
  return !IsDirection(a) && !IsDirection(b) && a.friction == b.friction && a.n_W == b.n_W;
}

/** Up to sign, of three points on a line none. */
Integer3 Difference(const Integer3& a, const Integer3& b) {
  Integer3 d;
  for (int i = 0; i < 3; ++i) d[i] = a[i] - b[i];
  return d;
}

bool IsZero(const Integer3& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

}  // namespace

bool LiftEquilibrium(const StabilityQuery& query, const ScaledContacts& scaled, int count,
                     IntegerEquilibrium* e) {
  Lifting points, pull;
  points.Add(query.com_W);
  for (int i = 0; i < count; ++i) points.Add(query.contacts[scaled.index[i]].force_point_W());
  pull.Add(query.gravity_W);
  if (!points.fits() || !pull.fits()) return false;
  e->unit = points.unit();
  e->contacts.resize(static_cast<std::size_t>(count));
  e->cones.clear();
  Integer3 com;
  SetVector(query.com_W, e->unit, &com);
  const Contact* last = nullptr;
  for (int i = 0; i < count; ++i) {
    const Contact& contact = query.contacts[scaled.index[i]];
    IntegerEquilibrium::Contact& lifted = e->contacts[static_cast<std::size_t>(i)];
    SetVector(contact.force_point_W(), e->unit, &lifted.arm);
    for (int k = 0; k < 3; ++k) {
      lifted.arm[k] -= com[k];
      lifted.r[k] = lifted.arm[k].get_d();
    }
    if (last == nullptr || !SameCone(*last, contact)) {
      if (!LiftCone(contact, &e->cones.emplace_back())) return false;
    }
    last = &contact;
    lifted.cone = static_cast<int>(e->cones.size()) - 1;
  }
  SetVector(-query.gravity_W, pull.unit(), &e->f);
  e->weight = Lift(query.mass) * Lift(std::ldexp(1.0, pull.unit()));
  return true;
}

Eigen::Vector3d ToDoubles(const Integer3& x, long* exponent) {
  constexpr long kLowest = std::numeric_limits<long>::min();
  long exponents[3];
  Eigen::Vector3d result;
  *exponent = kLowest;
  for (int k = 0; k < 3; ++k) {
    result[k] = mpz_get_d_2exp(&exponents[k], x[k].get_mpz_t());
    if (x[k] != 0) *exponent = std::max(*exponent, exponents[k]);
  }
  for (int k = 0; k < 3; ++k) {
    if (x[k] == 0) continue;
    result[k] = std::ldexp(result[k], static_cast<int>(std::max(exponents[k] - *exponent, -2000L)));
  }
  return result;
}

int SignInCone(const IntegerCone& cone, const Integer3& u) {
  const mpz_class along = Dot(u, cone.w);
  if (along <= 0) return -1;
  const mpz_class needed = Dot(u, u) * cone.ww * cone.den;
  return cmp(mpz_class(along * along * cone.sum), needed);
}

// s <= 0 and s^2 (1 + mu^2) >= mu^2 |g|^2 |w|^2, times the denominator of mu^2.
bool IsNeverDriven(const IntegerCone& cone, const Integer3& g) {
  const mpz_class along = Dot(g, cone.w);
  if (along > 0) return false;
  const mpz_class needed = Dot(g, g) * cone.ww * cone.num;
  return along * along * cone.sum >= needed;
}

Integer3 SeenAt(const IntegerEquilibrium& e, int contact, const Integer3& y_f,
                const Integer3& y_m) {
  const Integer3& arm = e.contacts[static_cast<std::size_t>(contact)].arm;
  Integer3 g = y_f;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    mpz_addmul(g[k].get_mpz_t(), y_m[i].get_mpz_t(), arm[j].get_mpz_t());
    mpz_submul(g[k].get_mpz_t(), y_m[j].get_mpz_t(), arm[i].get_mpz_t());
  }
  return g;
}

// The larger of y_f and y_m times the longest arm is brought near 1; what is smaller by 2^-1000 is
// lost, far below the bound.
DrivenFilter::DrivenFilter(const IntegerEquilibrium& e, const Integer3& y_f, const Integer3& y_m)
    : e_(e) {
  double reach = 1;
  for (const IntegerEquilibrium::Contact& c : e.contacts) {
    reach = std::max(reach, c.r.lpNorm<Eigen::Infinity>());
  }
  const long arm = std::ilogb(reach);
  long f, m;
  y_f_ = ToDoubles(y_f, &f);
  y_m_ = ToDoubles(y_m, &m);
  const bool forces = y_f_.isZero(0), moments = y_m_.isZero(0);
  const long top = std::max(forces ? m + arm : f, moments ? f : m + arm);
  y_f_ *= std::ldexp(1.0, static_cast<int>(forces ? 0 : std::max(f - top, -1000L)));
  y_m_ *= std::ldexp(1.0, static_cast<int>(moments ? 0 : std::max(m - top, -1000L)));
}

// With S = |y_f| + 2 |y_m| |r| in largest entries, an entry of g = y_f + y_m x r is off by 5.1 u of
// its products (2 u of either factor, u of the product), 2 u of y_f and u of two sums: by 8 u S, g
// by 14 u S and |g| <= 1.8 S. n is within 4 u, the dot product within 3 u |g|: `along` is off by 27
// u S; `across` by 14 + 27 + 7 and as much again for its own roundings, `price` by less than 256 u
// (1 + mu) S. A negative price is above g.u/u.n for each u of the cone.
bool DrivenFilter::IsFarFromDriven(int contact) const {
  const IntegerEquilibrium::Contact& c = e_.contacts[static_cast<std::size_t>(contact)];
  const IntegerCone& cone = e_.cones[static_cast<std::size_t>(c.cone)];
  const double size = y_f_.lpNorm<Eigen::Infinity>() +
                      2 * y_m_.lpNorm<Eigen::Infinity>() * c.r.lpNorm<Eigen::Infinity>();
  const Eigen::Vector3d g = y_f_ + y_m_.cross(c.r);
  const double along = g.dot(cone.n);
  const double price = along + cone.mu * (g - along * cone.n).norm();
  return price < -0x1p-45 * (1 + cone.mu) * size;
}

bool IsPolar(const IntegerEquilibrium& e, const Integer3& y_f, const Integer3& y_m) {
  const DrivenFilter filter(e, y_f, y_m);
  for (std::size_t i = 0; i < e.contacts.size(); ++i) {
    if (filter.IsFarFromDriven(static_cast<int>(i))) continue;
    const IntegerCone& cone = e.cones[static_cast<std::size_t>(e.contacts[i].cone)];
    if (!IsNeverDriven(cone, SeenAt(e, static_cast<int>(i), y_f, y_m))) return false;
  }
  return true;
}

// Forces of a contact with friction span R^3. Two wrenches spaces of that kind at different points
// share the force along the line of the points alone: rank 5; a third point off the line adds the
// moment about it.
std::optional<int> RankOf(const IntegerEquilibrium& e) {
  const Integer3 *first = nullptr, *second = nullptr;
  for (const IntegerEquilibrium::Contact& contact : e.contacts) {
    if (e.cones[static_cast<std::size_t>(contact.cone)].num == 0) return std::nullopt;
    if (first == nullptr) {
      first = &contact.arm;
    } else if (second == nullptr) {
      if (contact.arm != *first) second = &contact.arm;
    } else if (!IsZero(Cross(Difference(*second, *first), Difference(contact.arm, *first)))) {
      return 6;
    }
  }
  return second != nullptr ? 5 : first != nullptr ? 3 : 0;
}

bool IsEven(const IntegerEquilibrium& e) {
  return std::all_of(e.cones.begin(), e.cones.end(),
                     [&](const IntegerCone& cone) { return cone.w == e.cones[0].w; });
}

// y_m x (arm 2^-unit in integers) is (y_m 2^-unit) x arm.
Vector6q ToMetres(const IntegerEquilibrium& e, const Integer3& y_f, const Integer3& y_m) {
  Vector6q y;
  for (int k = 0; k < 3; ++k) {
    y[k] = y_f[k];
    y[k + 3] = y_m[k];
    if (e.unit > 0) mpq_div_2exp(y[k + 3].get_mpq_t(), y[k + 3].get_mpq_t(), e.unit);
    if (e.unit < 0) mpq_mul_2exp(y[k + 3].get_mpq_t(), y[k + 3].get_mpq_t(), -e.unit);
  }
  return y;
}

}  // namespace cguide::numeric
