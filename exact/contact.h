#pragma once

#include <memory>
#include <vector>

#include "cguide/exact/core/model.h"
#include "cguide/exact/equilibrium.h"
#include "cguide/exact/kinematics.h"

namespace cguide::exact {

namespace internal {
struct ContactSets;  // exact/contact_internal.h
}

/** A model's obstacles as closed convex sets over Q (boxes, rounded hulls, cylinders, halfspaces,
 triangles), and what the contact rules say of them. Immutable, shared by threads, cheap to copy. */
class ContactScene {
 public:
  /** @throws Error where the model asks for ContactModel::kNearest, whose contacts are not local
   closest points of sites. */
  explicit ContactScene(const Model& model);

  const internal::ContactSets& sets() const { return *sets_; }

 private:
  std::shared_ptr<const internal::ContactSets> sets_;
};

struct ContactOptions {
  /** Relative precision of square roots that enter a force point or a normal. */
  int root_bits = 320;
};

/** A contact of DESIGN part 2 at a placed robot. In W. */
struct FoundContact {
  int site = -1;  ///< index into Model::sites
  int body = -1;
  int object = -1;       ///< of the owners of y, the first with the smallest friction
  ExactContact contact;  ///< the force point x - r n, w along n, mu, errors, certain
  Vector3q x;            ///< site centre as placed
  Vector3q y;            ///< local closest point of O
  Rational distance;     ///< signed |x - y|, the radius not subtracted (m)
  Rational error_x = 0;  ///< bounds on the distance from the truth (m)
  Rational error_y = 0;
  Rational error_distance = 0;
};

/** The contacts of a placed robot by their definition: y in O with r - skin < |x - y| < r + eps
 (strictly above r where no skin applies) such that no point of O within the seam of y is strictly
 nearer to x.

 Every such y is the point nearest to x of each convex piece that holds it: the piece has no point
 nearer within the seam, and squared distance from x is convex on it. So the nearest points of the
 pieces (each triangle of a mesh is one) are the candidates, and each has to survive the other
 pieces and the insides of solids. Everything is decided over Q by squared comparisons; where x has
 an error, or a point is irrational (on a ball, on the mantle or rim of a cylinder), by comparisons
 with margins that prove the answer for every truth.

 `certain` contacts are contacts for every truth that the placement's errors allow, their errors
 included in contact.error_p and contact.error_w; and every contact of every such truth is within
 the errors of some listed one, certain or not, whose mu is at least the real one. With errors of
 zero the band and the friction of the owners of y are exact: a site at r + eps is no contact. Not
 decided then are only ties of a tilted approach at the seam's end, met after 64 bisections, and
 they are listed as not certain.

 Candidates that the errors cannot tell apart (a site over the seam of two triangles) are one
 certain contact where one of them is a contact whichever is nearest; where the owners' frictions
 differ a second entry with the largest, not certain, follows.

 With a skin, distance and normal are the signed ones where x touches a piece or is in it: it leaves
 convex pieces through their nearest face above which no other piece rises within the seam, sheets
 to the side that holds the body's shapes. Where several ways are possible, all are listed as not
 certain.

 Ordered by site, then as the pieces are. @throws Error where the placement does not fit. */
std::vector<FoundContact> FindContacts(const ContactScene& scene, const RobotPlacement& placement,
                                       const ContactOptions& options = {});

/** The question of static stability that the contacts pose. */
EquilibriumQuery ContactEquilibrium(const ContactScene& scene, const RobotPlacement& placement,
                                    const std::vector<FoundContact>& contacts);

}  // namespace cguide::exact
