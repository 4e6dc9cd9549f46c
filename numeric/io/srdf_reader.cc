#include <algorithm>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/srdf_reader_internal.h"
#include "cguide/numeric/io/urdf_xml_internal.h"

namespace cguide::numeric::io {
namespace {

using tinyxml2::XMLElement;

std::vector<double> ReadValues(const XmlFile& xml, const XMLElement& joint) {
  try {
    return ParseNumbers(xml.Text(joint, "value"));
  } catch (const Error& error) {
    if (joint.Attribute("value") == nullptr) throw;
    xml.Refuse(joint, std::string("attribute \"value\": ") + error.what(), "write decimal numbers");
  }
}

// What one group_state says that the robot cannot take.
struct Skipped {
  std::vector<std::string> unknown;
  std::vector<std::string> dependent;
};

void ReadJointValue(const XmlFile& xml, const XMLElement& element, const Robot& robot,
                    NamedPosture* posture, Skipped* skipped) {
  const std::string name = xml.Text(element, "name");
  const std::vector<double> values = ReadValues(xml, element);
  const int joint = FindJoint(robot, name);
  if (joint < 0 && values.size() == 7) {
    Pose X{{values[0], values[1], values[2]}, {values[3], values[4], values[5], values[6]}};
    posture->root = X;
  } else if (joint < 0) {
    skipped->unknown.push_back(name);
  } else if (robot.joints[joint].column < 0) {
    skipped->dependent.push_back(name);
  } else if (values.size() != 1) {
    xml.Refuse(element, "joint \"" + name + "\" has " + std::to_string(values.size()) + " values",
               "it needs one");
  } else if (const auto [found, added] = posture->joints.emplace(name, values[0]);
             !added && found->second != values[0]) {
    xml.Refuse(element, "posture \"" + posture->name + "\" gives joint \"" + name + "\" two values",
               "keep one of them");
  }
}

// States of one name for several groups make one posture.
NamedPosture* FindPosture(const std::string& name, RobotDescription* description) {
  for (NamedPosture& posture : description->postures) {
    if (posture.name == name) return &posture;
  }
  description->postures.push_back({name, {}, {}});
  return &description->postures.back();
}

void ReadPostures(const XmlFile& xml, RobotDescription* description) {
  for (const XMLElement* state : Children(xml.root(), "group_state")) {
    NamedPosture* posture = FindPosture(xml.Text(*state, "name"), description);
    Skipped skipped;
    for (const XMLElement* joint : Children(*state, "joint")) {
      ReadJointValue(xml, *joint, description->robot, posture, &skipped);
    }
    const std::string subject = xml.Place(*state) + ": posture \"" + posture->name + "\" ";
    if (!skipped.unknown.empty()) {
      description->warnings.push_back(
          subject + "names joints the robot does not have, skipped: " + ListNames(skipped.unknown));
    }
    if (!skipped.dependent.empty()) {
      description->warnings.push_back(
          subject + "sets fixed or mimic joints, skipped: " + ListNames(skipped.dependent));
    }
  }
}

void ReadDisabledPairs(const XmlFile& xml, RobotDescription* description) {
  std::vector<std::string> unknown;
  const auto BodyOf = [&](const XMLElement& element, const char* attribute) {
    const std::string name = xml.Text(element, attribute);
    const int link = FindLink(description->robot, name);
    if (link >= 0) return description->robot.links[link].body;
    if (std::find(unknown.begin(), unknown.end(), name) == unknown.end()) unknown.push_back(name);
    return -1;
  };
  auto& pairs = description->disabled_bodies;
  for (const XMLElement* element : Children(xml.root(), "disable_collisions")) {
    const int a = BodyOf(*element, "link1");
    const int b = BodyOf(*element, "link2");
    if (a >= 0 && b >= 0 && a != b) pairs.emplace_back(std::min(a, b), std::max(a, b));
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  if (unknown.empty()) return;
  description->warnings.push_back(xml.path().string() +
                                  ": disable_collisions names links the robot does not have, "
                                  "skipped: " +
                                  ListNames(unknown));
}

void ReadEndEffectors(const XmlFile& xml, RobotDescription* description) {
  for (const XMLElement* element : Children(xml.root(), "end_effector")) {
    EndEffector effector{xml.Text(*element, "name"), xml.Text(*element, "parent_link")};
    if (FindLink(description->robot, effector.parent_link) < 0) {
      description->warnings.push_back(xml.Place(*element) + ": end effector \"" + effector.name +
                                      "\" hangs on link \"" + effector.parent_link +
                                      "\", which the robot does not have; skipped");
      continue;
    }
    description->end_effectors.push_back(std::move(effector));
  }
}

}  // namespace

void ReadSrdf(const std::filesystem::path& srdf, RobotDescription* description) {
  const XmlFile xml(srdf);
  if (std::string(xml.root().Name()) != "robot") {
    xml.Refuse(xml.root(),
               std::string("the root element is <") + xml.root().Name() + ">, not <robot>",
               "give an SRDF file");
  }
  const std::string name = xml.Text(xml.root(), "name");
  if (name != description->robot.name) {
    description->warnings.push_back(srdf.string() + ": written for robot \"" + name +
                                    "\", read for robot \"" + description->robot.name + "\"");
  }
  ReadPostures(xml, description);
  ReadDisabledPairs(xml, description);
  ReadEndEffectors(xml, description);
}

}  // namespace cguide::numeric::io
