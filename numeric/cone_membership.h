#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "cguide/exact/cone_membership.h"
#include "cguide/numeric/wrench_cone.h"

namespace cguide::numeric {

enum class ConeStage { kFast, kExact };

/** Where a wrench lies with respect to a cone, and what proves it. */
struct ConeAnswer {
  exact::Membership where = exact::Membership::kOutside;
  ConeStage stage = ConeStage::kFast;

  /** kFast, interior: six generators that provably are independent and of which the wrench is a
   combination with positive weights; `weight` is that combination up to rounding. */
  std::array<int, 6> basis{-1, -1, -1, -1, -1, -1};
  WrenchCone::Vector6d weight = WrenchCone::Vector6d::Zero();

  /** kFast, outside: y.a < 0 for every generator that is not zero, and y.v > 0, for y as stored. */
  WrenchCone::Vector6d y = WrenchCone::Vector6d::Zero();

  std::optional<exact::ConeMembership> proof;  ///< kExact
  int pivots = 0;                              ///< of the float simplex
};

/** Scratch of one thread: buffers alone, nothing of one question is used in the next. */
class ConeWorkspace {
 public:
  ConeWorkspace();
  ~ConeWorkspace();
  ConeWorkspace(ConeWorkspace&&) noexcept;
  ConeWorkspace& operator=(ConeWorkspace&&) noexcept;

  struct Scratch;   // numeric/cone_simplex_internal.h
  struct Integers;  // numeric/cone_exact_internal.h
  std::unique_ptr<Scratch> scratch;
};

/** Decides in doubles with a proven bound whether v is in the interior of the cone or outside the
 closed cone, or declines: a dense phase-1 simplex proposes a basis or a separating vector, and the
 tests in cone_certificates.cc and cone_separation.cc decide. Declined: ties, whatever rounding
 cannot tell from one, cones of rank below 6 that hold v, cones with a line that do not, numbers
 that are not finite or beyond 2^+-900.
 @throws Error where the thread does not round to nearest. */
std::optional<ConeAnswer> TryConeMembership(const WrenchCone& cone, const WrenchDemand& v,
                                            ConeWorkspace* workspace);

/** TryConeMembership, else the exact stage: an integer simplex that keeps one common denominator
 [Edmonds 1967; Bareiss 1968; Avis, Fukuda 1992] and starts from the float basis, often its last one
 too. It decides every case, boundary included, with a proof that exact::CheckConeMembership
 accepts.
 @throws Error where a number is not finite. */
ConeAnswer ConeMembership(const WrenchCone& cone, const WrenchDemand& v, ConeWorkspace* workspace);

/** The proof of an answer over Q: the exact stage's own, or that of a fast answer recomputed
 exactly.
 @post exact::CheckConeMembership(cone.ExactColumns(), v.Exact(), result). */
exact::ConeMembership ExactProof(const WrenchCone& cone, const WrenchDemand& v,
                                 const ConeAnswer& answer);

/** Many questions about one cone: remembers proven bases and separating vectors and asks them
 first, so that coherent questions cost a few products. Answers are those of ConeMembership, proofs
 may be others. One thread; refers to the cone. */
class ConeBatch {
 public:
  explicit ConeBatch(const WrenchCone& cone);
  ~ConeBatch();
  ConeBatch(ConeBatch&&) noexcept;

  ConeAnswer Membership(const WrenchDemand& v);

  long remembered() const { return remembered_; }  ///< answers given from memory

 private:
  struct Memory;
  const WrenchCone* cone_;
  ConeWorkspace workspace_;
  std::unique_ptr<Memory> memory_;
  long remembered_ = 0;
};

}  // namespace cguide::numeric
