#pragma once

#include <vector>

#include "cguide/numeric/cone_membership.h"
#include "cguide/verify/kept_contact_internal.h"

namespace cguide::verify {

/** A force direction at a kept contact and its weight at the middle of a leaf. */
struct ProposedForce {
  int contact = -1;
  Eigen::Vector3d u_W = Eigen::Vector3d::Zero();
  double weight = 0;  ///< N per unit of u
};

/** Proposes forces that carry the weight -v_f at the centre of mass, with room on every side:
 floats, nothing is promised. One per thread. */
class BalanceProposer {
 public:
  /** The first six directions are independent and have large weights, so that the balance survives
   while contacts and centre of mass move; each lies inside the friction cone by more than the
   normal changes over the leaf. Empty where none was found. `arm` are the contacts' points from the
   centre of mass at the middle of the leaf. */
  const std::vector<ProposedForce>& Propose(const std::vector<KeptContact>& contacts,
                                            const std::vector<Eigen::Vector3d>& arms,
                                            const Eigen::Vector3d& v_f);

 private:
  /** Pyramids of few sides and short directions do for most leaves. */
  struct Effort {
    int sides = 4;
    bool is_short = true;
    double share = 0;  ///< of the load that each direction of the basis bears, to begin with
  };
  void Try(const std::vector<KeptContact>& contacts, const std::vector<Eigen::Vector3d>& arms,
           const Eigen::Vector3d& v_f, const Effort& effort);
  void AddDirections(int index, const KeptContact& contact, const Eigen::Vector3d& arm,
                     const Effort& effort);
  bool ChooseBasis();

  std::vector<ProposedForce> directions_;
  std::vector<AppliedForce> columns_;
  std::vector<int> basis_;
  std::vector<ProposedForce> forces_;
  numeric::WrenchCone cone_;
  numeric::ConeWorkspace workspace_;
};

/** x to `places` decimal places: short to write, and the double read back is the same. */
double ShortNumber(double x, int places);

}  // namespace cguide::verify
