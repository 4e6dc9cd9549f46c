#pragma once

#include "cguide/exact/core/rational.h"
#include "cguide/exact/core/wrench.h"

namespace cguide::exact {

/** The wrench (u, p x u) that an applied force stands for, without rounding.
 @throws Error where a number is not finite. */
VectorXq WrenchOf(const AppliedForce& force);

}  // namespace cguide::exact
