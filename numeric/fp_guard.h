#pragma once

// Every error bound of this library assumes that each double operation is rounded once, to nearest,
// and that comparisons with NaN are false. Options that let the compiler reorder sums, contract
// products into sums or assume finite numbers would make the bounds false without a sign, so they
// end the build.
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error \
    "cguide's error bounds do not hold under -ffast-math or -ffinite-math-only; remove the option"
#endif

#include <cfloat>

static_assert(FLT_EVAL_METHOD == 0, "cguide needs doubles that are evaluated as doubles (no x87)");
