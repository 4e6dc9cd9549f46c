#pragma once

#include <cguide/exact/core/model.h>
#include <cguide/numeric/kinematics.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace contact_planner {

/** A rectangle of an obstacle that may be touched: centre + a u + b v, |a| <= half[0], |b| <=
 half[1], u and v unit. Boxes have six, a halfspace one (100 m wide). */
struct Face {
  int object = -1;
  std::string name;
  Eigen::Vector3d centre_W, normal_W, u_W, v_W;
  Eigen::Vector2d half;
};

/** Faces of the boxes and halfspaces of a model; other obstacles are only avoided. */
std::vector<Face> FacesOf(const cguide::Model& model);

enum class Hold {
  kSurface,  ///< all sites of the link touch at once (a sole)
  kPoint     ///< one site
};

/** A link that may take hold of a face. */
struct Limb {
  std::string name;
  int body = -1;
  Hold hold = Hold::kPoint;
  std::vector<int> sites;
};

/** The links named, each a surface where its sites lie in one plane and a point otherwise.
 @throws cguide::Error where the robot has no such link or the link has no sites. */
std::vector<Limb> LimbsOf(const cguide::Model& model, const std::vector<std::string>& links);

/** A limb on a face: which of its sites, and where they are. */
struct Grip {
  int limb = -1;
  int face = -1;
  std::vector<int> sites;
  std::vector<Eigen::Vector3d> at_W;
};

/** A set of contacts, at most one grip a limb, ordered by limb. */
using Stance = std::vector<Grip>;

const Grip* FindGrip(const Stance& stance, int limb);
Stance With(Stance stance, const Grip& grip);
Stance Without(Stance stance, int limb);

/** Whether the same limbs are on the same faces, none of their sites farther apart than `spacing`.
 */
bool Alike(const Stance& a, const Stance& b, double spacing);

/** "right_foot on floor" and so on. */
std::string Describe(const Grip& grip, const std::vector<Limb>& limbs,
                     const std::vector<Face>& faces);

Eigen::Vector3d SitePosition(const cguide::Model& model, const cguide::numeric::KinematicTree& tree,
                             const cguide::numeric::KinematicState& state, int site);

}  // namespace contact_planner
