#pragma once

#include <string>

#include "cguide/verify/audit_checks.h"

namespace cguide::test {

/** What a file format may stumble over: its own marks, line breaks, control bytes, broken UTF-8 and
 U+FFFF. */
inline const std::string kHostileName = "a<b>&\"'\\]]>\t\n\x01\xff\xEF\xBF\xBF {{x}} \xC3\xA9";

/** Two bodies and an object of hostile names. */
inline Model HostileModel() {
  Model model;
  model.robot.links.resize(2);
  model.robot.links[0].name = kHostileName;
  model.robot.links[1].name = "arm";
  Joint joint;
  joint.name = "a";
  joint.type = JointType::kRevolute;
  joint.parent = 0;
  joint.child = 1;
  model.robot.joints.push_back(joint);
  AssignBodiesAndColumns(&model.robot);
  model.objects.resize(1);
  model.objects[0].name = "floor " + kHostileName;
  return model;
}

/** Edges: 0 holds; 1 collides with the object and begins beyond limits; 2 has an undecided pair of
 bodies and loses balance; 3 is undecided about balance; 4 was not reached. */
inline verify::WholeAudit EveryOutcome() {
  verify::WholeAudit audit;
  audit.verdict = Verdict::kFails;
  audit.beyond_limits = {1};
  audit.edges.resize(5);
  audit.edges_done = 4;
  for (int i = 0; i < 4; ++i) audit.edges[static_cast<std::size_t>(i)].done = true;
  audit.edges[0].proof.emplace();
  audit.edges[1].collision.verdict = Verdict::kFails;
  audit.edges[1].collision.pair.body = 0;
  audit.edges[1].collision.pair.other = 0;
  audit.edges[1].collision.s = 0.375;
  audit.edges[1].stability.verdict = Verdict::kUndecided;
  audit.edges[2].collision.verdict = Verdict::kUndecided;
  audit.edges[2].collision.pair.body = 0;
  audit.edges[2].collision.pair.other = 1;
  audit.edges[2].collision.pair.self = true;
  audit.edges[2].collision.s = 0.5;
  audit.edges[2].stability.verdict = Verdict::kFails;
  audit.edges[2].stability.s = 0.75;
  audit.edges[3].stability.verdict = Verdict::kUndecided;
  audit.edges[3].stability.s = 0.125;
  audit.edges[3].stability.reason = "only corners of " + kHostileName + " carry the robot";
  return audit;
}

}  // namespace cguide::test
