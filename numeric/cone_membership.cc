#include "cguide/numeric/cone_membership.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/cone_simplex_internal.h"

namespace cguide::numeric {
namespace {

using Vector6d = WrenchCone::Vector6d;
using exact::Membership;

/** Weights of the generators as given, from those of scaled columns. */
void ReportBasis(const WrenchCone& cone, const WrenchDemand& v, const int (&basis)[6],
                 const double (&x)[8], ConeAnswer* answer) {
  answer->where = Membership::kInterior;
  const double unscale = std::ldexp(1.0, v.scale_exponent());
  for (int k = 0; k < 6; ++k) {
    answer->basis[k] = basis[k];
    answer->weight[k] = x[k] * cone.scale(basis[k]) * unscale;
  }
}

bool CanTry(const WrenchCone& cone, const WrenchDemand& v) {
  return cone.is_finite() && cone.in_range() && v.is_finite() && v.in_range();
}

}  // namespace

ConeWorkspace::ConeWorkspace() : scratch(std::make_unique<Scratch>()) {}
ConeWorkspace::~ConeWorkspace() = default;
ConeWorkspace::ConeWorkspace(ConeWorkspace&&) noexcept = default;
ConeWorkspace& ConeWorkspace::operator=(ConeWorkspace&&) noexcept = default;

std::optional<ConeAnswer> TryConeMembership(const WrenchCone& cone, const WrenchDemand& v,
                                            ConeWorkspace* workspace) {
  RequireRoundToNearest();
  ConeWorkspace::Scratch* scratch = workspace->scratch.get();
  ConeProposal& p = scratch->proposal;
  if (!CanTry(cone, v) || v.scaled().isZero(0)) {
    p = ConeProposal{};  // the exact stage starts from what is here
    return std::nullopt;
  }
  SolvePhaseOne(cone, v, scratch);
  ConeAnswer answer;
  answer.pivots = p.pivots;
  if (p.feasible) {
    if (!p.full_rank || !ProveInterior(cone, v, &p)) return std::nullopt;
    ReportBasis(cone, v, p.basis, p.x, &answer);
    return answer;
  }
  if (!ProveOutside(cone, v, scratch, &answer.y)) return std::nullopt;
  answer.where = Membership::kOutside;
  return answer;
}

ConeAnswer ConeMembership(const WrenchCone& cone, const WrenchDemand& v, ConeWorkspace* workspace) {
  Require(cone.is_finite() && v.is_finite(), "a wrench has a number that is NaN or infinite");
  if (auto answer = TryConeMembership(cone, v, workspace)) return *std::move(answer);
  ConeAnswer answer;
  answer.stage = ConeStage::kExact;
  answer.pivots = workspace->scratch->proposal.pivots;
  answer.proof = DecideExactly(cone, v, workspace->scratch.get());
  answer.where = answer.proof->where;
  return answer;
}

/** Proven once, asked again. */
struct ConeBatch::Memory {
  struct Basis {
    int index[6];
    Matrix6 inverse;
    double kappa;
  };
  static constexpr std::size_t kCapacity = 8;
  std::vector<Basis> bases;  ///< last used first
  std::vector<Vector6d> cuts;
};

ConeBatch::ConeBatch(const WrenchCone& cone) : cone_(&cone), memory_(std::make_unique<Memory>()) {}
ConeBatch::~ConeBatch() = default;
ConeBatch::ConeBatch(ConeBatch&&) noexcept = default;

ConeAnswer ConeBatch::Membership(const WrenchDemand& v) {
  ConeAnswer answer;
  if (CanTry(*cone_, v)) {
    RequireRoundToNearest();
    auto& bases = memory_->bases;
    for (std::size_t i = 0; i < bases.size(); ++i) {
      double x[8];
      if (!ProvePositive(*cone_, bases[i].index, bases[i].inverse, bases[i].kappa, v, x)) continue;
      ReportBasis(*cone_, v, bases[i].index, x, &answer);
      std::rotate(bases.begin(), bases.begin() + static_cast<long>(i),
                  bases.begin() + static_cast<long>(i) + 1);
      ++remembered_;
      return answer;
    }
    for (Vector6d& cut : memory_->cuts) {
      if (!ProvePositiveProduct(cut, v)) continue;
      answer.where = Membership::kOutside;
      answer.y = cut;
      std::swap(cut, memory_->cuts.front());
      ++remembered_;
      return answer;
    }
  }
  answer = ConeMembership(*cone_, v, &workspace_);
  if (answer.stage != ConeStage::kFast) return answer;
  if (answer.where == Membership::kOutside) {
    if (memory_->cuts.size() == Memory::kCapacity) memory_->cuts.pop_back();
    memory_->cuts.insert(memory_->cuts.begin(), answer.y);
    return answer;
  }
  if (memory_->bases.size() == Memory::kCapacity) memory_->bases.pop_back();
  const ConeProposal& p = workspace_.scratch->proposal;
  Memory::Basis basis;
  std::copy(std::begin(p.basis), std::end(p.basis), std::begin(basis.index));
  basis.inverse = p.inverse;
  basis.kappa = BoundKappa(*cone_, p.basis, p.inverse);
  memory_->bases.insert(memory_->bases.begin(), basis);
  return answer;
}

}  // namespace cguide::numeric
