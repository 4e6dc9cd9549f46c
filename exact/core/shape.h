// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <variant>
#include <vector>

namespace cguide {

/** Full edge lengths along the axes of the shape's frame, centred at its origin (m). */
struct Box {
  Eigen::Vector3d size = Eigen::Vector3d::Ones();
  bool operator==(const Box&) const = default;
};

/** Ball about the origin of the shape's frame (m). */
struct Sphere {
  double radius = 1;
  bool operator==(const Sphere&) const = default;
};

/** Solid cylinder about z, |z| <= length/2 (m). */
struct Cylinder {
  double radius = 1;
  double length = 1;
  bool operator==(const Cylinder&) const = default;
};

/** Points within `radius` of the segment |z| <= length/2 of the z axis (m). */
struct Capsule {
  double radius = 1;
  double length = 1;  ///< between the centres of the end caps
  bool operator==(const Capsule&) const = default;
};

/** Convex hull of the vertices (m). `faces` are outward triangles for drawing and for placing
 sites; they carry no meaning for any verdict. */
struct Hull {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> faces;
  bool operator==(const Hull&) const = default;
};

/** {x : normal.x <= offset}; the normal points out of the matter and need not be unit (m). */
struct Halfspace {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0;
  bool operator==(const Halfspace&) const = default;
};

/** Union of triangles, without inside (m). */
struct Surface {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
  bool operator==(const Surface&) const = default;
};

/** Points with non-zero winding number about a closed, consistently oriented triangle mesh,
 together with the triangles (m). */
struct Solid {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
  bool operator==(const Solid&) const = default;
};

/** What a robot body is made of: convex sets only. */
using ConvexShape = std::variant<Box, Sphere, Cylinder, Capsule, Hull>;

/** What an obstacle is made of. */
using PieceShape = std::variant<Box, Sphere, Cylinder, Capsule, Hull, Halfspace, Surface, Solid>;

}  // namespace cguide
