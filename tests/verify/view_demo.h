#pragma once

#include "cguide/verify/view.h"

namespace cguide::verify {

/** A made-up humanoid rises from a chair beside a table: every shape kind occurs, most instants
 hold, some fail and some are undecided. For looking at the page and for testing it. The verdicts
 are those of a toy (flat support polygon), not of this library. */
ViewInput DemoInput();

}  // namespace cguide::verify
