#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "cguide/numeric/friction.h"
#include "cguide/numeric/stability.h"

// Shared by the proposing simplex and the deciding certificates of TryStability.
namespace cguide::numeric {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/** The contacts of a query, scaled and in structure-of-arrays form: arms from the centre of mass in
 units of `length`. A wrench is (f, r x f) with these arms. */
struct ScaledContacts {
  int count = 0;
  int num_certain = 0;  ///< usable for a balance; they come first
  double length = 1;    ///< m, a power of two: scaling by it is exact
  /** Direction of the wrench to be balanced, (v_f, 0): -g scaled by a power of two. */
  Eigen::Vector3d v_f = Eigen::Vector3d::Zero();
  double v_scale = 1;  ///< v_f * v_scale = -m g

  std::vector<double> rx, ry, rz;  ///< arm of the force point
  std::vector<double> nx, ny, nz;  ///< n_W
  /** Friction, reduced so that n + mu t is admissible for every real normal; 0 where that is not
   possible. */
  std::vector<double> mu;
  std::vector<double> true_mu;
  std::vector<double> normal_error;  ///< bound on |n - n_real|; may be infinite
  std::vector<double> arm_error;     ///< bound on |r - r_real|, rounding of r included
  std::vector<int> index;            ///< into the query's contacts

  Eigen::Vector3d arm(int i) const { return {rx[i], ry[i], rz[i]}; }
  Eigen::Vector3d normal(int i) const { return {nx[i], ny[i], nz[i]}; }
};

/** Makes room for n contacts and counts them. */
void Resize(int n, ScaledContacts* contacts);

/** Fills `contacts`. @return false where a number is not finite, mass is not positive or gravity is
 zero. Bounds are derived in stability_contacts.cc. */
bool ScaleContacts(const StabilityQuery& query, ScaledContacts* contacts);

/** Fills `contacts` with those of the query alone that `which` names, in units of `length`, a power
 of two. What ProveInterior proves of them holds for all. @return false also where one of them is of
 no use for a balance or an arm is not below `length`. */
bool ScaleSome(const StabilityQuery& query, std::span<const int> which, double length,
               ScaledContacts* contacts);

/** A force direction at a contact and its wrench. */
struct Generator {
  int contact = -1;  ///< index into ScaledContacts; negative for an artificial column
  Eigen::Vector3d u = Eigen::Vector3d::Zero();
  Vector6d wrench = Vector6d::Zero();
};

/** v = sum_k weight[k] base[k] + sum_j extra_weight[j] extra[j], up to rounding. */
struct Balance {
  Generator base[6];
  double weight[6];
  Matrix6d base_inverse;  ///< approximate
  Generator extra[6];
  double extra_weight[6];
  int num_extra = 0;
};

/** Proves that the wrench is interior whatever the errors, refining base weights first. */
bool ProveInterior(const ScaledContacts& contacts, Balance* balance);

/** The balance in the query's terms. */
void ReportBalance(const ScaledContacts& contacts, const Balance& balance, ForceWitness* witness);

/** Proves that y separates v from the cones of all contacts whatever the errors. */
bool ProveOutside(const ScaledContacts& contacts, const Vector6d& y);

/** What the simplex found. */
enum class Proposal { kInterior, kOutside, kNone };

/** Where the simplex stopped undecided: the base and the columns of its last basis, and a y with
 room to spare on all cones, if one was found. For the exact stage, which trusts none of it. */
struct SimplexEnd {
  int count = -1;  ///< of the contacts in question
  Generator base[6], column[6];
  int direction_row = -1;  ///< whose column is the direction; -1: nothing to start from
  bool has_room = false;
  Vector6d room = Vector6d::Zero();  ///< of scaled arms
  double length = 1;                 ///< m
};

/** Proposes a balance over the first `count` contacts or a separating y, asking the certificates
 above as it goes, so that kInterior and kOutside are proven; where it is neither, says where it
 stopped, and where it is kOutside, a y with more room in `deep`. */
Proposal SolveStability(const ScaledContacts& contacts, int count, Balance* balance, Vector6d* y,
                        int* pivots, SimplexEnd* end = nullptr, Vector6d* deep = nullptr);

struct RoundBuffers;  // round_simplex_internal.h

struct StabilityWorkspace::Scratch {
  ScaledContacts contacts;
  Balance balance;
  SimplexEnd end;                       ///< of the last question
  std::shared_ptr<RoundBuffers> exact;  ///< of the exact stage, once it was asked
};

/** TryStability; where it is kFails and `deep` is asked for, that is a separating wrench with more
 room, of scaled arms. */
StabilityAnswer AskSimplex(const StabilityQuery& query, StabilityWorkspace* workspace,
                           Vector6d* deep);

}  // namespace cguide::numeric
