#include "cguide/verify/cli/describe.h"

namespace cguide::cli {

std::string DescribePair(const Model& model, const numeric::Pair& pair) {
  const std::string& other =
      pair.self ? model.robot.bodies[pair.other].name : model.objects[pair.other].name;
  return "\"" + model.robot.bodies[pair.body].name + "\" and \"" + other + "\"";
}

std::string DescribeMembership(const Model& model, const numeric::Membership& membership) {
  const bool sure = membership.verdict == Verdict::kFails;
  switch (membership.obstruction) {
    case numeric::Obstruction::kNone:
      return "in the set";
    case numeric::Obstruction::kLimits:
      return "a joint is outside its limits";
    case numeric::Obstruction::kCollision:
      return DescribePair(model, membership.pair) + (sure ? " overlap" : " may touch");
    case numeric::Obstruction::kNoContact:
      return sure ? "no contact" : "contact is within rounding of the band's end";
    case numeric::Obstruction::kUnstable:
      return sure ? "not statically stable" : "balance is within rounding of its limit";
  }
  return "unknown";
}

}  // namespace cguide::cli
