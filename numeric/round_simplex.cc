#include <algorithm>
#include <cmath>

#include "cguide/numeric/cone_exact_internal.h"
#include "cguide/numeric/dyadic_internal.h"
#include "cguide/numeric/round_cones_internal.h"
#include "cguide/numeric/wide_integer_internal.h"

// The program of stability_simplex.cc over integers, from where doubles left it: maximise tau over
// v = tau a + sum lambda_j a_j, lambda >= 0, with a the sum of six independent generators, the
// base. A basis is kept as its adjugate over one common denominator. At a basis with x >= 0, tau >
// 0 is a proof that v is interior. y = minus the row of tau has y.a < 0 = y.a_j and y.v = -tau:
// where no cone drives y it separates (tau < 0), or supports at v (tau = 0, x >= 0).
//
// Where a force slides, on the round side of a cone, y is tangent to the cone only in the limit.
// Two things make up for that: columns have 92 bits where doubles had 53, so that with the
// direction known to u the tangent is known to u^2; and a y0 that is driven by next to nothing is
// shifted by a multiple of a y that has room, if that leaves y.v > 0.
namespace cguide::numeric {
namespace {

using exact::StabilityReason;
using exact::StabilityResult;

__extension__ typedef __float128 Quad;

constexpr int kMaxPivots = 40;
constexpr int kFloatBits = 60;        // of columns that doubles found, after the point
constexpr int kColumnBits = 92;       // of those made here
constexpr double kInwards = 0x1p-80;  // what rounding to 92 bits may ask for

Quad ToQuad(const mpz_class& x) {
  const double high = x.get_d();
  mpz_class rest;
  mpz_set_d(rest.get_mpz_t(), high);
  rest = x - rest;
  return static_cast<Quad>(high) + static_cast<Quad>(rest.get_d());
}

Quad SquareRoot(Quad x) {
  const Quad root = std::sqrt(static_cast<double>(x));
  const Quad better = (root + x / root) / 2;
  return (better + x / better) / 2;
}

/** x 2^bits cut to an integer; 0 where that is too large for a proposal. */
mpz_class ToInteger(Quad x, int bits) {
  if (!(std::abs(static_cast<double>(x)) < std::ldexp(1.0, 120 - bits))) return 0;
  const auto scaled = static_cast<Int128>(x * static_cast<Quad>(std::ldexp(1.0, bits)));
  const auto size = static_cast<UInt128>(scaled < 0 ? -scaled : scaled);
  mpz_class result = static_cast<unsigned long>(size >> 64);
  result <<= 64;
  result += static_cast<unsigned long>(size);
  return scaled < 0 ? mpz_class(-result) : result;
}

struct Column {
  int contact = -1;
  Integer3 u;
  IntegerWrench wrench;
};

class RoundSimplex {
 public:
  RoundSimplex(const IntegerEquilibrium& e, const SimplexEnd& found) : e_(e), found_(found) {
    for (int k = 0; k < 3; ++k) v_.a[k] = e.f[k], v_.a[k + 3] = 0;
  }

  std::optional<StabilityResult> Decide() {
    const std::optional<int> rank = RankOf(e_);
    if (rank != 6 || found_.direction_row < 0) return std::nullopt;
    result_.rank = 6;
    for (int k = 0; k < 6; ++k) {
      if (!FromFloat(found_.base[k], &base_[k])) return std::nullopt;
      if (k != found_.direction_row && !FromFloat(found_.column[k], &column_[k])) {
        return std::nullopt;
      }
    }
    if (StartWhereDoublesEnded()) {
      const Step step = Judge();
      if (step == Step::kDone) return result_;
      if (step == Step::kImprove && Climb()) return result_;
      if (step != Step::kRestart) return std::nullopt;
    }
    for (int k = 0; k < 6; ++k) {
      if (k != found_.direction_row) waiting_.push_back(column_[k]);
    }
    if (StartAtBase() && Climb()) return result_;
    return std::nullopt;
  }

 private:
  enum class Step { kDone, kImprove, kRestart };

  const IntegerCone& ConeOf(int contact) const {
    return e_.cones[static_cast<std::size_t>(e_.contacts[static_cast<std::size_t>(contact)].cone)];
  }

  void SetWrench(Column* column) const {
    const Integer3 moment =
        Cross(e_.contacts[static_cast<std::size_t>(column->contact)].arm, column->u);
    for (int k = 0; k < 3; ++k) {
      column->wrench.a[k] = column->u[k];
      column->wrench.a[k + 3] = moment[k];
    }
  }

  // Cut to 60 bits after the point; where that, or what doubles thought admissible, is not, the
  // force in the same direction that is.
  bool FromFloat(const Generator& generator, Column* column) const {
    if (generator.contact < 0) return false;
    column->contact = generator.contact;
    const IntegerCone& cone = ConeOf(generator.contact);
    for (int k = 0; k < 3; ++k) column->u[k] = ToInteger(generator.u[k], kFloatBits);
    if (cone.num == 0) column->u = cone.w;
    if (SignInCone(cone, column->u) < 0) {
      const Eigen::Vector3d across = generator.u - generator.u.dot(cone.n) * cone.n;
      SetExtreme(cone, across, column);
    }
    SetWrench(column);
    return true;
  }

  // w/|w| + mu t/|t| for t the part of `across` across w, a little inwards.
  void SetExtreme(const IntegerCone& cone, const Eigen::Vector3d& across, Column* column) const {
    column->u = cone.w;
    if (cone.num == 0 || cone.mu > 0x1p18) return;
    Quad n[3], t[3], ww = 0, along = 0, tt = 0;
    for (int k = 0; k < 3; ++k) n[k] = ToQuad(cone.w[k]), ww += n[k] * n[k];
    const Quad length = SquareRoot(ww);
    for (int k = 0; k < 3; ++k) n[k] /= length, along += n[k] * across[k];
    for (int k = 0; k < 3; ++k) t[k] = across[k] - along * n[k], tt += t[k] * t[k];
    if (!(tt > 0)) return;
    const Quad reach = cone.mu * (1 - static_cast<Quad>(kInwards)) / SquareRoot(tt);
    Integer3 u;
    for (int k = 0; k < 3; ++k) u[k] = ToInteger(n[k] + reach * t[k], kColumnBits);
    if (SignInCone(cone, u) >= 0) column->u = u;
  }

  void SetDirection() {
    for (int i = 0; i < 6; ++i) {
      direction_.a[i] = 0;
      for (const Column& b : base_) direction_.a[i] += b.wrench.a[i];
    }
  }

  bool TakeIn(int k, const IntegerWrench& wrench, int (&row_of)[6], bool (&taken)[6]) {
    basis_.Transform(wrench, &alpha_);
    int row = k;
    if (taken[row] || alpha_[row] == 0) {
      row = 0;
      while (row < 6 && (taken[row] || alpha_[row] == 0)) ++row;
    }
    if (row == 6) return false;
    basis_.Pivot(row, alpha_, nullptr);
    taken[row] = true;
    row_of[k] = row;
    return true;
  }

  // The five columns and the direction; false where they are dependent.
  bool StartWhereDoublesEnded() {
    SetDirection();
    basis_.Reset();
    int row_of[6];
    bool taken[6] = {};
    for (int k = 0; k < 6; ++k) {
      const bool direction = k == found_.direction_row;
      if (!TakeIn(k, direction ? direction_ : column_[k].wrench, row_of, taken)) return false;
    }
    Column sorted[6];
    for (int k = 0; k < 6; ++k) sorted[row_of[k]] = column_[k];
    std::copy(std::begin(sorted), std::end(sorted), std::begin(current_));
    row_ = row_of[found_.direction_row];
    basis_.Transform(v_, &x_);
    return true;
  }

  // x >= 0 for tau = the least weight on the base, whose row the direction takes over.
  bool StartAtBase() {
    basis_.Reset();
    int row_of[6];
    bool taken[6] = {};
    for (int k = 0; k < 6; ++k) {
      if (!TakeIn(k, base_[k].wrench, row_of, taken)) return false;
    }
    base_spans_ = true;
    for (int k = 0; k < 6; ++k) current_[row_of[k]] = base_[k];
    basis_.Transform(v_, &x_);
    row_ = static_cast<int>(std::min_element(x_.begin(), x_.end()) - x_.begin());
    for (mpz_class& a : alpha_) a = basis_.determinant();
    basis_.Pivot(row_, alpha_, &x_);
    return true;
  }

  bool IsFeasible() const {
    for (int i = 0; i < 6; ++i) {
      if (i != row_ && x_[i] < 0) return false;
    }
    return true;
  }

  // Whether the forces in use span R^6. With a weight on each column of the basis they do, as a is
  // a sum of theirs; else it takes an independent base, which doubles only say it is.
  bool SpansAll() const {
    bool all = true;
    for (int i = 0; i < 6; ++i) all = all && (i == row_ || x_[i] > 0);
    if (all || base_spans_) return true;
    IntegerBasis basis;
    basis.Reset();
    Integer6 alpha;
    bool taken[6] = {};
    for (const Column& b : base_) {
      basis.Transform(b.wrench, &alpha);
      int row = 0;
      while (row < 6 && (taken[row] || alpha[row] == 0)) ++row;
      if (row == 6) return false;
      basis.Pivot(row, alpha, nullptr);
      taken[row] = true;
    }
    return true;
  }

  // y = minus the row of tau.
  void SetMultipliers() {
    for (int k = 0; k < 3; ++k) {
      y_f_[k] = -basis_.entry(row_, k);
      y_m_[k] = -basis_.entry(row_, k + 3);
    }
  }

  Step Judge() {
    const bool feasible = IsFeasible();
    const int sign = sgn(x_[row_]);
    if (sign > 0) {
      if (!feasible || !SpansAll()) return Step::kRestart;
      Hold(nullptr, 0);
      return Step::kDone;
    }
    SetMultipliers();
    Price();
    if (sign < 0 && (worst_ < 0 || Shift())) return Fail();
    if (sign == 0 && feasible && worst_ < 0) return Tie();
    return feasible ? Step::kImprove : Step::kRestart;
  }

  // The contact that y drives most; -1 where it drives none. Doubles of exact numbers say which,
  // and decide signs but near zero.
  void Price() {
    worst_ = -1;
    double highest = 0;
    long scale = std::numeric_limits<long>::min();
    for (std::size_t i = 0; i < e_.contacts.size(); ++i) {
      const int contact = static_cast<int>(i);
      const IntegerCone& cone = ConeOf(contact);
      const Integer3 g = SeenAt(e_, contact, y_f_, y_m_);
      long exponent;
      const Eigen::Vector3d seen = ToDoubles(g, &exponent);
      const double along = seen.dot(cone.n);
      const Eigen::Vector3d across = seen - along * cone.n;
      const double price = along + cone.mu * across.norm();
      // |seen| < 2, and seen and n are within 4 u of theirs: price is within 64 u (1 + mu).
      if (price < -1e-12 * (1 + cone.mu)) continue;
      if (IsNeverDriven(cone, g)) continue;
      const double value = std::max(price, 1e-300);
      const bool first = worst_ < 0;
      if (first || std::ldexp(value, static_cast<int>(
                                         std::clamp(exponent - scale, -2000L, 2000L))) > highest) {
        worst_ = contact, highest = value, scale = exponent, across_ = across;
      }
    }
  }

  Step Fail() {
    result_.verdict = Verdict::kFails;
    result_.separator = ToMetres(e_, y_f_, y_m_);
    return Step::kDone;
  }

  Step Tie() {
    result_.reason = StabilityReason::kBoundary;
    result_.separator = ToMetres(e_, y_f_, y_m_);
    AddForces(nullptr, 0);
    return Step::kDone;
  }

  void Hold(const Column* ray, const mpz_class& weight) {
    result_.verdict = Verdict::kHolds;
    AddForces(ray, weight);
  }

  void AddForce(const Column& column, const mpz_class& weight) {
    if (weight == 0) return;
    Rational share(weight, basis_.determinant());
    share.canonicalize();
    share *= e_.weight;
    exact::ContactForce& force = result_.forces.emplace_back();
    force.contact = column.contact;
    for (int k = 0; k < 3; ++k) force.f[k] = share * column.u[k];
  }

  void AddForces(const Column* ray, const mpz_class& weight) {
    for (const Column& b : base_) AddForce(b, x_[row_]);
    for (int i = 0; i < 6; ++i) {
      if (i != row_) AddForce(current_[i], x_[i]);
    }
    if (ray != nullptr) AddForce(*ray, weight);
  }

  // y + e z with the z that doubles found room with: y.v = -tau, so any e with e z.v > tau will do;
  // half of that.
  bool Shift() {
    if (!found_.has_room) return false;
    Integer3 z_f, z_m;
    for (int k = 0; k < 3; ++k) {
      z_f[k] = ToInteger(found_.room[k], kFloatBits);
      // y_m of scaled arms: arm/length = (arm in units) 2^unit/length.
      z_m[k] =
          ToInteger(found_.room[k + 3] * std::ldexp(1.0 / found_.length, e_.unit), 2 * kFloatBits);
      z_f[k] <<= kFloatBits;
    }
    const mpz_class loss = -Dot(z_f, e_.f);
    // A y + B z with B loss < A (-tau).
    mpz_class a = 1, b = 1;
    if (loss > 0) {
      const mpz_class gain = -x_[row_];
      const long bits = static_cast<long>(mpz_sizeinbase(gain.get_mpz_t(), 2)) -
                        static_cast<long>(mpz_sizeinbase(loss.get_mpz_t(), 2)) - 2;
      if (bits >= 0) b <<= static_cast<unsigned>(bits);
      if (bits < 0) a <<= static_cast<unsigned>(-bits);
    } else {
      b <<= static_cast<unsigned>(mpz_sizeinbase(basis_.determinant().get_mpz_t(), 2));
    }
    Integer3 y_f, y_m;
    for (int k = 0; k < 3; ++k) {
      y_f[k] = a * y_f_[k] + b * z_f[k];
      y_m[k] = a * y_m_[k] + b * z_m[k];
    }
    if (Dot(y_f, e_.f) <= 0 || !IsPolar(e_, y_f, y_m)) return false;
    y_f_ = std::move(y_f);
    y_m_ = std::move(y_m);
    return true;
  }

  // A column that raises tau: one that doubles ended with, or the extreme force that y sees.
  bool ChooseEntering(Column* entering) {
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
      basis_.Product(row_, waiting_[i].wrench, &sum_);
      if (sum_ >= 0) continue;
      *entering = std::move(waiting_[i]);
      waiting_.erase(waiting_.begin() + static_cast<long>(i));
      basis_.Transform(entering->wrench, &alpha_);
      return true;
    }
    entering->contact = worst_;
    SetExtreme(ConeOf(worst_), across_, entering);
    SetWrench(entering);
    basis_.Transform(entering->wrench, &alpha_);
    return alpha_[row_] < 0;
  }

  int ChooseLeaving() {
    int row = -1;
    for (int i = 0; i < 6; ++i) {
      if (i == row_ || alpha_[i] <= 0) continue;
      if (row >= 0) {
        sum_ = x_[i] * alpha_[row];
        mpz_submul(sum_.get_mpz_t(), x_[row].get_mpz_t(), alpha_[i].get_mpz_t());
        const int order = sgn(sum_);
        if (order > 0 || (order == 0 && alpha_[i] <= alpha_[row])) continue;
      }
      row = i;
    }
    return row;
  }

  // From x >= 0. False where it gives up.
  bool Climb() {
    for (int pivots = 0; pivots < kMaxPivots; ++pivots) {
      if (pivots > 0 || !waiting_.empty()) {
        const Step step = Judge();
        if (step != Step::kImprove) return step == Step::kDone;
      }
      Column entering;
      if (!ChooseEntering(&entering)) return false;
      const int row = ChooseLeaving();
      if (row < 0) {
        if (!SpansAll()) return false;
        GoAlong(entering);
        return true;
      }
      basis_.Pivot(row, alpha_, &x_);
      current_[row] = std::move(entering);
    }
    return false;
  }

  // tau grows without bound with the weight of a column: go where it is at least 1.
  void GoAlong(const Column& ray) {
    const mpz_class rate = -alpha_[row_];
    const mpz_class weight = mpz_class((basis_.determinant() - x_[row_]) / rate) + 1;
    for (int i = 0; i < 6; ++i) x_[i] -= weight * alpha_[i];
    Hold(&ray, weight * basis_.determinant());
  }

  const IntegerEquilibrium& e_;
  const SimplexEnd& found_;
  StabilityResult result_;
  IntegerWrench v_, direction_;
  Column base_[6];
  Column column_[6];   // that doubles ended with
  Column current_[6];  // of the basis, but for row_
  std::vector<Column> waiting_;
  IntegerBasis basis_;
  bool base_spans_ = false;  // proved
  int row_ = -1;             // of the direction
  Integer6 x_, alpha_;
  mpz_class sum_;
  Integer3 y_f_, y_m_;
  int worst_ = -1;
  Eigen::Vector3d across_ = Eigen::Vector3d::Zero();
};

}  // namespace

std::optional<StabilityResult> DecideBySimplex(const IntegerEquilibrium& e,
                                               const SimplexEnd& found) {
  return RoundSimplex(e, found).Decide();
}

}  // namespace cguide::numeric
