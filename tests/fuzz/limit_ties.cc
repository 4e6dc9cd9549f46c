// Near ties of demand limits: contacts on one plane across the weight. The centre of mass moves on
// a line in that plane; balance, by normal forces that every pyramid holds, is over the part of the
// line in the hull of the points (tests/cases/flat_stances.cc). So the limit is where the line
// leaves the hull, and there is none where it passes the hull by. The line is aimed at a corner and
// past it, or along an edge and beside it.
#include <algorithm>
#include <optional>

#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/demand_limit.h"
#include "tests/cases/flat_stances.h"
#include "tests/fuzz/near_ties.h"
#include "tests/fuzz/twins.h"

namespace cguide::fuzz {
namespace {

using exact::DemandLimit;
using exact::ProgramStatus;

struct Line {
  Vector3q from, d;
  bool is_tied = false;  ///< through a corner or along an edge
};

Line AimedLine(TieRng& rng, const testing::FlatStance& stance) {
  const auto corner = [&](std::size_t i) {
    return Lift(stance.corners[i % stance.corners.size()]);
  };
  const std::size_t i = rng() % stance.corners.size();
  const Vector3q edge = corner(i + 1) - corner(i), other = corner(i + 2) - corner(i);
  const double step = TinyStep(rng);
  Line line;
  line.is_tied = step == 0;
  const bool along = Below(rng, 3) == 0;
  line.d = edge;
  if (!along) {
    line.d = exact::Scaled(Below(rng, 7) - 3, edge) + exact::Scaled(Below(rng, 7) - 3, other);
  }
  if (exact::IsZero(line.d)) line.d = other;
  const Rational back = Lift(GridValue(rng, 16, 8));
  line.from =
      corner(i) - exact::Scaled(back, line.d) + exact::Scaled(Lift(step), along ? other : edge);
  // Height does not matter.
  line.from += exact::Scaled(Lift(GridValue(rng, 4, 4)), Lift(stance.w));
  return line;
}

/** The largest z with from + z d in the polygon, up to its height; nothing where there is none. */
std::optional<Rational> WhereItLeaves(const testing::FlatStance& stance, const Line& line) {
  std::optional<Rational> lo, hi;
  const std::size_t n = stance.corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3q a = Lift(stance.corners[i]), edge = Lift(stance.corners[(i + 1) % n]) - a;
    const Vector3q out = exact::Cross(edge, Lift(stance.w));  // counter-clockwise about w
    const Rational room = exact::Dot(out, Vector3q(a - line.from)), rate = exact::Dot(out, line.d);
    if (rate == 0 && room < 0) return std::nullopt;
    if (rate == 0) continue;
    const Rational z = room / rate;
    if (rate > 0 && (!hi || z < *hi)) hi = z;
    if (rate < 0 && (!lo || z > *lo)) lo = z;
  }
  return !lo || !hi || *lo > *hi ? std::nullopt : hi;
}

exact::EquilibriumQuery QueryOf(const testing::FlatStance& stance, const Vector3q& com) {
  exact::EquilibriumQuery query;
  for (const numeric::Contact& c : stance.contacts) {
    query.contacts.push_back({Lift(c.x_W), {Lift(stance.w), Lift(stance.mu)}});
  }
  query.com = com;
  query.mass = 3;
  query.gravity = exact::Scaled(-2, Lift(stance.w));
  return query;
}

std::string Judge(const DemandLimit& limit, const std::optional<Rational>& truth) {
  const ProgramStatus expected = truth ? ProgramStatus::kOptimal : ProgramStatus::kInfeasible;
  if (limit.status != expected) return "the line's limit has the wrong kind";
  if (truth && limit.value != *truth) return "the line's limit is wrong";
  return "";
}

}  // namespace

std::string TiesOfLimits(TieRng& rng, long every, Tally* tally) {
  const testing::FlatStance stance = testing::RandomFlatStance(rng);
  const int sides = 3 + Below(rng, 3);
  for (int k = 0; k < 12; ++k) {
    const Line line = AimedLine(rng, stance);
    const exact::EquilibriumQuery query = QueryOf(stance, line.from);
    const exact::PyramidCone cone = exact::InscribedCone(query, sides);
    const exact::DemandFamily family = exact::DisplacementFamily(query, line.d);
    const DemandLimit limit = numeric::FindDemandLimit(cone, family);
    ++tally->cases;
    tally->tied += line.is_tied;
    std::vector<int> proposed = numeric::ProposeLimitBasis(cone, family), last = limit.basis;
    std::sort(proposed.begin(), proposed.end());
    std::sort(last.begin(), last.end());
    ++(proposed == last ? tally->fast : tally->exact);
    if (!exact::CheckDemandLimit(cone, family, limit)) return "a limit's proof does not check";
    std::string wrong = Judge(limit, WhereItLeaves(stance, line));
    if (!wrong.empty()) return wrong;
    if (!SlowCheckIsDue(*tally, every)) continue;
    ++tally->checked;
    wrong = Judge(exact::FindDemandLimit(cone, family), WhereItLeaves(stance, line));
    if (!wrong.empty()) return "the exact twin: " + wrong;
  }
  return "";
}

}  // namespace cguide::fuzz
