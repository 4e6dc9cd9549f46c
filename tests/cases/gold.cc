#include "tests/cases/gold.h"

#include <cmath>

#include "cguide/exact/linear_algebra.h"
#include "tests/cases/gold_lines.h"

namespace cguide::testing {
namespace {

VectorXq WrenchOf(const VectorXq& p_and_u) {
  const Vector3q p = p_and_u.head(3), u = p_and_u.tail(3);
  VectorXq wrench(6);
  wrench.head(3) = u;
  wrench.tail(3) = exact::Cross(p, u);
  return wrench;
}

std::optional<AppliedForce> AsForce(const VectorXq& p_and_u) {
  const auto doubles = AsDoubles(p_and_u);
  if (!doubles) return std::nullopt;
  return AppliedForce{doubles->head<3>(), doubles->tail<3>()};
}

}  // namespace

std::optional<Eigen::VectorXd> AsDoubles(const VectorXq& v) {
  Eigen::VectorXd result(v.size());
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    result[i] = NearestDouble(v[i]);
    if (!std::isfinite(result[i]) || Lift(result[i]) != v[i]) return std::nullopt;
  }
  return result;
}

std::vector<GoldCone> ReadGoldCones(const std::string& file) {
  std::vector<GoldCone> cones;
  GoldCone cone;
  bool demanded = false;
  Walk(
      file, "cone",
      [&](const std::string& name) {
        cone = GoldCone{};
        cone.name = name;
        cone.forces.emplace();
        demanded = false;
      },
      [&](Line& line) {
        if (line.key() == "force" || line.key() == "demand") {
          const VectorXq numbers = line.Numbers(6);
          const auto force = AsForce(numbers);
          demanded |= line.key() == "demand";
          if (line.key() == "demand") {
            cone.demand = WrenchOf(numbers);
            cone.demand_force = force;
          } else {
            cone.generators.push_back(WrenchOf(numbers));
            if (!force) cone.forces.reset();
            if (cone.forces) cone.forces->push_back(*force);
          }
        } else if (line.key() == "wrench") {
          cone.generators.push_back(line.Numbers(6));
          cone.forces.reset();
        } else if (line.key() == "demand-wrench") {
          cone.demand = line.Numbers(6);
          demanded = true;
        } else if (line.key() == "expect") {
          cone.expect = Choose<exact::Membership>(line, {{"interior", exact::Membership::kInterior},
                                                         {"boundary", exact::Membership::kBoundary},
                                                         {"outside", exact::Membership::kOutside}});
        } else if (line.key() == "rank") {
          cone.rank = line.Integer();
        } else if (line.key() == "facets") {
          cone.facets = line.Integer();
        } else {
          line.Refuse("unknown key \"" + line.key() + "\"");
        }
      },
      [&](Line& line) {
        if (!demanded) line.Refuse("the case has no demand");
        if (!cone.demand_force) cone.forces.reset();
        cones.push_back(cone);
      });
  return cones;
}

std::vector<GoldHulls> ReadGoldHulls(const std::string& file) {
  std::vector<GoldHulls> all;
  GoldHulls hulls;
  Walk(
      file, "hulls",
      [&](const std::string& name) {
        hulls = GoldHulls{};
        hulls.name = name;
        hulls.squared = -1;
      },
      [&](Line& line) {
        if (line.key() == "a") {
          hulls.a.push_back(line.Numbers(3));
        } else if (line.key() == "b") {
          hulls.b.push_back(line.Numbers(3));
        } else if (line.key() == "squared") {
          hulls.squared = line.Number();
        } else {
          line.Refuse("unknown key \"" + line.key() + "\"");
        }
      },
      [&](Line& line) {
        if (hulls.a.empty() || hulls.b.empty() || hulls.squared < 0) {
          line.Refuse("the case needs points a and b and a squared distance");
        }
        all.push_back(hulls);
      });
  return all;
}

namespace {

exact::EquilibriumQuery EmptyQuery() {
  exact::EquilibriumQuery query;
  query.mass = 56;
  query.gravity = {0, 0, ParseRational("-9.81")};
  return query;
}

/** False where the line is none of a query. */
bool ReadQueryLine(Line& line, exact::EquilibriumQuery* query) {
  if (line.key() == "contact") {
    exact::ExactContact contact;
    contact.p = line.Numbers(3);
    contact.cone.w = line.Numbers(3);
    contact.cone.mu = line.Number();
    query->contacts.push_back(contact);
    return true;
  }
  if (line.key() != "com") return false;
  query->com = line.Numbers(3);
  return true;
}

}  // namespace

std::vector<GoldStance> ReadGoldStances(const std::string& file) {
  std::vector<GoldStance> stances;
  GoldStance stance;
  Walk(
      file, "stance",
      [&](const std::string& name) {
        stance = GoldStance{};
        stance.name = name;
        stance.query = EmptyQuery();
      },
      [&](Line& line) {
        if (ReadQueryLine(line, &stance.query)) return;
        if (line.key() == "expect") {
          stance.expect = Choose<Verdict>(line, {{"holds", Verdict::kHolds},
                                                 {"fails", Verdict::kFails},
                                                 {"undecided", Verdict::kUndecided}});
        } else if (line.key() == "rank") {
          stance.rank = line.Integer();
        } else if (line.key() == "reason") {
          stance.reason =
              Choose<exact::StabilityReason>(line, {{"boundary", exact::StabilityReason::kBoundary},
                                                    {"rank", exact::StabilityReason::kRank}});
        } else {
          line.Refuse("unknown key \"" + line.key() + "\"");
        }
      },
      [&](Line&) { stances.push_back(stance); });
  return stances;
}

std::vector<GoldLimit> ReadGoldLimits(const std::string& file) {
  std::vector<GoldLimit> limits;
  GoldLimit limit;
  std::optional<Vector3q> direction;
  bool accelerates = false;
  Walk(
      file, "limit",
      [&](const std::string& name) {
        limit = GoldLimit{};
        limit.name = name;
        limit.query = EmptyQuery();
        direction.reset();
      },
      [&](Line& line) {
        if (ReadQueryLine(line, &limit.query)) return;
        if (line.key() == "accelerate" || line.key() == "displace") {
          accelerates = line.key() == "accelerate";
          direction = line.Numbers(3);
        } else if (line.key() == "expect") {
          const std::string word = line.Word();
          limit.expect = word == "none"        ? exact::ProgramStatus::kInfeasible
                         : word == "unbounded" ? exact::ProgramStatus::kUnbounded
                                               : exact::ProgramStatus::kOptimal;
          if (limit.expect == exact::ProgramStatus::kOptimal) limit.value = line.NumberIn(word);
        } else {
          line.Refuse("unknown key \"" + line.key() + "\"");
        }
      },
      [&](Line& line) {
        if (!direction) line.Refuse("a limit has to accelerate or displace");
        limit.family = accelerates ? exact::AccelerationFamily(limit.query, *direction)
                                   : exact::DisplacementFamily(limit.query, *direction);
        limits.push_back(limit);
      });
  return limits;
}

}  // namespace cguide::testing
