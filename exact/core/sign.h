// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cguide {

/** Sign of a real number. There is no enumerator for "unknown": a predicate that may decline
 returns std::optional<Sign>. */
enum class Sign { kNegative = -1, kZero = 0, kPositive = 1 };

constexpr Sign operator-(Sign s) { return static_cast<Sign>(-static_cast<int>(s)); }

}  // namespace cguide
