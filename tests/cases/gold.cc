#include "tests/cases/gold.h"

#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::testing {
namespace {

/** One line inside a case: a key and what follows it. */
class Line {
 public:
  Line(std::string where, std::string text) : where_(std::move(where)), in_(std::move(text)) {
    in_ >> key_;
  }
  const std::string& key() const { return key_; }

  std::string Word() {
    std::string word;
    if (!(in_ >> word)) Refuse("a word is missing");
    return word;
  }
  std::string Rest() {
    std::string rest;
    std::getline(in_, rest);
    return rest;
  }
  VectorXq Numbers(int count) {
    VectorXq v(count);
    for (Rational& x : v) x = Number();
    return v;
  }
  Rational Number() {
    const std::string word = Word();
    try {
      return ParseRational(word);
    } catch (const Error& e) {
      Refuse(e.what());
    }
  }
  int Integer() {
    const Rational x = Number();
    if (x.get_den() != 1 || abs(x) > 1000000) Refuse("a small integer is needed");
    return static_cast<int>(x.get_num().get_si());
  }
  void End() {
    std::string word;
    if (in_ >> word) Refuse("\"" + word + "\" is too much");
  }
  [[noreturn]] void Refuse(const std::string& why) const {
    throw Error(Error::Code::kBadInput, where_ + ": " + why);
  }

 private:
  std::string where_, key_;
  std::istringstream in_;
};

/** Walks a file: `begin(name)` at "<kind> <name>", `line(line)` inside, `end()` at "end". */
void Walk(const std::string& file, const std::string& kind,
          const std::function<void(const std::string&)>& begin,
          const std::function<void(Line&)>& line, const std::function<void(Line&)>& end) {
  std::ifstream in(file);
  if (!in) throw Error(Error::Code::kBadInput, file + ": cannot be read");
  bool open = false;
  int number = 0;
  for (std::string text; std::getline(in, text);) {
    Line current(file + ":" + std::to_string(++number), text);
    if (current.key().empty() || current.key()[0] == '#') continue;
    if (!open) {
      if (current.key() != kind) current.Refuse("\"" + kind + "\" is expected");
      begin(current.Word());
      open = true;
    } else if (current.key() == "end") {
      end(current);
      open = false;
    } else if (current.key() == "origin") {
      current.Rest();
    } else {
      line(current);
    }
    current.End();
  }
  if (open) throw Error(Error::Code::kBadInput, file + ": the last case has no end");
}

template <typename Value>
Value Choose(Line& line, const std::map<std::string, Value>& values) {
  const std::string word = line.Word();
  const auto found = values.find(word);
  if (found == values.end()) line.Refuse("\"" + word + "\" is not among the expected words");
  return found->second;
}

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

std::vector<GoldStance> ReadGoldStances(const std::string& file) {
  std::vector<GoldStance> stances;
  GoldStance stance;
  Walk(
      file, "stance",
      [&](const std::string& name) {
        stance = GoldStance{};
        stance.name = name;
        stance.query.mass = 56;
        stance.query.gravity = {0, 0, ParseRational("-9.81")};
      },
      [&](Line& line) {
        if (line.key() == "contact") {
          exact::ExactContact contact;
          contact.p = line.Numbers(3);
          contact.cone.w = line.Numbers(3);
          contact.cone.mu = line.Number();
          stance.query.contacts.push_back(contact);
        } else if (line.key() == "com") {
          stance.query.com = line.Numbers(3);
        } else if (line.key() == "expect") {
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

}  // namespace cguide::testing
