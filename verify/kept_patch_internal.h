#pragma once

#include <array>
#include <utility>
#include <vector>

#include "cguide/verify/kept_contact_internal.h"

namespace cguide::verify::patch_internal {

/** n.z = h, n unit up to rounding. */
struct Plane {
  Eigen::Vector3d n;
  double h = 0;
};

/** The foot f(t) = x - d n of a site on a plane over a leaf. */
struct FootPath {
  Vector2 foot;
  Eigen::Vector3d lower, upper;  ///< box of it
  double height = 0;             ///< of the site above the plane, at most
  double lowest = 0;             ///< and at least
  double slop = 0;               ///< rounding of these heights
  int owner = -1;                ///< object from which all this is seen

  /** A size of numbers, for their rounding. */
  double Scale() const;
};

/** A part of an obstacle beside the foot: its corners, of a face the three that span it; none for a
 halfspace. */
struct Part {
  check::PatchPart name;
  bool is_face = false;
  std::vector<Eigen::Vector3d> v;
  double error = 0;  ///< of corners
  double depth = 0;  ///< of the lowest corner below the plane
  Eigen::Vector3d side[2] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  ///< v[k] - v[0]
  Eigen::Matrix<double, 2, 3> rows = Eigen::Matrix<double, 2, 3>::Zero();        ///< pseudo-inverse
  double longest = 0;                                                            ///< side
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();                              ///< of a halfspace
  double offset = 0;
  double moved = 0;  ///< how far its object may be from where `owner` sees it
};

Part MakePart(const check::PatchPart& name, const std::vector<Eigen::Vector3d>& v, bool is_face,
              double error, const Plane& plane);

/** How far the foot is from the part, at most (an estimate at a point, a bound over [from, to]). */
double GapAt(const Part& part, const Eigen::Vector3d& foot);
double GapOver(const Part& part, const FootPath& path, double from, double to);

/** The foot, or another moving point, at t. */
Eigen::Vector3d At(const Vector2& a, double t);

/** Parts of the obstacles near a foot that may serve: those that are hardly below the plane. */
class PartList {
 public:
  static constexpr std::size_t kMost = 600;

  PartList(const Plane& plane, double deepest) : plane_(plane), deepest_(deepest) {}

  void Add(const check::PatchPart& name, const std::vector<Eigen::Vector3d>& v, bool is_face,
           double error) {
    const Part part = MakePart(name, v, is_face, error, plane_);
    if (part.depth <= deepest_) parts.push_back(part);
  }

  /** The triangle, its edges and its corners; `numbers`: of the corners in certificates. */
  void AddTriangle(check::PatchPart name, const std::array<Eigen::Vector3d, 3>& v,
                   const std::array<int, 3>& numbers, bool is_mesh, double error) {
    name.corners = is_mesh ? std::vector<int>{} : std::vector{numbers[0], numbers[1], numbers[2]};
    Add(name, {v[0], v[1], v[2]}, false, error);
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3;
      name.corners = {numbers[k], numbers[l]};
      Add(name, {v[k], v[l]}, false, error);
      name.corners = {numbers[k]};
      Add(name, {v[k]}, false, error);
    }
  }

  void AddBox(int piece, const numeric::Convex& s);

  std::vector<Part> parts;

 private:
  const Plane& plane_;
  double deepest_;
};

/** Chooses which part serves for which t: indices into the parts with the t until which they serve;
 empty where there are too many. Proposals, ContactKeeper::BoundParts proves. */
std::vector<std::pair<int, double>> ChooseParts(const std::vector<Part>& parts,
                                                const FootPath& path);

/** Over a leaf the contact's point is within `spread` of the foot and within `farthest` of x. */
struct Bounds {
  double spread = 0;
  double farthest = 0;
  double rise = 0;   ///< of obstacles near the foot above the plane, at most
  double reach = 0;  ///< what counts as near
};

}  // namespace cguide::verify::patch_internal
