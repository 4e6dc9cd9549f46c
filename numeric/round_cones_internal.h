#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cguide/exact/equilibrium.h"
#include "cguide/numeric/integer_vector_internal.h"
#include "cguide/numeric/stability_contacts_internal.h"

// The stored contacts of a question of static stability over the integers, for its exact stage.
namespace cguide::numeric {

struct RoundBuffers;  // round_simplex_internal.h

/** A revolution cone: u with s = u.w >= 0 and s^2 (mu_den + mu_num) >= |u|^2 ww mu_den. */
struct IntegerCone {
  Integer3 w;          ///< the normal, any length
  mpz_class ww;        ///< |w|^2
  mpz_class num, den;  ///< mu^2 = num / den
  mpz_class sum;       ///< num + den
  double mu = 0;
  Eigen::Vector3d n = Eigen::Vector3d::Zero();  ///< w/|w| in doubles, within 4 u
};

/** The contacts about the centre of mass. */
struct IntegerEquilibrium {
  struct Contact {
    Integer3 arm;       ///< times 2^unit: metres
    Eigen::Vector3d r;  ///< arm in doubles, each entry within 2 u of its own
    int cone = -1;
  };
  std::vector<Contact> contacts;
  std::vector<IntegerCone> cones;  ///< neighbours that have the same share it
  int unit = 0;
  Integer3 f;       ///< the direction of -g
  Rational weight;  ///< -m g = weight f
};

/** Whether the numbers of the first `count` scaled contacts are of sizes that integers can hold
 together; fills the result then. */
bool LiftEquilibrium(const StabilityQuery& query, const ScaledContacts& scaled, int count,
                     IntegerEquilibrium* result);

/** The sign of s^2 (1 + mu^2) - |u|^2 |w|^2 where s = u.w > 0: positive inside the cone, 0 on its
 boundary; negative for every other u but 0. */
int SignInCone(const IntegerCone& cone, const Integer3& u);

/** Whether g.u <= 0 for every force u of the cone; exact::IsNeverDrivenBy over integers. */
bool IsNeverDriven(const IntegerCone& cone, const Integer3& g);

/** y_f + y_m x arm, what the wrench y sees at a contact, with arms in units. */
Integer3 SeenAt(const IntegerEquilibrium& e, int contact, const Integer3& y_f, const Integer3& y_m);

/** What doubles can say of a wrench y and the cones: most contacts are far from being driven. */
class DrivenFilter {
 public:
  DrivenFilter(const IntegerEquilibrium& e, const Integer3& y_f, const Integer3& y_m);

  /** True only where y is below 0 on all wrenches of the contact. */
  bool IsFarFromDriven(int contact) const;

 private:
  const IntegerEquilibrium& e_;
  Eigen::Vector3d y_f_, y_m_;  // times one power of two
};

/** Whether y is at most 0 on the wrenches of all contacts. */
bool IsPolar(const IntegerEquilibrium& e, const Integer3& y_f, const Integer3& y_m);

/** Dimension of the span of the wrenches of all admissible forces; nothing where contacts without
 friction ask for more than a look at their points. */
std::optional<int> RankOf(const IntegerEquilibrium& e);

/** Whether all normals are stored as the same. */
bool IsEven(const IntegerEquilibrium& e);

/** y with arms in metres. */
Vector6q ToMetres(const IntegerEquilibrium& e, const Integer3& y_f, const Integer3& y_m);

/** x 2^-exponent in doubles within 2 u of each entry, the largest in [1/2, 1); zero stays zero. */
Eigen::Vector3d ToDoubles(const Integer3& x, long* exponent);

/** Decides where forces along the weight itself do, or show how: parallel_forces.cc. */
std::optional<exact::StabilityResult> DecideByParallelForces(const IntegerEquilibrium& e);

/** Decides from where the simplex on doubles ended, or gives up: round_simplex.cc. Rank 6 alone. */
std::optional<exact::StabilityResult> DecideBySimplex(const IntegerEquilibrium& e,
                                                      const SimplexEnd& found,
                                                      RoundBuffers* buffers);

}  // namespace cguide::numeric
