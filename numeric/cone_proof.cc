#include <algorithm>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/cone_exact_internal.h"

// What proves a membership, over Q.
namespace cguide::numeric {

using exact::Membership;

Rational WeightOf(const mpz_class& numerator, const mpz_class& denominator, long shift) {
  Rational weight(numerator, denominator);
  weight.canonicalize();
  if (shift >= 0) {
    weight <<= static_cast<unsigned long>(shift);
  } else {
    weight >>= static_cast<unsigned long>(-shift);
  }
  return weight;
}

// tau on the base, the basic weights, and that of the ray. Weights of integer columns become those
// of generators by powers of two.
void ExactDecider::ReportWeights(const mpz_class& tau, int ray, const mpz_class& ray_weight,
                                 exact::ConeMembership* result) {
  int used[16], *end = used;
  for (int i = 0; i < 6; ++i) {
    if (index_[i] >= 0) *end++ = index_[i];
    if (base_[i] >= 0 && tau != 0) *end++ = base_[i];
  }
  if (ray >= 0) *end++ = ray;
  std::sort(used, end);
  end = std::unique(used, end);
  for (const int* j = used; j != end; ++j) {
    n_.sum = 0;
    if (*j == ray) n_.sum += ray_weight;
    for (int i = 0; i < 6; ++i) {
      if (index_[i] == *j) n_.sum += n_.x[i];
      if (base_[i] == *j) n_.sum += tau;
    }
    if (n_.sum == 0) continue;
    result->index.push_back(*j);
    result->weight.push_back(
        WeightOf(n_.sum, n_.basis.determinant(), Column(*j).exponent - n_.demand.exponent));
  }
}

namespace {

/** The weights of v on six generators, by integer elimination. */
exact::ConeMembership ExactWeights(const WrenchCone& cone, const WrenchDemand& v,
                                   const ConeAnswer& answer) {
  IntegerWrench demand, columns[6];
  IntegerDemand(v, 0, &demand);
  IntegerBasis basis;
  basis.Reset();
  exact::ConeMembership proof;
  proof.where = Membership::kInterior;
  int row_of[6];
  bool taken[6] = {};
  Integer6 alpha;
  for (int k = 0; k < 6; ++k) {
    IntegerColumn(cone, answer.basis[k], 0, &columns[k]);
    basis.Transform(columns[k], &alpha);
    int row = 0;
    while (row < 6 && (taken[row] || alpha[row] == 0)) ++row;
    if (row == 6) throw Error(Error::Code::kInternal, "a proven basis is singular");
    basis.Pivot(row, alpha, nullptr);
    taken[row] = true;
    row_of[k] = row;
  }
  basis.Transform(demand, &alpha);
  for (int k = 0; k < 6; ++k) {
    proof.index.push_back(answer.basis[k]);
    proof.weight.push_back(
        WeightOf(alpha[row_of[k]], basis.determinant(), columns[k].exponent - demand.exponent));
  }
  return proof;
}

}  // namespace

exact::ConeMembership ExactProof(const WrenchCone& cone, const WrenchDemand& v,
                                 const ConeAnswer& answer) {
  if (answer.proof) return *answer.proof;
  if (answer.where == Membership::kInterior) return ExactWeights(cone, v, answer);
  exact::ConeMembership proof;
  proof.where = answer.where;
  proof.y.resize(6);
  for (int k = 0; k < 6; ++k) proof.y[k] = Lift(answer.y[k]);
  return proof;
}

}  // namespace cguide::numeric
