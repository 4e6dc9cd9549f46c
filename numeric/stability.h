#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/exact/equilibrium.h"
#include "cguide/numeric/contact.h"
#include "cguide/numeric/fp_guard.h"

namespace cguide::numeric {

/** Static stability of one placed configuration (DESIGN part 2, [Bouyarmane 2009, Def. 2]): can
 admissible contact forces balance gravity at the centre of mass? */
struct StabilityQuery {
  std::span<const Contact> contacts;
  Eigen::Vector3d com_W = Eigen::Vector3d::Zero();
  double com_error = 0;  ///< bound on the error of com_W (m)
  double mass = 0;       ///< kg, > 0; scales the forces and has no influence on the verdict
  Eigen::Vector3d gravity_W{0, 0, -9.81};
  int generators = 4;  ///< sides of the pyramids of the margins; TryStability uses the round cones
};

/** One contact force of a balance. */
struct WitnessForce {
  int contact = -1;                               ///< index into the query's contacts
  Eigen::Vector3d u_W = Eigen::Vector3d::Zero();  ///< direction (not unit), u.n = 1 up to rounding
  double weight = 0;                              ///< N per unit of u, > 0
};

/** Balance found in floats: sum weight u = -m g and sum weight (p - c) x u = 0 up to rounding. The
 first six generators span the space of wrenches, and their weights stay positive when the residual
 is made exactly zero by them. Each u lies in the real friction cone whatever the contact's error,
 except where mu is too small for its error (or zero): there u = n_W stands for the real normal. */
struct ForceWitness {
  static constexpr int kCapacity = 12;
  std::array<WitnessForce, kCapacity> force;
  int size = 0;
  const WitnessForce* begin() const { return force.data(); }
  const WitnessForce* end() const { return force.data() + size; }
};

/** A wrench direction y = (y_f, y_m) with y_f.u + y_m.((p - c) x u) <= 0 for every admissible u of
 every contact that may be active, and y.v > 0 for v = (-m g, 0): moments about the centre of mass,
 in W. */
struct SeparatingWrench {
  Eigen::Matrix<double, 6, 1> y = Eigen::Matrix<double, 6, 1>::Zero();
};

struct StabilityAnswer {
  Verdict verdict = Verdict::kUndecided;
  ForceWitness forces;         ///< filled where kHolds
  SeparatingWrench separator;  ///< filled where kFails
  int pivots = 0;              ///< of the simplex, its six starting ones included
};

/** Scratch of one thread: buffers only. Nothing learnt from one query is used in the next, so that
 an answer is a function of its query, whatever the number of threads. */
class StabilityWorkspace {
 public:
  StabilityWorkspace();
  ~StabilityWorkspace();
  StabilityWorkspace(StabilityWorkspace&&) noexcept;
  StabilityWorkspace& operator=(StabilityWorkspace&&) noexcept;

  struct Scratch;  // numeric/stability_contacts_internal.h
  std::unique_ptr<Scratch> scratch;
};

/** Decides in doubles with a proven bound, or declines (kUndecided).

 kHolds: for every configuration within the stated errors, -(m g, c x m g) is in the interior of the
 wrench cone of the true revolution cones of the certain contacts. kFails: for every such
 configuration it is outside the closed wrench cone of all contacts, those that only may be active
 included. Proofs above the functions in stability_certificates.cc.
 Exact ties, a wrench cone of rank < 6 that contains the wrench, and anything nearer to a tie than
 the errors allow are declined. Not finite, or without mass or gravity: declined. Allocates only
 while the workspace grows. */
StabilityAnswer TryStability(const StabilityQuery& query, StabilityWorkspace* workspace);

/** What settled a question of static stability. */
enum class StabilityStage { kFast, kExact, kUndecided };

struct SettledStability {
  StabilityAnswer answer;
  StabilityStage stage = StabilityStage::kUndecided;
  std::string reason;  ///< one clause for the user where undecided, else empty
  /** The exact verdict on the stored contacts and its proof, where the exact stage was asked; its
   contact indices are into the query, and `sides` is 0 where no pyramids were needed. `answer`
   holds the same rounded to doubles. */
  std::optional<exact::StabilityResult> exact;
};

/** TryStability, else the exact stage on the stored contacts: over integers by forces along the
 weight and by the simplex from where doubles left it, against the round cones themselves; what that
 leaves open by exact::DecideStability. Where the twin decides the verdict is the twin's, with a
 proof that the same checkers accept.

 An exact verdict is about the stored numbers, which are not the real ones: it counts where they are
 exact (no contact error, no CoM error, point sites), and otherwise only if its forces or its
 separating wrench, rounded to doubles, pass the same certificates as TryStability's, which carry
 the stated errors. Else the answer is kUndecided with the reason: a boundary, a rank below 6, or a
 tie closer than the errors. The exact stage takes tens of microseconds, beside a tie on slopes and
 walls a few hundred, and milliseconds where the twin is asked: ranks below 6 and numbers out of
 range. */
SettledStability Stability(const StabilityQuery& query, StabilityWorkspace* workspace);

/** Bound on |n_W - the real normal| of a contact; infinite where its errors allow any normal. */
double NormalError(const Contact& contact);

}  // namespace cguide::numeric
