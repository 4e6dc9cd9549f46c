#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cguide/exact/core/path.h"

namespace cguide::numeric::io {

/** The forms in which a path may be given. */
enum class PathFormat {
  kGuide,  ///< cguide-guide/1 (guide_io.h)
  kCsv,    ///< a header of column names, then numbers (guide_io.h)
  kOmpl,   ///< ReadPathOmpl
  kMoveIt  ///< ReadPathMoveIt
};

/** The form of a file. The extension decides where it is .csv, .yaml or .yml (a MoveIt trajectory);
 else the content: JSON is a trajectory where it names "joint_trajectory", or "points" but no
 "waypoints", and a guide otherwise; the rest is CSV where its first line has a comma, a matrix
 where that line begins with a number, YAML where it has a colon; .json is a guide where nothing of
 this fits. @throws Error (kBadInput, kIo) where no form fits; the message names the option that
 overrides this. */
PathFormat DetectPathFormat(const std::filesystem::path& file);

struct ForeignPathOptions {
  /** Names of the joint columns of a matrix, in the file's order; empty: the robot's order. */
  std::vector<std::string> joint_order;
  /** The pose of the root where the file has none. */
  std::optional<Pose> X_WB;
};

/** OMPL's PathGeometric::printAsMatrix: one state a line, real numbers between blanks, perhaps
 empty lines at the end. The columns of SE3StateSpace + RealVectorStateSpace: x y z qx qy qz qw,
 then the joints (ColumnNames of the robot, or `joint_order`); with `X_WB` the joints alone. The
 last line must end, since a number cut short would still be a number. The stream that printed the
 file rounded: the path read is that of the printed digits.
 @throws Error (kBadInput, kIo) with file:line, cause, remedy. */
Path ReadPathOmpl(const std::filesystem::path& file, const Robot& robot,
                  const ForeignPathOptions& options);

/** A trajectory as messages of ROS print it, YAML or JSON: moveit_msgs/RobotTrajectory
 (`joint_trajectory`, `multi_dof_joint_trajectory`) or trajectory_msgs/JointTrajectory
 (`joint_names`, `points`). Joints in any order, each column of the robot once.

 The root's pose in the world comes from the only multi-DOF joint, whatever its name; or from seven
 columns NAME/trans_x, trans_y, trans_z, rot_x, rot_y, rot_z, rot_w, as MoveIt names the variables
 of a floating joint; or from `X_WB` where the file has neither. Two sources are refused.

 A path has no time: `time_from_start`, velocities, accelerations and efforts are read over, and
 `*notes` says so, as it says that frame names are not looked at. A line `---` at the end is what
 `rostopic echo` leaves and is allowed.
 @throws Error (kBadInput, kIo) with file:line:column, key path, cause, remedy. */
Path ReadPathMoveIt(const std::filesystem::path& file, const Robot& robot,
                    const ForeignPathOptions& options, std::vector<std::string>* notes);

}  // namespace cguide::numeric::io
