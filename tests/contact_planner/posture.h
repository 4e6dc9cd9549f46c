#pragma once

#include <cguide/numeric/membership.h>
#include <cguide/numeric/task_stack.h>
#include <cguide/numeric/world.h>
#include <cguide/planner/potential_field.h>

#include <optional>
#include <vector>

#include "stance.h"

namespace contact_planner {

/** What stays the same for all postures of a search. */
struct Setting {
  Setting(const cguide::numeric::World& a_world, std::vector<Limb> some_limbs);
  const cguide::numeric::World& world;
  std::vector<Limb> limbs;
  std::vector<Face> faces;
  std::vector<cguide::numeric::Pair> pairs;  ///< that must keep apart
};

/** Scratch of one search. */
struct PostureWorkspace {
  explicit PostureWorkspace(const cguide::numeric::World& world) : guide(world) {}
  cguide::numeric::GuideWorkspace guide;
  cguide::numeric::TaskStackWorkspace stack;
  std::vector<cguide::numeric::Task> tasks;
  std::size_t num_tasks = 0;
  Eigen::MatrixXd com_jacobian;
  std::vector<cguide::numeric::Contact> bearing;
  long iterations = 0;  ///< of all searches with this workspace
};

/** A posture is asked for in which ... */
struct PostureQuery {
  Stance held;                   ///< these touch where they are,
  std::optional<Grip> wanted;    ///< this one touches anywhere on its face, drawn towards its at_W,
  Stance bearing;                ///< these alone (a part of `held`) carry the weight,
  cguide::Configuration target;  ///< and what freedom is left draws here.
};

struct PostureOptions {
  int iterations = 40;
  double gap = 0.01;         ///< of a new contact to its face, inside the band of contact (m)
  double tolerance = 0.003;  ///< of contacts' places and gaps (m)
  double clearance = 0.015;  ///< pairs nearer than this are drawn apart (m)
  double pull = 0.3;         ///< part of the way to the target that one step tries
};

struct Posture {
  cguide::Configuration q;
  Stance stance;     ///< `held` and, placed, `wanted`
  double value = 0;  ///< of the potential
};

/** Minimises the potential over postures of a stance: prioritised inverse kinematics (contacts,
 clearance, balance where it is missing, the new contact's place, root, joints), and of the iterates
 that are feasible the one of least potential. Feasible: within limits, in C_free, every contact in
 place and one that numeric::FindContacts finds, on its face; and the bearing contacts stable
 against their true friction cones (numeric::TryStability). Nothing where no iterate is. */
std::optional<Posture> FindPosture(const Setting& setting, const PostureQuery& query,
                                   const cguide::planner::GuidePotential& potential,
                                   const cguide::Configuration& start,
                                   const PostureOptions& options, PostureWorkspace* workspace);

}  // namespace contact_planner
