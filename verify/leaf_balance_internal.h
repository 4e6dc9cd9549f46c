#pragma once

#include <vector>

#include "cguide/numeric/cone_membership.h"
#include "cguide/verify/kept_contact_internal.h"

namespace cguide::verify {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/** A force direction at a kept contact, with the weight w0 + w1 t over a leaf. */
struct ProposedForce {
  int contact = -1;
  Eigen::Vector3d u_W = Eigen::Vector3d::Zero();
  double w0 = 0;  ///< N per unit of u
  double w1 = 0;
};

/** A contact's point from the centre of mass: middle + change t, and what is beyond that. */
struct Arm {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Vector3d change = Eigen::Vector3d::Zero();
  Eigen::Vector3d bend = Eigen::Vector3d::Zero();  ///< times t^2
  Eigen::Vector3d At(double t) const { return middle + t * (change + t * bend); }
};

/** Whether one set of weights serves the whole leaf but for the basis, or all of them change from
 one end to the other. */
enum class WeightKind { kConstant, kAffine };

/** How near the limit of balance to look; the nearer, the longer numbers are. */
enum class Care { kQuick, kThorough };

/** Proposes forces that sum up to a wrench about the centre of mass, with room on every side:
 floats, nothing is promised. One per thread. */
class BalanceProposer {
 public:
  /** The first six directions are independent and have large weights, so that the balance survives
   while contacts and centre of mass move; each lies inside the friction cone by more than the
   normal changes over the leaf. Empty where none was found. */
  const std::vector<ProposedForce>& Propose(const std::vector<KeptContact>& contacts,
                                            const std::vector<Arm>& arms, const Vector6d& v,
                                            WeightKind kind, Care care);

 private:
  /** Pyramids of few sides and short directions do for most leaves. */
  struct Effort {
    int sides = 4;
    bool is_short = true;
    double share = 0;  ///< of the load that each direction of the basis bears, to begin with
  };
  void Try(const std::vector<KeptContact>& contacts, const std::vector<Arm>& arms,
           const Vector6d& v, WeightKind kind, const Effort& effort);
  void AddDirections(int index, const KeptContact& contact, const Effort& effort);
  void PlaceColumns(const std::vector<Arm>& arms, double t);
  bool ChooseBasis();
  bool Weigh(const Vector6d& v, double share, std::vector<double>* weights);
  void Collect(const std::vector<double>& from, const std::vector<double>& to);

  std::vector<ProposedForce> directions_;
  std::vector<AppliedForce> columns_;
  std::vector<int> basis_;
  std::vector<double> from_, to_;  ///< weights of the directions at the ends
  std::vector<ProposedForce> forces_;
  numeric::WrenchCone cone_;
  numeric::ConeWorkspace workspace_;
};

/** Corners of a square, where v_f is parallel to an axis, else of an octahedron, that holds every
 moment e x v_f, |e| <= com, but for rounding: the checker's (FORMAT.md, lemma 10), in its order. */
std::vector<Eigen::Vector3d> DisplacedMoments(const Eigen::Vector3d& v_f, double com);

/** x to `places` decimal places: short to write, and the double read back is the same. */
double ShortNumber(double x, int places);

}  // namespace cguide::verify
