#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cguide/exact/cone_membership.h"
#include "cguide/exact/core/path.h"
#include "cguide/exact/core/pose.h"
#include "cguide/exact/core/rational.h"
#include "cguide/exact/core/shape.h"
#include "cguide/exact/core/wrench.h"
#include "cguide/exact/demand_limit.h"
#include "cguide/exact/equilibrium.h"

// Readers of fixtures/gold, whose README.md specifies the files. Numbers are read exactly.
namespace cguide::testing {

/** A cone of wrenches, a demand and where it lies. */
struct GoldCone {
  std::string name;
  std::vector<VectorXq> generators;  ///< wrenches
  VectorXq demand;
  /** The same as forces at points, where the file gives them so and doubles hold every number. */
  std::optional<std::vector<AppliedForce>> forces;
  std::optional<AppliedForce> demand_force;
  exact::Membership expect = exact::Membership::kOutside;
  std::optional<int> rank;
  std::optional<int> facets;
};

/** Two convex hulls and their squared distance. */
struct GoldHulls {
  std::string name;
  std::vector<Vector3q> a, b;
  Rational squared;
};

/** A stance against the round cones. */
struct GoldStance {
  std::string name;
  exact::EquilibriumQuery query;
  Verdict expect = Verdict::kUndecided;
  std::optional<int> rank;
  std::optional<exact::StabilityReason> reason;
};

/** The largest multiple of a demand's direction; nothing to expect where there is none or no bound.
 */
struct GoldLimit {
  std::string name;
  exact::EquilibriumQuery query;
  exact::DemandFamily family;
  exact::ProgramStatus expect = exact::ProgramStatus::kOptimal;
  Rational value;
};

/** Two sets of triangles, corners as doubles, and their squared distance. */
struct GoldTriangles {
  struct Set {
    std::vector<Eigen::Vector3d> vertices;
    std::vector<std::array<int, 3>> triangles;
  };
  std::string name;
  Set a, b;
  Rational squared;
};

/** How two closed sets lie: without a common point, with one but no common inner point (of what
 has an inside), or in one another. */
enum class Meeting { kApart, kTouch, kOverlap };

/** A body of one shape and an object of one piece, both placed in W. */
struct GoldBodies {
  std::string name;
  ConvexShape shape;
  PieceShape piece;
  Pose body_X, object_X;
  Meeting expect = Meeting::kApart;
  std::optional<Rational> squared;  ///< distance
  std::optional<Rational> depth;    ///< least translation that parts them
};

/** @throws Error (kBadInput) with file:line where a line is not as specified. */
std::vector<GoldCone> ReadGoldCones(const std::string& file);
std::vector<GoldHulls> ReadGoldHulls(const std::string& file);
std::vector<GoldStance> ReadGoldStances(const std::string& file);
std::vector<GoldLimit> ReadGoldLimits(const std::string& file);
std::vector<GoldTriangles> ReadGoldTriangles(const std::string& file);
std::vector<GoldBodies> ReadGoldBodies(const std::string& file);

/** The doubles that equal the rationals; nothing where one is no double. */
std::optional<Eigen::VectorXd> AsDoubles(const VectorXq& v);

}  // namespace cguide::testing
