#include "cguide/numeric/describe.h"

#include <cstdio>

namespace cguide::numeric {

std::string Short(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

std::string Millimetres(double metres) { return Short(1000 * metres) + " mm"; }

std::string DescribePair(const Model& model, const Pair& pair) {
  const std::string& other =
      pair.self ? model.robot.bodies[pair.other].name : model.objects[pair.other].name;
  return "\"" + model.robot.bodies[pair.body].name + "\" and \"" + other + "\"";
}

std::string DescribeMembership(const Model& model, const Membership& membership) {
  const bool sure = membership.verdict == Verdict::kFails;
  switch (membership.obstruction) {
    case Obstruction::kNone:
      return "in the set";
    case Obstruction::kLimits:
      return "a joint is outside its limits";
    case Obstruction::kCollision:
      return DescribePair(model, membership.pair) + (sure ? " overlap" : " may touch");
    case Obstruction::kNoContact:
      return sure ? "no body is within the contact band of an obstacle"
                  : "contact is within rounding of the band's end";
    case Obstruction::kUnstable:
      return sure ? "not statically stable" : "balance is within rounding of its limit";
  }
  return "unknown";
}

}  // namespace cguide::numeric
