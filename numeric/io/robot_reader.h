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

/** Reads a robot. Collision meshes become exact convex hulls, one shape per <collision>.
 rpy is fixed-axis and converted once to a quaternion in doubles.
 @throws Error (kBadInput, kIo) with file, line where known, cause and remedy. */
RobotDescription ReadRobot(const RobotFiles& files);

/** Reads a static scene: one object per link, each collision a piece (meshes as mesh_reader's
 kAuto), joints at zero, all placed by X_WS. Friction is filled with `friction`. */
std::vector<Object> ReadSceneUrdf(const std::filesystem::path& urdf, const PackageMap& packages,
                                  const Pose& X_WS, double friction,
                                  std::vector<std::string>* warnings);

/** The double quaternion of fixed-axis roll, pitch, yaw (rad): R = Rz(yaw) Ry(pitch) Rx(roll). */
Quaternion FromRpy(const Eigen::Vector3d& rpy);

}  // namespace cguide::numeric::io
