#pragma once

#include <string>

#include "cguide/exact/core/model.h"
#include "cguide/numeric/membership.h"

namespace cguide::numeric {

/** A double with four digits, for people. */
std::string Short(double x);

/** A length in millimetres, for people: "3.2 mm". */
std::string Millimetres(double metres);

/** `"LLEG_JOINT5" and "floor"`. */
std::string DescribePair(const Model& model, const Pair& pair);

/** What keeps a configuration out of the set, in words for users. */
std::string DescribeMembership(const Model& model, const Membership& membership);

}  // namespace cguide::numeric
