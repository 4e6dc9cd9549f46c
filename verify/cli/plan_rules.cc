#include "cguide/verify/cli/plan_rules.h"

namespace cguide::cli {

std::optional<std::pair<std::string, std::string>> PlanConflict(const PlanArguments& a) {
  const bool holds = !a.hold.empty(), free = a.space == "free", whole = a.edges == "proved";
  struct Rule {
    bool broken;
    const char* option;
    const char* reason;
  };
  const Rule rules[] = {
      {holds && a.planner == "contacts", "--hold",
       "needs --planner rrt or prm, which move no limb on purpose"},
      {holds && free, "--hold", "needs --space guide, in which links are brought back"},
      {holds && !a.roadmap.empty(), "--hold",
       "does not go with --roadmap: a roadmap does not say which links its edges hold"},
      {holds && a.link != "straight", "--hold", "does not go with --link"},
      {holds && a.extension > 0, "--hold",
       "does not go with --extension: the tolerance says how long an extension may be"},
      {!a.roadmap.empty() && a.planner != "prm", "--roadmap", "needs --planner prm"},
      {free && a.planner == "contacts", "--planner",
       "contacts mean nothing with --space free; take rrt or prm"},
      {free && a.link != "straight", "--link", "needs --space guide"},
      {!a.robust.empty() && (free || !whole), "--robust",
       "needs --space guide and --edges proved: it is about proofs"},
      {!a.certificate.empty() && (free || !whole), "--certificate",
       "needs --space guide and --edges proved: there are no proofs else"},
      {a.edge_step && whole, "--edge-step", "needs --edges sampled"},
  };
  for (const Rule& rule : rules) {
    if (rule.broken) return std::pair(std::string(rule.option), std::string(rule.reason));
  }
  return std::nullopt;
}

}  // namespace cguide::cli
