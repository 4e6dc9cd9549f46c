#include "cguide/verify/skin_hint.h"

#include <algorithm>
#include <map>

#include "cguide/numeric/describe.h"

namespace cguide::verify {
namespace {

/** Body and object, and how deep they were seen to overlap. */
using Touching = std::map<std::pair<int, int>, double>;

void Add(const numeric::Pair& pair, double depth, Touching* touching) {
  if (pair.self || pair.body < 0) return;
  double& deepest = (*touching)[{pair.body, pair.other}];
  deepest = std::max(deepest, depth);
}

void Add(const std::vector<Violation>& violations, Touching* touching) {
  for (const Violation& v : violations) {
    if (v.kind == numeric::Obstruction::kCollision) Add(v.pair, v.depth, touching);
  }
}

std::string Hint(const Model& model, int body, int object, double depth) {
  const auto& listed = model.contact.may_touch;
  const bool may_touch =
      std::find(listed.begin(), listed.end(), std::pair(body, object)) != listed.end();
  std::string text = numeric::DescribePair(model, {body, object, false});
  text += depth < 1e-9 ? " touch within rounding"
                       : " overlap by at most about " + numeric::Millimetres(depth);
  text += "; if they are meant to touch, ";
  if (!may_touch) text += "list them in contact.may_touch and ";
  text += "give a contact.skin_m above that";
  if (may_touch) text += ", now " + numeric::Short(model.contact.skin);
  return text;
}

std::vector<std::string> HintsOf(const Model& model, const Touching& touching) {
  std::vector<std::string> hints;
  for (const auto& [pair, depth] : touching) {
    if (depth < kMeantToTouch) hints.push_back(Hint(model, pair.first, pair.second, depth));
  }
  return hints;
}

}  // namespace

std::vector<std::string> SkinHints(const Model& model, const WholeAudit& audit) {
  Touching touching;
  for (const EdgeFinding& edge : audit.edges) {
    if (!edge.done) continue;
    if (edge.collision.verdict == Verdict::kUndecided) Add(edge.collision.pair, 0, &touching);
    Add(edge.measured, &touching);
  }
  return HintsOf(model, touching);
}

std::vector<std::string> SkinHints(const Model& model, const SampledAudit& audit) {
  Touching touching;
  Add(audit.violations, &touching);
  return HintsOf(model, touching);
}

}  // namespace cguide::verify
