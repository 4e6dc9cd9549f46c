#include "tests/cases/wrench_sets.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace cguide::testing {
namespace {

using Eigen::Vector3d;
using numeric::Rng;
using numeric::Uniform;

double Between(Rng& rng, double a, double b) { return a + (b - a) * Uniform(rng); }

double Snap(double x) { return std::round(x * 0x1p20) * 0x1p-20; }

Vector3d Stored(const Vector3d& v, Storage storage) {
  return storage == Storage::kSnapped ? Vector3d(v.unaryExpr(&Snap)) : v;
}

struct Patch {
  Vector3d p;
  Eigen::Matrix3d R;  ///< third column: the normal
  double mu = 0.5;
};

Eigen::Matrix3d Frame(const Vector3d& n, double yaw) {
  return (Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), n) *
          Eigen::AngleAxisd(yaw, Vector3d::UnitZ()))
      .toRotationMatrix();
}

Patch RandomPatch(int index, Rng& rng) {
  Vector3d p(Between(rng, -0.5, 0.5), Between(rng, -0.5, 0.5), 0), n = Vector3d::UnitZ();
  const double kind = Uniform(rng);
  if (index >= 1 && kind < 0.3) {  // a slope
    n = Vector3d(Between(rng, -0.4, 0.4), Between(rng, -0.4, 0.4), 1).normalized();
  }
  if (index >= 2) {
    p[2] = Between(rng, 0.2, 1.2);
    if (kind > 0.5) {  // a hand against a wall
      const double yaw = Between(rng, -std::numbers::pi, std::numbers::pi);
      n = Vector3d(std::cos(yaw), std::sin(yaw), 0);
      p -= 0.6 * n;
    }
  }
  return {p, Frame(n, Between(rng, -std::numbers::pi, std::numbers::pi)), Between(rng, 0.3, 0.9)};
}

void AddPatch(const Patch& patch, int sides, Storage storage, WrenchSet* set) {
  for (const double x : {0.11, -0.11}) {
    for (const double y : {0.06, -0.06}) {
      const Vector3d p = Stored(patch.p + patch.R * Vector3d(x, y, 0), storage);
      set->centroid += p;
      for (int k = 0; k < sides; ++k) {
        const double angle = (2 * k + 1) * std::numbers::pi / sides;
        const Vector3d u(patch.mu * std::cos(angle), patch.mu * std::sin(angle), 1);
        set->generators.push_back({p, Stored((patch.R * u).normalized(), storage)});
      }
    }
  }
  ++set->patches;
}

// Dyadic pieces of the exact ties. A vertical pyramid with friction 1/2: (+-1/2, +-1/2, 1).
void AddDyadicPoint(const Vector3d& p, int normal_axis, double normal_sign, WrenchSet* set) {
  for (const double s : {0.5, -0.5}) {
    for (const double t : {0.5, -0.5}) {
      Vector3d u;
      u[normal_axis] = normal_sign;
      u[(normal_axis + 1) % 3] = s;
      u[(normal_axis + 2) % 3] = t;
      set->generators.push_back({p, u});
    }
  }
}

void AddDyadicFoot(const Vector3d& p, WrenchSet* set) {
  for (const double x : {0.125, -0.125}) {
    for (const double y : {0.0625, -0.0625}) AddDyadicPoint(p + Vector3d(x, y, 0), 2, 1, set);
  }
}

double Dyadic(Rng& rng, int bits) {
  return std::ldexp(std::floor(std::ldexp(Uniform(rng), bits)), -bits);
}

double Beside(Rng& rng) {
  const int choice = static_cast<int>(Uniform(rng) * 4);
  const double offset = std::ldexp(1.0, -30 - static_cast<int>(Uniform(rng) * 11));
  return choice == 0 ? offset : choice == 1 ? -offset : 0;
}

AppliedForce Weight(const Vector3d& com) { return {com, Vector3d(0, 0, 568)}; }

TieCase FootEdge(Rng& rng) {
  TieCase result{"foot edge", {"foot edge", 1, 4, {}, Vector3d::Zero()}, {}};
  const Vector3d p(Dyadic(rng, 4), Dyadic(rng, 4), 0);
  AddDyadicFoot(p, &result.set);
  result.demand = Weight(p + Vector3d(0.125 + Beside(rng), Dyadic(rng, 6) / 16, Dyadic(rng, 5)));
  return result;
}

TieCase FootVertex(Rng& rng) {
  TieCase result{"foot vertex", {"foot vertex", 1, 4, {}, Vector3d::Zero()}, {}};
  const Vector3d p(Dyadic(rng, 4), Dyadic(rng, 4), Dyadic(rng, 4));
  AddDyadicFoot(p, &result.set);
  result.demand = Weight(p + Vector3d(0.125 + Beside(rng), 0.0625, 0.75));
  return result;
}

TieCase TwoFeetEdge(Rng& rng) {
  TieCase result{"two feet edge", {"two feet edge", 2, 4, {}, Vector3d::Zero()}, {}};
  const double x = Dyadic(rng, 4);
  AddDyadicFoot({x, 0, 0}, &result.set);
  AddDyadicFoot({x, 0.5, 0}, &result.set);
  result.demand = Weight({x + 0.125 + Beside(rng), Dyadic(rng, 6) / 2, 0.75});
  return result;
}

TieCase Duplicates(Rng& rng) {
  TieCase result = TwoFeetEdge(rng);
  result.name = result.set.family = "duplicates, multiples and zeros";
  const std::size_t n = result.set.generators.size();
  for (std::size_t i = 0; i < n; i += 3) {
    AppliedForce copy = result.set.generators[i];
    copy.u *= std::ldexp(1.0, static_cast<int>(i % 5) - 2);
    result.set.generators.push_back(copy);
    if (i % 2 == 0) result.set.generators.push_back({copy.p, Vector3d::Zero()});
  }
  return result;
}

TieCase OnePoint(Rng& rng) {
  TieCase result{"one point", {"one point", 0, 4, {}, Vector3d::Zero()}, {}};
  const Vector3d p(Dyadic(rng, 4), Dyadic(rng, 4), 0);
  AddDyadicPoint(p, 2, 1, &result.set);
  result.demand = Weight(p + Vector3d(Beside(rng), 0, 0.5));
  return result;
}

TieCase TwoPoints(Rng& rng) {
  TieCase result{"two points", {"two points", 0, 4, {}, Vector3d::Zero()}, {}};
  AddDyadicPoint({0, -0.25, 0}, 2, 1, &result.set);
  AddDyadicPoint({0, 0.25, 0}, 2, 1, &result.set);
  result.demand = Weight({Beside(rng), Dyadic(rng, 4) / 2 - 0.25, 0.5});
  return result;
}

TieCase FacingWalls(Rng& rng) {
  TieCase result{"facing walls", {"facing walls", 2, 4, {}, Vector3d::Zero()}, {}};
  for (const double s : {1.0, -1.0}) {
    for (const double y : {0.125, -0.125}) {
      for (const double z : {0.125, -0.125}) AddDyadicPoint({-0.5 * s, y, z}, 0, s, &result.set);
    }
  }
  result.demand = Weight({Dyadic(rng, 4), Beside(rng), Dyadic(rng, 4)});
  return result;
}

TieCase FacingPoints(Rng& rng) {
  TieCase result{"facing points", {"facing points", 0, 4, {}, Vector3d::Zero()}, {}};
  AddDyadicPoint({-0.5, 0, 0}, 0, 1, &result.set);
  AddDyadicPoint({0.5, 0, 0}, 0, -1, &result.set);
  result.demand = Weight({Dyadic(rng, 3) - 0.5, Beside(rng), 0.25});
  return result;
}

TieCase WallAndFloor(Rng& rng) {
  TieCase result{"wall and floor", {"wall and floor", 0, 4, {}, Vector3d::Zero()}, {}};
  for (const double y : {0.25, -0.25}) {
    AddDyadicPoint({0, y, 0}, 2, 1, &result.set);
    AddDyadicPoint({-0.5, y, 0.75}, 0, 1, &result.set);
  }
  result.demand = Weight({Beside(rng) + (Uniform(rng) < 0.5 ? 0 : 0.125), Dyadic(rng, 4) / 4, 1});
  return result;
}

TieCase Nothing(Rng& rng) {
  TieCase result{"no generator", {"no generator", 0, 0, {}, Vector3d::Zero()}, {}};
  if (Uniform(rng) < 0.5) result.set.generators.assign(3, AppliedForce{});
  result.demand = Weight({0, 0, 0.5});
  return result;
}

}  // namespace

WrenchSet RandomStanceSet(int patches, int sides, Storage storage, Rng& rng) {
  WrenchSet set;
  set.family = storage == Storage::kSnapped ? "snapped stance" : "stance";
  set.sides = sides;
  for (int k = 0; k < patches; ++k) AddPatch(RandomPatch(k, rng), sides, storage, &set);
  set.centroid /= 4.0 * patches;
  return set;
}

AppliedForce RandomDemand(const WrenchSet& set, Storage storage, Rng& rng) {
  const Vector3d com = set.centroid + Vector3d(Between(rng, -0.35, 0.35), Between(rng, -0.35, 0.35),
                                               Between(rng, 0.2, 0.8));
  return {Stored(com, storage), Stored({0, 0, 58 * 9.81}, storage)};
}

AppliedForce Displaced(const WrenchSet& set, const AppliedForce& demand, double offset) {
  Vector3d direction = demand.p - set.centroid;
  direction[2] = 0;
  const double length = direction.norm();
  AppliedForce result = demand;
  if (length > 0) result.p += (offset / length) * direction;
  return result;
}

std::vector<TieCase> TieCases(int count, Rng& rng) {
  constexpr TieCase (*kMakers[])(Rng&) = {FootEdge,     FootVertex, TwoFeetEdge, Duplicates,
                                          OnePoint,     TwoPoints,  FacingWalls, FacingPoints,
                                          WallAndFloor, Nothing};
  std::vector<TieCase> cases;
  for (int i = 0; i < count; ++i) cases.push_back(kMakers[i % std::size(kMakers)](rng));
  return cases;
}

}  // namespace cguide::testing
