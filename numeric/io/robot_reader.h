#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cguide/exact/core/model.h"

namespace cguide::numeric::io {

/** Where `package://NAME/rest` and `package:///NAME/rest` look: NAME -> folder. A name that is not
 listed is searched for upwards from the file that mentions it. */
using PackageMap = std::map<std::string, std::filesystem::path>;

struct RobotFiles {
  std::filesystem::path urdf;
  std::filesystem::path srdf;  ///< empty: none
  PackageMap packages;
};

/** A posture by the names of independent joints, as read from an SRDF group_state; values as
 stored, limits unchecked. States of one name for several groups are one posture. */
struct NamedPosture {
  std::string name;
  std::map<std::string, double> joints;
  /** The seven values (position, then quaternion x y z w) of a joint the robot does not have: its
   floating root. Not checked to be a unit quaternion. */
  std::optional<Pose> root;
};

struct EndEffector {
  std::string name;
  std::string parent_link;
};

/** What URDF and SRDF say. */
struct RobotDescription {
  Robot robot;
  std::vector<NamedPosture> postures;
  std::vector<std::pair<int, int>> disabled_bodies;  ///< body pairs i < j, sorted, without repeats
  std::vector<EndEffector> end_effectors;
  std::vector<std::string> warnings;
};

/** Reads a robot: links, joints, inertials and collisions of the URDF, then the SRDF. Visuals are
 not looked at. Collision meshes become exact convex hulls, one shape per <collision>.

 Order: depth first from the root, the children of a link in the order of their joints in the file.
 The doubles of the model: each decimal rounded to nearest once; rotations are FromRpy of the
 doubles of rpy; axes as read; the factors of a mimic joint that follows another mimic joint are
 multiplied out towards the independent one; meshes as ReadMesh says. urdfdom reads the same file
 and must agree to the last bit (rotations: within 1e-14), else the file is refused as ambiguous.

 Warnings, not errors: <capsule> (left out), files that urdfdom refuses, an SRDF of another robot's
 name, what an SRDF says of unknown links and joints.
 @throws Error (kBadInput, kIo) with file, line where known, cause and remedy: malformed XML,
 numbers that are not finite or beyond 1e6, no mass, unknown joint types, floating and planar
 joints, reversed limits, whatever is not one tree, missing meshes. */
RobotDescription ReadRobot(const RobotFiles& files);

/** Reads a static scene: one object per link with geometry, named after it, each collision a piece
 (meshes as mesh_reader's kAuto, one piece per part), joints at zero, all placed by X_WS. Friction
 is filled with `friction`. A Klampt world file (root element <world>) gives one object per terrain.
 Poses are composed in doubles; those doubles are the model.
 @throws Error (kBadInput, kIo) as ReadRobot, except that masses and joint types do not matter; a
 scene without any geometry is refused. */
std::vector<Object> ReadSceneUrdf(const std::filesystem::path& urdf, const PackageMap& packages,
                                  const Pose& X_WS, double friction,
                                  std::vector<std::string>* warnings);

/** The double quaternion of fixed-axis roll, pitch, yaw (rad): R = Rz(yaw) Ry(pitch) Rx(roll). */
Quaternion FromRpy(const Eigen::Vector3d& rpy);

}  // namespace cguide::numeric::io
