#pragma once

// Every error bound of this library assumes that each double operation is rounded once, to nearest,
// and that comparisons with NaN are false. Options that let the compiler reorder sums, contract
// products into sums or assume finite numbers would make the bounds false without a sign, so they
// end the build.
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error \
    "cguide's error bounds do not hold under -ffast-math or -ffinite-math-only; remove the option"
#endif

#include <cfenv>
#include <cfloat>

#include "cguide/exact/core/error.h"

static_assert(FLT_EVAL_METHOD == 0, "cguide needs doubles that are evaluated as doubles (no x87)");

namespace cguide::numeric {

/** Refuses to go on in a thread whose rounding mode is not to nearest: some libraries change it
 when they are loaded (PPL does), and every bound would be false. Costs a few nanoseconds.
 @throws Error (kInvalidArgument). */
inline void RequireRoundToNearest() {
  Require(std::fegetround() == FE_TONEAREST,
          "double arithmetic of this thread does not round to nearest; a library has changed the "
          "mode: call std::fesetround(FE_TONEAREST) first");
}

}  // namespace cguide::numeric
