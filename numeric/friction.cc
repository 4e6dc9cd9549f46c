#include "cguide/numeric/friction.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "cguide/exact/core/error.h"

namespace cguide::numeric {
namespace {

Eigen::Vector3d FirstTangent(const Eigen::Vector3d& n) {
  Eigen::Index axis = 0;
  n.cwiseAbs().minCoeff(&axis);
  return (Eigen::Vector3d::Unit(axis) - n[axis] * n).normalized();
}

}  // namespace

void AppendPyramid(const Contact& contact, int sides, Pyramid kind,
                   std::vector<Eigen::Vector3d>* edges) {
  Require(sides >= 3, "a pyramid needs at least three sides");
  const Eigen::Vector3d& n = contact.n_W;
  if (contact.friction == 0) {
    edges->push_back(n);
    return;
  }
  const double side = 2 * std::numbers::pi / sides;
  const bool inscribed = kind == Pyramid::kInscribed;
  const double radius = inscribed ? contact.friction : contact.friction / std::cos(side / 2);
  const Eigen::Vector3d t1 = FirstTangent(n), t2 = n.cross(t1);
  for (int j = 0; j < sides; ++j) {
    const double angle = side * (inscribed ? j : j + 0.5);
    edges->push_back(n + radius * (std::cos(angle) * t1 + std::sin(angle) * t2));
  }
}

std::vector<Vector6d> WrenchGenerators(const StabilityQuery& query, Pyramid kind) {
  std::vector<Vector6d> wrenches;
  std::vector<Eigen::Vector3d> edges;
  for (const Contact& contact : query.contacts) {
    edges.clear();
    AppendPyramid(contact, query.generators, kind, &edges);
    const Eigen::Vector3d r = contact.force_point_W() - query.com_W;
    for (const Eigen::Vector3d& u : edges) {
      Vector6d& a = wrenches.emplace_back();
      a << u, r.cross(u);
    }
  }
  return wrenches;
}

Vector6d RequiredWrench(const StabilityQuery& query) {
  Vector6d v = Vector6d::Zero();
  v.head<3>() = -query.mass * query.gravity_W;
  return v;
}

}  // namespace cguide::numeric
