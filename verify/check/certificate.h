// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cguide/exact/core/model.h"
#include "cguide/exact/core/path.h"

// What a certificate says, as verify/FORMAT.md specifies it. Numbers are taken as the doubles they
// are. "Shape" counts the shapes of the links, "piece" the pieces of the objects, both in the order
// of the model.
namespace cguide::check {

/** The plane n.x = m0 + m1 t, in W; n need not be unit. m1 serves moving pairs alone. */
struct Plane {
  Eigen::Vector3d n = Eigen::Vector3d::Zero();
  double m0 = 0;
  double m1 = 0;
};

/** Planes that keep a shape apart from a piece, or (self) from another shape. One for convex ones;
 of a mesh each triangle lies behind one of them. */
struct Separation {
  int shape = -1;
  int other = -1;
  std::vector<Plane> planes;
};

/** A plane n.x = m0 that the shapes are strictly above; it serves every convex piece that is not
 above it. */
struct SharedPlane {
  Plane plane;
  std::vector<int> shapes;
};

/** A direction in which a ray from a point of the shape (the first corner of its core, the middle
 of a cylinder) crosses the triangles of a solid in equal numbers from either side: the shape is
 outside the solid where the edge begins. */
struct OutsideRay {
  int shape = -1;
  int piece = -1;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
};

/** The face a site keeps above. */
struct FlatEvidence {
  int face = -1;               ///< of a box: axis, plus 3 for its negative side; -1: see triangles
  std::vector<int> triangles;  ///< of a mesh or a hull: coplanar, their union star-shaped about the
                               ///< first; none for a halfspace
  int side = 1;  ///< 1 where the site is on the side of the first triangle's normal, else -1
};

/** A point of a convex piece near the site's closest one. */
struct NearEvidence {
  Eigen::Vector3d y_P = Eigen::Vector3d::Zero();  ///< in the piece's frame; not for hulls
  std::vector<std::pair<int, double>> corners;    ///< of a hull: weights >= 0 of its vertices
};

/** The corner, or the two ends of the edge, of a convex piece's core on which the site's closest
 point stays. Corners of a box count x fastest, then y, then z, the negative side first; those of a
 capsule are its lower and upper end, that of a sphere is its centre, those of a hull its vertices.
 */
struct RidgeEvidence {
  std::vector<int> corners;  ///< one or two
};

/** A part of an obstacle's surface that the site's foot is on, or beside: a face of a box; a
 triangle of a mesh, or an edge or a corner of one; the hull of some corners of a convex core; a
 halfspace. */
struct PatchPart {
  int piece = -1;
  int face = -1;             ///< of a box, as in FlatEvidence
  int triangle = -1;         ///< of a mesh
  std::vector<int> corners;  ///< of the triangle (0 to 2; none: all), or of the convex core
  double until = 1;          ///< it serves for t from where the one before ends to here
};

/** Whatever of the obstacles is near the site's foot is not above the plane by more than `slack`,
 and some of it is near the foot for every t (FORMAT.md, lemma 11). */
struct PatchEvidence {
  Eigen::Vector3d n = Eigen::Vector3d::Zero();  ///< need not be unit; the plane is n.z = m0
  double m0 = 0;
  double slack = 0;
  std::vector<PatchPart> parts;  ///< by `until`; the last serves until 1
};

/** Why a site keeps one contact with a piece over a node. */
struct ContactEvidence {
  int site = -1;
  int piece = -1;
  std::optional<FlatEvidence> flat;  ///< one of the four
  std::optional<NearEvidence> near;
  std::optional<RidgeEvidence> ridge;
  /** Pieces that keep away from the contact's point, with planes; others lie behind the face, or
   are seen to be apart without help. `shape` is unused. */
  std::vector<Separation> apart;
  std::optional<PatchEvidence> patch;
};

/** A force weight(t) u at a contact, weight = w0 + w1 t. */
struct ForceEvidence {
  int contact = -1;  ///< index into Balance::contacts
  Eigen::Vector3d u_W = Eigen::Vector3d::Zero();
  double w0 = 0;
  double w1 = 0;
};

/** Forces that carry the robot; the first six are a basis. Where only contact is asked for, none.
 */
struct Balance {
  std::vector<ContactEvidence> contacts;
  std::vector<ForceEvidence> forces;
  /** Where the centre of mass may be elsewhere, instead of `forces`: one list for each corner
   of what its moment may be (FORMAT.md, lemma 10). */
  std::vector<std::vector<ForceEvidence>> displaced;
};

/** Part of an edge: what is proved over the whole of it, and its two halves where something is
 * left.
 */
struct Node {
  std::vector<Separation> apart;
  std::vector<Separation> self_apart;
  std::vector<SharedPlane> above;
  std::optional<Balance> balance;
  std::vector<Node> halves;  ///< none or two
};

/** The proof that one edge stays in C_guide. */
struct EdgeProof {
  int edge = -1;  ///< from waypoint `edge` to the next
  std::vector<OutsideRay> outside;
  Node root;
};

/** A box of models about the one of a certificate: every object moved by a translation of its own
 of at most `pose`, every friction less by at most `friction` (and not below 0), the robot's centre
 of mass displaced by at most `com`, at each s as it may be (FORMAT.md part 7). What is proved for
 the box is proved of each model in it. */
struct Robustness {
  double friction = 0;
  double pose = 0;  ///< m
  double com = 0;   ///< m
  bool operator==(const Robustness&) const = default;
};

struct Certificate {
  std::string tool;
  Model model;
  Robustness robust;
  Path path;
  std::vector<EdgeProof> proofs;  ///< by edge, each at most once
};

/** Edges of a path; one of a single waypoint has one edge, from it to itself. */
std::vector<Edge> EdgesOf(const Path& path);

/** Reads a certificate. Files beyond 256 MiB or 30 million values, nested deeper than 200 levels,
 with repeated or unknown keys, with numbers that are not finite or beyond 1e9, with indices out of
 range are refused.
 @throws Error (kBadInput) that names the place. */
Certificate ParseCertificate(const std::string& text);

/** The path of a guide file (schema cguide-guide/1): its joint_names and waypoints. Its other keys
 say how it came about and are not looked at. Limits as for certificates.
 @throws Error (kBadInput) that names the place. */
Path ParseGuidePath(const std::string& text);

/** Where two paths differ, in words; empty where joint names and waypoints are the same, every
 number the same real number. */
std::string DifferenceOf(const Path& certified, const Path& guide);

/** The text in which the canonical model stands in a certificate, byte for byte, or nothing where
 the certificate does not begin as FORMAT.md says. */
bool HasModelText(const std::string& certificate, const std::string& model_file);

}  // namespace cguide::check
