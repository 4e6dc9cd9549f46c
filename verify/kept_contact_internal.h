#pragma once

#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "cguide/exact/body_distance.h"
#include "cguide/numeric/contact.h"
#include "cguide/numeric/world.h"
#include "cguide/verify/check/certificate.h"
#include "cguide/verify/moving_shape_internal.h"

namespace cguide::verify {

namespace patch_internal {  // kept_patch_internal.h
struct Plane;
struct FootPath;
struct Part;
struct Bounds;
}  // namespace patch_internal

/** A flat side of an obstacle: the surface of a halfspace, a face of a box, the plane of a
 * triangle. */
struct Flat {
  int piece = -1;
  int face = -1;      ///< of a box: axis, plus 3 for its negative side; else -1
  int triangle = -1;  ///< of a mesh, else -1
  int side = 1;       ///< -1: against the triangle's normal
  bool operator<(const Flat& other) const {
    return std::tie(piece, face, triangle, side) <
           std::tie(other.piece, other.face, other.triangle, other.side);
  }
};

/** Which triangles of a mesh share an edge: by its two corners, numbered by their coordinates. */
struct MeshEdges {
  std::vector<int> number;  ///< of each vertex
  std::map<std::pair<int, int>, std::vector<int>> triangles;
};

/** A contact that stays active over a leaf (DESIGN part 6, cases F and L). */
struct KeptContact {
  Eigen::Vector3d n_W = Eigen::Vector3d::UnitZ();
  double normal_error = 0;  ///< bound on |n_W - the real normal| for every t
  double friction = 0;
  Vector2 force_point;  ///< x - r n, in W
  check::ContactEvidence evidence;
};

/** Corners of the box of a moving point. */
Eigen::Vector3d LowerOf(const Vector2& x);
Eigen::Vector3d UpperOf(const Vector2& x);

/** Whether the piece keeps farther from the box [lower, upper] than `distance`. */
bool FartherThan(const numeric::ObstaclePiece& piece, const Eigen::Vector3d& lower,
                 const Eigen::Vector3d& upper, double distance);

/** Finds which contacts of one instant stay over a leaf. One per thread; it remembers which pieces
 lie behind which flats, a question over Q. */
class ContactKeeper {
 public:
  explicit ContactKeeper(const numeric::World& world);

  /** Whether the contact, found at the middle of the leaf, provably stays for every t, wherever
   each object is moved by at most `pose`. x(t) is the site's centre. */
  bool Keep(const TaylorState<kDegree>& state, const numeric::Contact& contact, double pose,
            KeptContact* kept);

 private:
  /** The site over the leaf. */
  struct MovingSite {
    Vector2 x;
    Eigen::Vector3d lower, upper;  ///< box of x(t)
    int body = -1;
    double radius = 0;
    double skin = 0;
    double step = 0;  ///< bound on |x(t) - x|, x the stored centre at the middle
  };

  /** F: n.z = h is a flat's plane with unit outward n, d = n.x - h. The flat's piece is convex, so
   that its point nearest to x is the foot y = x - d n as soon as that lies in the flat. It is a
   contact as long as r - skin < d < r + eps. It stays a local closest point because every other
   piece keeps farther than the seam from y, or lies behind the plane: a point z with n.z <= h has
   |z - x| >= d = |y - x|. Inside the obstacle by less than the skin, the flat is the nearest way
   out where y is farther than that from its rim. */
  bool KeepOnFlat(const MovingSite& site, const numeric::Contact& contact, const Flat& flat,
                  KeptContact* kept);

  /** L: y(t) is the point of a convex piece nearest to x(t), w = x - y. Both maps x -> y and x -> w
   are 1-Lipschitz [Moreau 1965], so within |x(t) - x(0)| <= step the distance stays within `step`
   of its middle value, y within `step` of y(0), and w/|w| within 2 step/|w(0)| of n(0). Other
   pieces keep farther than the seam from all those y, or are never as near to x as the piece is. */
  bool KeepOnConvex(const MovingSite& site, const numeric::Contact& contact, int piece,
                    KeptContact* kept);

  /** On a corner v or an edge with ends a, b of a convex piece's core: w = x - v, or x - a without
   its part along b - a, is the way from the core's closest point as long as no other corner p has
   w.(p - a) > 0 and the foot stays on the edge. Bounds on how w turns do not count sliding along
   the edge nor rising. Other pieces as in L. */
  bool KeepOnRidge(const MovingSite& site, const numeric::Contact& contact, int piece,
                   KeptContact* kept);

  /** F on a mesh: as on a flat, for the plane of a triangle and those next to it in the same plane;
   the foot stays in their union, which is star-shaped about the first one's centroid. */
  bool KeepOnTriangles(const MovingSite& site, const numeric::Contact& contact, KeptContact* kept);

  /** P: a plane that nothing near the foot is above, but for a rise of rounding or a little more,
   with some of the obstacles near the foot for every t. The closest of them is a contact's point,
   whose normal is nearly the plane's: lemma 11 of FORMAT.md. */
  bool KeepOnPatch(const MovingSite& site, const numeric::Contact& contact, KeptContact* kept);
  bool KeepOnPlane(const MovingSite& site, const numeric::Contact& contact,
                   const Eigen::Vector3d& n, KeptContact* kept);
  std::vector<Eigen::Vector3d> PatchNormals(const numeric::Contact& contact) const;
  std::vector<patch_internal::Part> PatchParts(const patch_internal::FootPath& path,
                                               const patch_internal::Plane& plane) const;
  patch_internal::Bounds BoundParts(const std::vector<patch_internal::Part>& parts,
                                    const std::vector<std::pair<int, double>>& chosen,
                                    const patch_internal::FootPath& path, double rise) const;
  std::optional<patch_internal::FootPath> FollowFoot(const MovingSite& site,
                                                     const patch_internal::Plane& plane,
                                                     int owner) const;
  std::optional<patch_internal::Bounds> SettleBounds(
      const std::vector<patch_internal::Part>& parts,
      const std::vector<std::pair<int, double>>& chosen, const patch_internal::FootPath& path,
      const patch_internal::Plane& plane, KeptContact* kept) const;
  double RiseNear(const patch_internal::FootPath& path, const patch_internal::Plane& plane,
                  double reach, KeptContact* kept) const;
  double RiseOfMesh(const patch_internal::FootPath& path, const patch_internal::Plane& plane,
                    double reach, int piece, KeptContact* kept) const;
  bool TriangleAway(const numeric::Mesh& mesh, int triangle, const Vector2& foot, double reach,
                    int piece, KeptContact* kept) const;
  double LeastSkin(const MovingSite& site, const patch_internal::FootPath& path,
                   double reach) const;

  /** The plane of triangles in doubles: d = n.x - h is within error + normal_error |x|_1 of the
   real one. */
  struct TrianglePlane {
    Eigen::Vector3d n;
    double h = 0;
    double normal_error = 0;
    double error = 0;
  };
  bool FindTriangle(const numeric::Contact& contact, Flat* flat, TrianglePlane* plane) const;
  bool GrowTriangles(const Flat& flat, const TrianglePlane& plane, const Vector2& y,
                     std::vector<int>* triangles);
  bool TrianglesAllow(const Flat& flat, int piece, const Eigen::Vector3d& lower,
                      const Eigen::Vector3d& upper);
  /** The triangles of a mesh or of a hull's faces, in W; null for other pieces. */
  const numeric::Mesh* FacesOf(int piece) const;
  const exact::Triangle& ExactFace(int piece, int triangle) const;
  const MeshEdges& EdgesOf(int piece);
  bool LiesBehind(const Flat& flat, int piece, int triangle);

  /** Where other pieces must not be. */
  struct Surroundings {
    Eigen::Vector3d lower, upper;  ///< box of the contact's point
    double seam = 0;               ///< how far from it others keep
    double farthest = 0;           ///< distance of the site from it, at most
  };
  bool FinishNear(const MovingSite& site, int piece, const Surroundings& around,
                  const check::ContactEvidence& evidence, KeptContact* kept);

  bool FindFlat(const numeric::Contact& contact, Flat* flat) const;
  int FindConvex(const numeric::Contact& contact) const;
  bool InFace(const numeric::ObstaclePiece& piece, int face, const Vector2& x, double margin) const;
  void SetForcePoint(const MovingSite& site, KeptContact* kept) const;
  void NoteAway(int piece, const Eigen::Vector3d& y, double radius, KeptContact* kept) const;

  const numeric::World& world_;
  const numeric::PieceTree& tree_;
  exact::PreparedModel exact_;
  /** How far each object may be from its place, and so two from each other twice as far; for which
   `behind_` holds. */
  double pose_ = 0;
  std::map<std::tuple<Flat, int, int>, bool> behind_;  ///< flat, piece, triangle or -1
  std::map<int, MeshEdges> edges_;                     ///< by piece
  /** Faces of hulls, by piece. */
  struct HullFaces {
    numeric::Mesh mesh;
    exact::TriangleSet exact;
  };
  std::map<int, HullFaces> hulls_;
};

}  // namespace cguide::verify
