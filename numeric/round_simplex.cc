#include <algorithm>

#include "cguide/numeric/round_simplex_internal.h"

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
//
// Most ties need none of that: round_corner.cc asks the columns of doubles alone first.
namespace cguide::numeric {
namespace {

using exact::StabilityReason;
using exact::StabilityResult;

constexpr int kMaxPivots = 40;

class RoundSimplex {
 public:
  RoundSimplex(const IntegerEquilibrium& e, const SimplexEnd& found) : e_(e), found_(found) {
    for (int k = 0; k < 3; ++k) v_.a[k] = e.f[k], v_.a[k + 3] = 0;
  }

  std::optional<StabilityResult> Decide() {
    result_.rank = 6;
    for (int k = 0; k < 6; ++k) {
      if (!SetColumn(e_, found_.base[k], &base_[k])) return std::nullopt;
      if (k != found_.direction_row && !SetColumn(e_, found_.column[k], &column_[k])) {
        return std::nullopt;
      }
    }
    if (StartWhereDoublesEnded()) {
      const Step step = Judge();
      if (step == Step::kDone) return std::move(result_);
      if (step == Step::kImprove && Climb()) return std::move(result_);
      if (step != Step::kRestart) return std::nullopt;
    }
    for (int k = 0; k < 6; ++k) {
      if (k != found_.direction_row) waiting_.push_back(column_[k]);
    }
    if (StartAtBase() && Climb()) return std::move(result_);
    return std::nullopt;
  }

 private:
  enum class Step { kDone, kImprove, kRestart };

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
    worst_ = FindDriven(e_, y_f_, y_m_);
    const bool separates = worst_.contact < 0;
    if (sign < 0 && (separates || ShiftIntoRoom(e_, found_, &y_f_, &y_m_))) return Fail();
    if (sign == 0 && feasible && separates) return Tie();
    return feasible ? Step::kImprove : Step::kRestart;
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
    AppendForce(e_, column, weight, basis_.determinant(), &result_);
  }

  void AddForces(const Column* ray, const mpz_class& weight) {
    for (const Column& b : base_) AddForce(b, x_[row_]);
    for (int i = 0; i < 6; ++i) {
      if (i != row_) AddForce(current_[i], x_[i]);
    }
    if (ray != nullptr) AddForce(*ray, weight);
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
    SetExtremeColumn(e_, worst_.contact, worst_.across, entering);
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
  DrivenContact worst_;
};

}  // namespace

std::optional<StabilityResult> DecideBySimplex(const IntegerEquilibrium& e, const SimplexEnd& found,
                                               RoundBuffers* buffers) {
  if (RankOf(e) != 6 || found.direction_row < 0) return std::nullopt;
  if (auto result = DecideAtCorner(e, found, buffers)) return result;
  return RoundSimplex(e, found).Decide();
}

}  // namespace cguide::numeric
