// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cguide/verify/check/certificate.h"

namespace cguide::check {

struct CheckOptions {
  /** 0: ends of intervals are doubles; else MPFR numbers of so many bits, 53 to 4096. */
  int precise_bits = 0;
  /** Proofs have to hold for every model in this box. CheckCertificate takes the certificate's. */
  Robustness robust;
};

/** Re-checks proofs of edges of one model. Keeps a copy of the model, and scratch: one per thread.

 For each edge it derives from the model what has to be shown (every shape against every piece and
 every self pair, contact or static stability, for all s in [0,1]) and evaluates the proof's planes,
 contacts and forces in intervals of its own; nothing is searched, no distance is computed, no
 linear program solved. A proof that does not show everything is refused; which ones are accepted
 may depend on the precision, never whether they are true. */
class Checker {
 public:
  /** @throws Error where RequireCheckable refuses the model, or this thread's doubles are not
   rounded to nearest with gradual underflow. */
  explicit Checker(const Model& model, const CheckOptions& options = {});
  ~Checker();
  Checker(Checker&&) noexcept;
  Checker& operator=(Checker&&) noexcept;

  /** Empty where the proof shows that every real configuration of the edge is in C_guide but for
   joint limits; else what is not shown, and where. @throws Error where the edge does not fit the
   robot, or as the constructor does. */
  std::string CheckEdge(const Edge& edge, const EdgeProof& proof);

  struct State;

 private:
  std::unique_ptr<State> state_;
};

/** Whether a waypoint keeps all joint limits, mimic joints included; over Q. They hold on an edge
 iff they hold at its ends. Empty, or the joint that does not. */
std::string CheckLimits(const Robot& robot, const Configuration& q);

/** What became of a certificate. */
struct CheckReport {
  int edges = 0;                     ///< of the path
  int proved = 0;                    ///< whose proof holds
  std::vector<std::string> refused;  ///< one line for each limit or proof that does not hold
  std::vector<int> missing;          ///< edges without a proof
  /** For each edge: its proof holds and its ends are within limits, so all of it is in C_guide. */
  std::vector<bool> in_guide;
  /** Every edge is proved, every waypoint within limits: the path is in C_guide from start to goal.
   */
  bool IsProved() const { return refused.empty() && missing.empty(); }
};

/** Checks all of a certificate. @throws Error where its path does not fit its model (CheckPath). */
CheckReport CheckCertificate(const Certificate& certificate, const CheckOptions& options = {});

}  // namespace cguide::check
