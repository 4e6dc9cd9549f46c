#pragma once

#include <string>

#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/io/robot_reader.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {

/** A three-joint robot (knee follows hip), with an SRDF that has a bit of everything. */
inline const char* kLegUrdf = R"(<robot name="leg">
  <link name="trunk"><inertial><mass value="3"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="0.4 0.4 0.2"/></geometry></collision></link>
  <link name="badge"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <link name="thigh"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 -0.2"/><geometry><cylinder radius="0.04" length="0.3"/></geometry></collision></link>
  <link name="shank"><collision><origin xyz="0 0 -0.2"/><geometry><cylinder radius="0.04" length="0.3"/></geometry></collision></link>
  <link name="wheel"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <joint name="pin" type="fixed"><parent link="trunk"/><child link="badge"/><origin xyz="0.2 0 0"/></joint>
  <joint name="hip" type="revolute"><parent link="trunk"/><child link="thigh"/><origin xyz="0 0 -0.1"/>
    <axis xyz="0 1 0"/><limit lower="0.25" upper="2" effort="1" velocity="1"/></joint>
  <joint name="knee" type="revolute"><parent link="thigh"/><child link="shank"/><origin xyz="0 0 -0.4"/>
    <axis xyz="0 1 0"/><limit lower="-3" upper="0" effort="1" velocity="1"/><mimic joint="hip" multiplier="-2"/></joint>
  <joint name="axle" type="continuous"><parent link="shank"/><child link="wheel"/><origin xyz="0 0 -0.4"/><axis xyz="0 1 0"/></joint>
</robot>
)";

inline const char* kLegSrdf = R"(<robot name="leg">
  <group name="all"><joint name="hip"/></group>
  <group_state name="bent" group="all"><joint name="hip" value="1"/></group_state>
  <group_state name="too_bent" group="all"><joint name="hip" value="2.5"/></group_state>
  <group_state name="knee_beyond" group="all"><joint name="hip" value="1.75"/></group_state>
  <group_state name="odd" group="all"><joint name="elbow" value="1"/><joint name="axle" value="7"/></group_state>
  <disable_collisions link1="trunk" link2="shank" reason="example"/>
</robot>
)";

/** A folder with the leg and one problem file. */
class LegProblem {
 public:
  LegProblem() {
    folder_.Write("robots/leg.urdf", kLegUrdf);
    folder_.Write("robots/leg.srdf", kLegSrdf);
  }
  const TemporaryFolder& folder() const { return folder_; }

  /** The given lines, after schema and robot; default endpoints where they name none. */
  std::filesystem::path Write(const std::string& lines) const {
    std::string text =
        "schema: cguide-problem/1\nrobot: {urdf: ../robots/leg.urdf, srdf: ../robots/leg.srdf}\n" +
        lines;
    for (const char* end : {"start", "goal"}) {
      if (lines.find("\n" + std::string(end) + ":") == std::string::npos &&
          lines.find(std::string(end) + ":") != 0) {
        text += std::string(end) + ": {posture: bent, root: {xyz_m: [0, 0, 1]}}\n";
      }
    }
    if (lines.find("scene:") == std::string::npos) text += "scene: []\n";
    return folder_.Write("problems/leg.yaml", text);
  }
  Problem Read(const std::string& lines) const { return ReadProblem(Write(lines)); }
  std::string Message(const std::string& lines) const {
    const auto refusal = RefusalOf([&] { Read(lines); });
    REQUIRE(refusal);
    return refusal->message;
  }

 private:
  TemporaryFolder folder_;
};

inline bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace cguide::numeric::io
