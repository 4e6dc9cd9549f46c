#pragma once

#include <string>

#include "cguide/exact/core/model.h"
#include "cguide/numeric/membership.h"

namespace cguide::cli {

/** `"LLEG_JOINT5" and "floor"`. */
std::string DescribePair(const Model& model, const numeric::Pair& pair);

/** What keeps a configuration out of the set, in words. */
std::string DescribeMembership(const Model& model, const numeric::Membership& membership);

}  // namespace cguide::cli
