#pragma once

#include <span>
#include <vector>

#include "cguide/numeric/friction.h"

namespace cguide::numeric {

/** Sorts `indices` of rows so that the double description method meets few rays on its way: the
 outermost directions first. With C the sum of r r' over all of these rows (and of the rows they
 leave out, if the caller wants them to count), in the metric of its inverse, the cosine of a row
 and the mean of the rows ascends: linear maps of the rows change neither C's metric nor the
 cosines, and so, but for rounding, not the order. Rows near the mean come last, when the cone holds
 most of them already: on stances a fifth to a half of the rays of a random order are never born.

 A choice, not a verdict: any order gives the same cone. Deterministic; ties by index. */
void SortOutermostFirst(std::span<const Vector6d> rows, std::span<const int> nonzero,
                        std::vector<int>* indices);

}  // namespace cguide::numeric
