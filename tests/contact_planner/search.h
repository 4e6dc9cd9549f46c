#pragma once

#include <cguide/numeric/sampling.h>

#include <string>
#include <vector>

#include "posture.h"

namespace contact_planner {

struct SearchOptions {
  int node_limit = 500;       ///< nodes expanded
  double time_limit_s = 120;  ///< CPU time
  double lookahead = 0.3;     ///< postures are drawn to the guide this far ahead (metric)
  int places = 3;  ///< places tried for a new contact: the guide's own and random ones near it
  double place_sigma = 0.1;      ///< (m)
  double reach = 0.4;            ///< a limb is tried on faces nearer than this (m)
  double spacing = 0.04;         ///< stances whose contacts are nearer than this are one (m)
  double step_cost = 0.03;       ///< added to the potential for every contact made or broken
  double goal_tolerance = 0.15;  ///< of the root's pose, |p - p'| + acos|q.q'|
  PostureOptions posture;
};

/** A stance reached, with the posture of least potential found in it. */
struct StanceNode {
  Stance stance;
  cguide::Configuration q;
  /** Satisfies the contacts of this stance and of its parent, and is stable with those that both
   have: where the contact is made or broken. */
  cguide::Configuration transition;
  double value = 0;
  double priority = 0;
  int parent = -1;
  int depth = 0;
  std::string move;
};

enum class SearchStop { kSolved, kNodeLimit, kTimeLimit, kExhausted };
const char* ToString(SearchStop stop);

struct SearchResult {
  SearchStop stop = SearchStop::kExhausted;
  std::vector<StanceNode> nodes;
  std::vector<int> expanded;  ///< in this order
  int last = 0;               ///< the goal's node, else the one of least potential
  double seconds = 0;         ///< of CPU time
  long postures = 0;          ///< inverse kinematics asked for
  long iterations = 0;        ///< of them
  double goal_distance = 0;   ///< of the last node's root
  std::vector<int> Sequence() const;
};

/** The contacts at q: of every limb whose sites are in the band of a face, all those sites. */
Stance StanceAt(const Setting& setting, const cguide::Configuration& q,
                PostureWorkspace* workspace);

/** Best-first search over stances, adding or removing one contact at a time [Escande, Kheddar,
 Miossec 2006, 2013]: the node of least priority, potential of its posture + step_cost * depth, is
 expanded; a child is kept if a transition posture and a posture of its own stance are found and no
 node has a like stance. Ends where the limbs of the goal's stance are on its faces, and they alone,
 and the root is within goal_tolerance of the goal's. The potential, a guide's or the one of the
 goal alone, is all that tells the search where to go; postures are drawn to its attractor. */
SearchResult SearchStances(const Setting& setting, const cguide::Configuration& start,
                           const cguide::Configuration& goal,
                           const cguide::planner::GuidePotential& potential,
                           const SearchOptions& options, cguide::numeric::Rng& rng);

}  // namespace contact_planner
