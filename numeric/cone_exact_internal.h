#pragma once

#include <gmpxx.h>

#include <array>
#include <vector>

#include "cguide/numeric/cone_simplex_internal.h"

namespace cguide::numeric {

using Integer6 = std::array<mpz_class, 6>;

/** A wrench (f, m) as integers: a = (f, m 2^-unit) 2^exponent. The same `unit`, at most 0, for all
 wrenches of a question is a change of coordinates, which keeps cones and what is in them; that of
 the points' last bits spares the forces as many zeros. */
struct IntegerWrench {
  Integer6 a;
  long exponent = 0;
};

void ToInteger(const AppliedForce& force, int unit, IntegerWrench* result);
void ToInteger(const WrenchCone::Vector6d& wrench, int unit, IntegerWrench* result);

inline void IntegerColumn(const WrenchCone& cone, int j, int unit, IntegerWrench* result) {
  if (cone.forces().empty()) {
    ToInteger(cone.wrenches()[j], unit, result);
  } else {
    ToInteger(cone.forces()[j], unit, result);
  }
}
inline void IntegerDemand(const WrenchDemand& v, int unit, IntegerWrench* result) {
  if (v.is_force()) {
    ToInteger(v.force(), unit, result);
  } else {
    ToInteger(v.wrench(), unit, result);
  }
}

/** The exponent of the last bit of the coordinates of p, 0 where that is positive. */
int LastBit(const Eigen::Vector3d& p);

/** A basis of R^6 with its inverse times the determinant: B^-1 = inverse/determinant, all integers,
 determinant > 0. Unit columns stand where no generator has been taken in yet. */
class IntegerBasis {
 public:
  /** The unit columns. */
  void Reset();

  const mpz_class& entry(int row, int k) const { return m_[row][k]; }
  const Integer6& row(int row) const { return m_[row]; }
  const mpz_class& determinant() const { return d_; }

  /** row . a */
  void Product(int row, const IntegerWrench& a, mpz_class* result) const;

  /** determinant * B^-1 a */
  void Transform(const IntegerWrench& a, Integer6* result) const;

  /** Brings in the column with the given transform, in place of that of `row`; alpha[row] != 0. By
   Cramer's rule the new entries (m_k alpha_row - alpha_k m_row)/d are integers again [Edmonds
   1967]. The transform x of a wrench that is kept is brought up to date likewise. */
  void Pivot(int row, const Integer6& alpha, Integer6* x);

 private:
  void Update(mpz_class* entry, const mpz_class& alpha_row, const mpz_class& alpha,
              const mpz_class& row_entry);

  std::array<Integer6, 6> m_;
  mpz_class d_ = 1;
  mpz_class product_;
};

/** Buffers of the exact stage: what GMP has allocated is used again. */
struct ConeWorkspace::Integers {
  IntegerWrench demand;
  IntegerBasis basis;
  Integer6 x;  ///< determinant * B^-1 demand
  Integer6 alpha, y;
  mpz_class sum;
  std::vector<IntegerWrench> columns;  ///< those asked for, and what an earlier question left
  int used = 0;                        ///< of them, in this question
  std::vector<int> column_of;          ///< of a generator, -1: not yet asked for
};

/** Signs of y.a_j, by doubles where they tell: those of price_j beyond +-error. */
struct SignFilter {
  double y[6] = {};
  double error = 0;

  SignFilter(const WrenchCone& cone, const Integer6& exact, int unit);
};

/** numerator/denominator * 2^shift */
Rational WeightOf(const mpz_class& numerator, const mpz_class& denominator, long shift);

/** One question of the exact stage. */
class ExactDecider {
 public:
  ExactDecider(const WrenchCone& cone, const WrenchDemand& v, ConeWorkspace::Scratch* scratch);

  exact::ConeMembership Run();

 private:
  static constexpr int kUnitColumn = -1;  // a row's own
  static constexpr int kDirection = -2;   // the column a, with weight tau

  void ChooseUnit(const WrenchDemand& v);
  const IntegerWrench& Column(int j);
  void TakeIn(int j, int preferred_row, Integer6* x);
  bool SeparatesByUnits(exact::ConeMembership* result);
  bool Complete(exact::ConeMembership* result);
  bool DecidesBasis(exact::ConeMembership* result);
  void StartTau();
  void Maximise(exact::ConeMembership* result);
  void GoAlong(int ray, exact::ConeMembership* result);
  int FindImproving(bool lowest_index);
  int ChooseLeaving(bool lowest_index);

  bool IsNonPositive(const Integer6& y);
  void SetToRow(int row, bool negative, Integer6* y) const;
  void PassOver();
  void Conclude(exact::ConeMembership* result);
  void ReportWeights(const mpz_class& tau, int ray, const mpz_class& ray_weight,
                     exact::ConeMembership* result);
  void ReportSeparator(const Integer6& y, exact::ConeMembership* result) const;

  const WrenchCone& cone_;
  const ConeProposal& proposal_;
  ConeWorkspace::Integers& n_;
  std::vector<double>& price_;
  int unit_ = 0;
  int index_[6];
  int base_[6];         // the generators in a, all w_k = 1 for the integer columns
  int direction_ = -1;  // the row where tau is basic
  bool deficient_ = false;
};

}  // namespace cguide::numeric
