#pragma once

#include <string>
#include <vector>

#include "cguide/verify/sampled_audit.h"
#include "cguide/verify/whole_audit.h"

namespace cguide::verify {

/** Deeper penetrations are not taken for a contact that is meant: recorded feet and rounded poses
 are off by less. It decides which hints are given, and no verdict. */
constexpr double kMeantToTouch = 0.005;

/** Of a path that does not hold: one sentence for each body and object that touch, overlap by less
 than kMeantToTouch where samples measured it, or cannot be told apart, with what to do if they are
 meant to touch (`contact.may_touch`, `contact.skin_m`). Depths are floats for people. */
std::vector<std::string> SkinHints(const Model& model, const WholeAudit& audit);
std::vector<std::string> SkinHints(const Model& model, const SampledAudit& audit);

}  // namespace cguide::verify
