// A contact planner driven by a guide and, for comparison, by the distance to the goal.
//   contact_planner PROBLEM GUIDE ... [--nodes N] [--seconds S] [--joint-weight X] [--picture FILE]
#include <cguide/exact/core/error.h>
#include <cguide/numeric/io/guide_io.h>
#include <cguide/numeric/io/problem_reader.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "search.h"

int main(int argc, char** argv) try {
  using namespace contact_planner;
  const auto problem = cguide::numeric::io::ReadProblem(argv[1]);
  const auto guide = cguide::numeric::io::ReadGuide(argv[2]).path.waypoints;
  const cguide::numeric::World world(problem.model);
  const Setting setting(world, LimbsOf(problem.model, {"RLEG_JOINT5", "LLEG_JOINT5", "RLEG_JOINT2", "LLEG_JOINT2", "RARM_JOINT5", "LARM_JOINT5"}));
  SearchOptions options;
  options.node_limit = argc > 3 ? atoi(argv[3]) : 100;
  options.time_limit_s = 120;
  cguide::planner::PotentialOptions potential_options;
  potential_options.metric.joints = argc > 4 ? atof(argv[4]) : 0.3;
  potential_options.weight = argc > 5 ? atof(argv[5]) : 4;
  if (getenv("ROT")) potential_options.metric.rotation = atof(getenv("ROT"));
  if (getenv("COST")) options.step_cost = atof(getenv("COST"));
  if (getenv("SEED")) options.place_sigma += 1e-6 * atof(getenv("SEED"));
  if (argc > 7) options.lookahead = atof(argv[7]);
  for (const bool guided : {true, false}) {
    if (argc > 6 && (argv[6][0] == 'g') != guided) continue;
    cguide::numeric::Rng rng(1);
    const cguide::planner::GuidePotential potential(guided ? guide : std::vector{guide.back()}, potential_options);
    const SearchResult r = SearchStances(setting, guide.front(), guide.back(), potential, options, rng);
    std::printf("%s: %s, %zu expanded, %zu nodes, %.1f s, %ld postures, %.1f it, goal distance %.3f\n", guided ? "guide" : "goal", ToString(r.stop), r.expanded.size(), r.nodes.size(), r.seconds, r.postures, double(r.iterations) / double(r.postures), r.goal_distance);
    if (getenv("TREE")) for (size_t i = 0; i < r.nodes.size(); ++i) { const auto& n = r.nodes[i]; std::printf("   %zu<-%d V %.3f %s grips %zu root %.3f %.3f %.3f expanded %ld\n", i, n.parent, n.value, n.move.c_str(), n.stance.size(), n.q.X_WB.p.x(), n.q.X_WB.p.y(), n.q.X_WB.p.z(), long(std::find(r.expanded.begin(), r.expanded.end(), int(i)) - r.expanded.begin())); }
    for (int i : r.Sequence()) std::printf("  %s V %.3f root %.3f %.3f %.3f\n", r.nodes[i].move.c_str(), r.nodes[i].value, r.nodes[i].q.X_WB.p.x(), r.nodes[i].q.X_WB.p.y(), r.nodes[i].q.X_WB.p.z());
  }
  return 0;
} catch (const std::exception& error) {
  std::cerr << "contact_planner: " << error.what() << '\n';
  return 3;
}
