#pragma once

#include <optional>
#include <span>

#include "cguide/exact/core/model.h"
#include "cguide/exact/core/path.h"
#include "tests/fuzz/near_ties.h"

// Edges near the boundary of C_guide whose truth follows from their making, and others whose truth
// is asked of exact twins afterwards.
namespace cguide::fuzz {

struct EdgeCase {
  Model model;
  Edge edge;
  /** Whether the edge stays in C_guide (kHolds) or not (kFails); kUndecided: not known from the
   making. */
  Verdict truth = Verdict::kUndecided;
  /** Whether the case is about collisions alone: then lost balance must not hide a wrong answer. */
  bool collision_only = false;
};

/** Makes a case, or nothing where rounding spoilt the making. */
using EdgeMaker = std::optional<EdgeCase> (*)(TieRng& rng);

/** A corner of a random moving robot is 1 um to 1 mm deep in a needle, 0.1 mm wide, at one instant
 (box, hull, solid or sheet): never free. */
std::optional<EdgeCase> MakeNeedle(TieRng& rng);

/** The same with an obstacle of ordinary size and a depth of 10 um. */
std::optional<EdgeCase> MakeClip(TieRng& rng);

/** A turning body whose lowest point passes a needle's tip or a face at 1e-12 m to 1e-3 m, on
 either side of it. */
std::optional<EdgeCase> MakeGraze(TieRng& rng);

/** A body that moves along a line past the tip of a needle, at 1e-9 m to 1e-3 m on either side. */
std::optional<EdgeCase> MakeMiss(TieRng& rng);

/** A heavy arm swings its centre of mass 1e-6 m to 1e-2 m short of the edge of the sole, or as far
 beyond it and back. */
std::optional<EdgeCase> MakeBalance(TieRng& rng);

/** A foot slides by 15 cm or so under a fixed centre of mass until its heel or toe is 1e-9 m to
 1e-2 m short of it, or beyond. */
std::optional<EdgeCase> MakeSliding(TieRng& rng);

/** The only site rises to within 1e-9 m to 1e-3 m of the end of the band, or beyond, and comes
 back; contact alone is asked for. */
std::optional<EdgeCase> MakeContact(TieRng& rng);

/** The same of a foot that keeps level on a leg of two opposed joints, under a body that has to
 stay in balance. */
std::optional<EdgeCase> MakeFoot(TieRng& rng);

/** The slides of MakeSliding on a floor that is cut into boxes, hulls, solids and sheets, with or
 without hairline cracks. */
std::optional<EdgeCase> MakeTiles(TieRng& rng);

/** A site moves straight over the ridge or the tip of a roof of triangles, at one end 1e-9 m to
 1e-3 m within the band or beyond; contact alone is asked for. */
std::optional<EdgeCase> MakeRidges(TieRng& rng);

/** An edge of a humanoid in the chair-and-table room that is proved, into which a needle is put as
 in MakeNeedle. */
std::optional<EdgeCase> MakeRoomNeedle(TieRng& rng);

/** Random edges, truth unknown: robots of all joints among all shapes of obstacles, asked for
 contact; blocks that tilt and slide on floors and steps; the humanoid about start and goal. */
std::optional<EdgeCase> MakeRobots(TieRng& rng);
std::optional<EdgeCase> MakeBlocks(TieRng& rng);
std::optional<EdgeCase> MakeRoom(TieRng& rng);

struct EdgeKind {
  const char* name;
  EdgeMaker make;
  bool has_kept;  ///< whether there are edges among them that stay in C_guide
};

std::span<const EdgeKind> EdgeKinds();

}  // namespace cguide::fuzz
