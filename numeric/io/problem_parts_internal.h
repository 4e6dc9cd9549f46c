#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/robot_reader.h"
#include "cguide/numeric/io/yaml_internal.h"
#include "cguide/numeric/kinematics.h"
#include "cguide/numeric/problem.h"

namespace cguide::numeric::io {

/** Lengths and positions beyond this are refused: a file in millimetres, most likely (m). */
constexpr double kMaxLength = 1e4;

/** Runs `read` and puts the place in front of the message of any Error that comes out of it. */
template <typename Function>
auto AtPlace(const std::string& place, Function read) {
  try {
    return read();
  } catch (const Error& e) {
    throw Error(e.code(), place + ": " + e.what());
  }
}

/** Keys xyz_m and one of rpy and quaternion {x, y, z, w}; what is absent is zero. */
Pose ReadPose(const YamlView& view);

/** Rotation under `rpy_key` or `quaternion_key`, identity where both are absent. The quaternion is
 kept as written; refused farther than 1e-3 from unit. */
Quaternion ReadRotation(const YamlView& view, const std::string& rpy_key,
                        const std::string& quaternion_key);

/** The objects that a name of the scene stands for: the object of that name, or all that one entry
 (a URDF) gave. */
using SceneNames = std::map<std::string, std::vector<int>>;

/** The list `scene`: appends to Model::objects; `friction` is for those that state none. */
SceneNames ReadScene(const YamlView& scene, const PackageMap& packages, double friction,
                     Model* model, std::vector<std::string>* warnings);

/** contact.friction, read before the scene. */
double ReadDefaultFriction(const std::optional<YamlView>& contact);

/** The map `contact`: fills Model::contact and Model::sites. */
void ReadContact(const std::optional<YamlView>& contact, const SceneNames& names, Model* model);

/** Postures by name, as their sources state them: only the joints they name. */
class PostureTable {
 public:
  /** Takes the SRDF's postures and then the map `postures`, whose names win. */
  PostureTable(const RobotDescription& description, const std::optional<YamlView>& postures,
               const KinematicTree& tree, std::vector<std::string>* warnings);

  /** Sets the posture the others start from, named at `view`; without it, zero within the limits.
   */
  void SetBase(const std::optional<YamlView>& view, std::vector<std::string>* warnings);
  const Eigen::VectorXd& base() const { return base_; }

  /** The posture named at `view`, completed and clamped; says so where clamping changed it. */
  Eigen::VectorXd Key(const YamlView& view, std::vector<std::string>* warnings) const;
  /** The posture named at `view`, completed. Refused where it is beyond the limits. */
  Eigen::VectorXd Exact(const YamlView& view) const;
  /** All postures, completed. */
  std::map<std::string, Eigen::VectorXd> All() const;

 private:
  const std::map<int, double>& Find(const YamlView& view) const;
  Eigen::VectorXd Complete(const std::map<int, double>& values) const;
  Eigen::VectorXd Clamped(const YamlView& view, Eigen::VectorXd values,
                          std::vector<std::string>* warnings) const;

  const Robot* robot_;
  const KinematicTree* tree_;
  std::map<std::string, std::map<int, double>> postures_;  // by name, values by column
  Eigen::VectorXd base_;
};

/** The first joint (mimic joints included) that is beyond its limits, described; empty if none is.
 */
std::string DescribeLimitViolation(const Robot& robot, const KinematicTree& tree,
                                   const Eigen::VectorXd& joints);

/** The map `sampling`; `start` and `goal` bound the positions where none are given. */
SamplingRules ReadSampling(const std::optional<YamlView>& sampling, PostureTable* postures,
                           const Pose& start, const Pose& goal, std::vector<std::string>* warnings);

}  // namespace cguide::numeric::io
