#pragma once

#include <array>
#include <vector>

#include "cguide/numeric/stability_contacts_internal.h"

namespace cguide::numeric {

// They steer speed and the share of decided queries, never a verdict.
constexpr double kPivotTolerance = 1e-11;  // smallest divisor in the ratio test
constexpr int kMaxPivots = 120;
constexpr double kBaseWeight[6] = {1, 0.8, 1.2, 0.9, 1.1, 0.7};

struct WeightedGenerator {
  Generator generator;
  double weight = 0;  ///< of the scaled wrench
};

/** The simplex method on revolution cones; how it works is told in stability_simplex.cc. Untrusted.
 */
class StabilitySimplex {
 public:
  enum class Step {
    kMoved,
    kOptimal,
    kUnbounded,  ///< the cone is the whole space, tau was raised along a ray
    kStuck       ///< the cone contains a line along which only the room s grows
  };

  StabilitySimplex(const ScaledContacts& contacts, int count, Balance* balance)
      : c_(contacts), count_(count), balance_(balance) {}

  /** The whole question, certificates included. */
  Proposal Run();

  /** After kOutside: a y that separates with more room, for neighbouring questions. */
  Vector6d Deepen();

  void ReportEnd(SimplexEnd* end) const;

  /** Pieces of it, for the margins. Prepare finds the base and the first feasible point (false
   where there is nothing to start from); Iterate makes one pivot towards the largest tau, earning
   s. */
  bool Prepare();
  Step Iterate(double s);

  /** Lets Iterate displace the centre of mass by any multiple of d. At most twice. */
  void Free(const Eigen::Vector3d& d);
  /** The displacement in units of contacts.length. */
  Eigen::Vector3d displacement() const;

  /** Adds multiples of `rate` to the wrench from a feasible state until it leaves the cone, at most
   `limit` times. Then y() has y.rate = 1, y.a <= 0 for all contacts and y.v = -the distance.
   @return the distance, or `limit`. */
  double Shoot(const Vector6d& rate, double limit);

  /** The rate of the wrench as the centre of mass moves by multiples of d lengths. */
  Vector6d ShiftRate(const Eigen::Vector3d& d) const;

  /** Takes the rounding that its pivots have gathered out of the weights after a Shoot. */
  void Polish();

  /** How far the last Shoot has forces for: the distance it returned, or more or less than `limit`.
   */
  double reached() const { return reached_; }

  /** The weighted generators of the present state, and the weight that its direction gives to each
   generator of the base. */
  std::vector<WeightedGenerator> Forces(std::array<double, 6>* base_weight) const;

  /** A point of the program from which Shoot may start. */
  bool is_feasible() const { return full_rank_ && direction_row_ >= 0 && tau() > 0; }

  bool full_rank() const { return full_rank_; }
  double tau() const { return x_[direction_row_]; }
  int pivots() const { return pivots_; }
  const Vector6d& y() const { return y_; }

 private:
  enum class Kind { kContact, kArtificial, kDirection, kShift };
  struct Price {
    int contact = -1;
    double value = 0;
  };

  struct Shift {
    Eigen::Vector3d d = Eigen::Vector3d::Zero();
    int row = -1;      ///< where it is basic
    double sign = 1;   ///< of the multiple of d that the column stands for
    double value = 0;  ///< where it is not basic
  };

  static bool IsFree(Kind kind) { return kind == Kind::kDirection || kind == Kind::kShift; }

  void Crash();
  bool Start();
  int DearestShift(double* price) const;
  Step EnterShift(int shift);
  bool Enter(const Generator& entering, Kind kind);
  Step FollowRay(const Generator& entering);
  void ComputeMultipliers(double s);
  Price DearestContact(const Vector6d& y) const;
  Price LargestSupport(const Vector6d& rho) const;
  Generator MakeGenerator(int contact, const Vector6d& y) const;
  int ChooseLeaving(const Vector6d& alpha) const;
  void Pivot(int row, const Vector6d& alpha);
  bool TryInterior();

  const ScaledContacts& c_;
  const int count_;
  Balance* const balance_;
  Matrix6d inverse_ = Matrix6d::Identity();  // of the current basis
  Generator column_[6];
  Kind kind_[6];
  Vector6d x_ = Vector6d::Zero();  // basic variables
  int direction_row_ = -1;         // where tau is basic
  bool full_rank_ = true;
  bool in_span_ = true;
  Vector6d y_ = Vector6d::Zero();
  Vector6d ray_ =
      Vector6d::Zero();  // rates of the basic variables where a column entered unlimited
  Shift shift_[2];
  int num_shifts_ = 0;
  int last_row_ = -1;  // of the last pivot of Enter
  int shot_row_ = -1;  // of the column that Shoot added, if it is basic
  Vector6d rate_ = Vector6d::Zero();
  double reached_ = 0;
  std::vector<WeightedGenerator> held_;  // not in the basis, left at a weight by a ray
  bool has_room_ = false;
  Vector6d room_ = Vector6d::Zero();  // the first y at an optimum with room s
  int pivots_ = 0;
};

}  // namespace cguide::numeric
