// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cguide/exact/core/model.h"

namespace cguide::check {

/** Refuses models of which nothing can be proved here: those that CheckModel refuses;
 ContactModel::kNearest; lengths below 1e-300 m; solids whose triangles are not closed and
 consistently oriented, so that points have no winding number; more than 2e7 pairs of a shape and a
 piece, or of shapes, to be kept apart.
 @throws Error (kBadInput) with the reason. */
void RequireCheckable(const Model& model);

/** Whether the border of the triangles vanishes: every directed edge, by positions, is used as
 often as its reverse. Then each point off the triangles has one winding number, a whole one. */
bool IsClosed(const Solid& solid);

}  // namespace cguide::check
