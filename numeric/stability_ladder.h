#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cguide/exact/contact.h"
#include "cguide/numeric/membership.h"

namespace cguide::numeric {

/** The rungs that a question about the stability of a configuration climbs. */
enum class StabilityRung {
  kFast,     ///< FindContacts and TryStability: doubles with a proven bound
  kStored,   ///< exact::DecideStability on the stored contacts, where they have no errors, or no
             ///< MPFR rung can follow and its proof carries their errors
  kBits106,  ///< exact contacts of the MPFR placement of 106 bits, pyramids of 4 and 8 sides
  kBits256,  ///< likewise of 256 bits, pyramids of up to 64 sides
  kUndecided
};

/** How many answers each rung gave. */
struct StabilityRungCounts {
  long count[5] = {0, 0, 0, 0, 0};
  long& operator[](StabilityRung rung) { return count[static_cast<int>(rung)]; }
  long operator[](StabilityRung rung) const { return count[static_cast<int>(rung)]; }
};

/** The stability of a configuration, and what settled it. */
struct LadderedStability {
  /** From kFast and kStored as Stability gives it. From the MPFR rungs the verdict, and where it
   fails the separating wrench rounded to doubles; `exact` is the proof. */
  StabilityAnswer answer;
  StabilityRung rung = StabilityRung::kUndecided;
  std::string reason;             ///< one clause for the user where undecided, else empty
  std::vector<Contact> contacts;  ///< of the rung that spoke last, rounded to doubles
  /** A balance where kHolds and on a boundary that is proved, rounded; indices into `contacts`. On
   a boundary of rank 6 `answer` has the wrench y that supports the cone: y.a <= 0 = y.v. */
  std::vector<WitnessForce> forces;
  /** Bound on how far the contacts and the centre of mass that the last rung saw are from the
   truth (m): the largest of their errors. */
  double width = 0;
  std::optional<exact::StabilityResult> exact;  ///< of the last exact rung, where one was asked
};

/** Decides the static stability of configurations of one world. Immutable, shared by threads. */
class StabilityLadder {
 public:
  explicit StabilityLadder(const World& world);

  /** Decides for q, which is the configuration placed last in the workspace; fills
   workspace->contacts with the float ones. Each rung is asked only if the one before declined; the
   answer is a function of the world and q.

   kHolds, kFails: for the real numbers that the doubles of q stand for (DESIGN part 2). kUndecided:
   the reason names the boundary and its rank where contacts and CoM are known exactly, and
   otherwise how well they are known at the last rung. Under ContactModel::kNearest only the first
   two rungs exist. The MPFR rungs take tens of milliseconds, and seconds where they stay
   undecided. */
  LadderedStability Decide(const Configuration& q, GuideWorkspace* workspace) const;

  /** One MPFR rung alone. @throws Error under ContactModel::kNearest. */
  LadderedStability DecideAt(const Configuration& q, int bits, int max_sides = 64) const;

 private:
  const World* world_;
  std::optional<exact::ContactScene> scene_;
};

}  // namespace cguide::numeric
