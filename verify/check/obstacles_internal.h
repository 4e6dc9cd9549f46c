// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "cguide/verify/check/certificate.h"
#include "cguide/verify/check/piece_tree_internal.h"
#include "cguide/verify/check/solids_internal.h"

namespace cguide::check {

template <typename I>
struct PlacedHalfspace {
  IntervalVector<I> normal;  ///< unit
  I offset;
};

template <typename I>
struct PlacedTriangle {
  std::array<int, 3> vertex;
  WorldBox<I> box;
};

template <typename I>
struct PlacedMesh {
  Corners<I> vertices_W;
  std::vector<PlacedTriangle<I>> triangles;
  WorldBox<I> box;  ///< unused where there are no triangles
  bool solid = false;
};

/** One piece of an object; exactly one of the three is set. Pieces are numbered over the objects in
 the order of the model. */
template <typename I>
struct Obstacle {
  int object = -1;
  const Piece* piece = nullptr;
  std::optional<PlacedSet<I>> convex;
  std::optional<PlacedHalfspace<I>> halfspace;
  std::optional<PlacedMesh<I>> mesh;
};

template <typename I>
PlacedHalfspace<I> PlaceHalfspace(const Halfspace& h, const ConstantPose<I>& X) {
  PlacedHalfspace<I> placed;
  const IntervalVector<I> normal = Lifted<I>(h.normal);
  const I length = Inverse(Norm(normal));
  for (int i = 0; i < 3; ++i) {
    const IntervalVector<I> row{X.R[0][i], X.R[1][i], X.R[2][i]};
    placed.normal[i] = length * Dot(row, normal);
  }
  placed.offset = length * I(h.offset) + Dot(placed.normal, X.p);
  return placed;
}

template <typename I>
PlacedMesh<I> PlaceMesh(const std::vector<Eigen::Vector3d>& vertices,
                        const std::vector<std::array<int, 3>>& triangles,
                        const ConstantPose<I>& X) {
  PlacedMesh<I> mesh;
  for (const Eigen::Vector3d& v : vertices) mesh.vertices_W.push_back(Apply(X, Lifted<I>(v)));
  for (const std::array<int, 3>& t : triangles) {
    PlacedTriangle<I> placed{t, {}};
    for (int i = 0; i < 3; ++i) {
      placed.box[i] =
          Join(mesh.vertices_W[t[0]][i], Join(mesh.vertices_W[t[1]][i], mesh.vertices_W[t[2]][i]));
      mesh.box[i] = mesh.triangles.empty() ? placed.box[i] : Join(mesh.box[i], placed.box[i]);
    }
    mesh.triangles.push_back(placed);
  }
  return mesh;
}

template <typename I>
Obstacle<I> MakeObstacle(int object, const Piece& piece) {
  Obstacle<I> made;
  made.object = object;
  made.piece = &piece;
  const ConstantPose<I> X = Lifted<I>(piece.X_WP);
  if (const auto* h = std::get_if<Halfspace>(&piece.geometry)) {
    made.halfspace = PlaceHalfspace(*h, X);
  } else if (const auto* surface = std::get_if<Surface>(&piece.geometry)) {
    made.mesh = PlaceMesh(surface->vertices, surface->triangles, X);
  } else if (const auto* solid = std::get_if<Solid>(&piece.geometry)) {
    made.mesh = PlaceMesh(solid->vertices, solid->triangles, X);
    made.mesh->solid = true;
  } else {
    made.convex = Place(piece.geometry, X);
  }
  return made;
}

/** Boxes that hold the piece wherever it is moved by at most `by`. */
template <typename I>
void Inflate(const I& by, Obstacle<I>* obstacle) {
  if (obstacle->convex) obstacle->convex->box = Inflated(obstacle->convex->box, by);
  if (!obstacle->mesh) return;
  obstacle->mesh->box = Inflated(obstacle->mesh->box, by);
  for (PlacedTriangle<I>& t : obstacle->mesh->triangles) t.box = Inflated(t.box, by);
}

/** The box about a piece, or null: halfspaces and meshes without triangles have none. */
template <typename I>
const WorldBox<I>* BoxOf(const Obstacle<I>& obstacle) {
  if (obstacle.convex) return &obstacle.convex->box;
  return obstacle.mesh && !obstacle.mesh->triangles.empty() ? &obstacle.mesh->box : nullptr;
}

/** A shape of the robot. Shapes are numbered over the links in the order of the model. */
template <typename I>
struct RobotShape {
  int link = -1;
  int body = -1;
  ConstantPose<I> X_LS;
  ConvexSet<I> set;
};

/** The model with its constants as intervals. Borrows the model. */
template <typename I>
struct Prepared {
  explicit Prepared(const Model& given, const Robustness& box = {}) : model(&given), robust(box) {
    for (const Joint& joint : given.robot.joints) joints.push_back(Lifted<I>(joint));
    for (std::size_t l = 0; l < given.robot.links.size(); ++l) {
      for (const LinkShape& shape : given.robot.links[l].shapes) {
        const PieceShape geometry =
            std::visit([](const auto& g) { return PieceShape(g); }, shape.geometry);
        shapes.push_back({static_cast<int>(l), given.robot.links[l].body, Lifted<I>(shape.X_LS),
                          MakeConvexSet<I>(geometry)});
      }
    }
    for (std::size_t o = 0; o < given.objects.size(); ++o) {
      for (const Piece& piece : given.objects[o].pieces) {
        obstacles.push_back(MakeObstacle<I>(static_cast<int>(o), piece));
        if (robust.pose > 0) Inflate(I(robust.pose), &obstacles.back());
      }
    }
    std::vector<const WorldBox<I>*> boxes;
    for (const Obstacle<I>& obstacle : obstacles) boxes.push_back(BoxOf(obstacle));
    tree = PieceTree<I>(boxes);
    may_touch = given.contact.may_touch;
    std::sort(may_touch.begin(), may_touch.end());
  }

  /** The skin of DESIGN part 2: where the pair is listed in contact.may_touch. */
  double Skin(int body, int object) const {
    const bool listed =
        std::binary_search(may_touch.begin(), may_touch.end(), std::pair(body, object));
    return listed ? model->contact.skin : 0;
  }

  const Model* model;
  Robustness robust;
  std::vector<ConstantJoint<I>> joints;
  std::vector<RobotShape<I>> shapes;
  std::vector<Obstacle<I>> obstacles;
  PieceTree<I> tree;                           ///< of their boxes
  std::vector<std::pair<int, int>> may_touch;  ///< sorted
};

}  // namespace cguide::check
