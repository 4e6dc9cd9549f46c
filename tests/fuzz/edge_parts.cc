#include "tests/fuzz/edge_parts.h"

#include <Eigen/Geometry>
#include <cmath>

namespace cguide::fuzz {

using Eigen::Vector3d;

double LogBetween(TieRng& rng, double lower, double upper) {
  return std::exp(test::Between(rng, std::log(lower), std::log(upper)));
}

double Signed(TieRng& rng, double size) { return Below(rng, 2) == 0 ? size : -size; }

Pose RandomPlace(TieRng& rng) {
  if (Below(rng, 4) == 0) return {};
  return {test::RandomPoint(rng, 2), test::RandomQuaternion(rng)};
}

Pose RandomUprightPlace(TieRng& rng) {
  if (Below(rng, 4) == 0) return {};
  const double half = test::Between(rng, -3, 3);
  return {test::RandomPoint(rng, 1), {0, 0, std::sin(half), std::cos(half)}};
}

namespace {

Surface Tiles(double top, int n) {
  Surface surface;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j)
      surface.vertices.push_back({-2 + 4.0 * i / n, -2 + 4.0 * j / n, top});
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      surface.triangles.push_back({a, b, b + 1});
      surface.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return surface;
}

}  // namespace

Object Slab(SlabKind kind, double top, double friction) {
  const Solid solid = test::BoxMesh({-2, -2, 0}, {2, 2, top});
  switch (kind) {
    case SlabKind::kHalfspace:
      return test::OneObject("slab", Halfspace{{0, 0, 2}, 2 * top}, {}, friction);
    case SlabKind::kBox:
      return test::OneObject("slab", Box{{4, 4, 2 * top}}, {}, friction);
    case SlabKind::kHull:
      return test::OneObject("slab", Hull{solid.vertices, solid.triangles}, {}, friction);
    case SlabKind::kSolid:
      return test::OneObject("slab", solid, {}, friction);
    case SlabKind::kSurface:
      return test::OneObject("slab", Tiles(top, 1), {}, friction);
    default:
      return test::OneObject("slab", Tiles(top, 4), {}, friction);
  }
}

Object MakeNeedleObject(TieRng& rng, const Needle& needle) {
  const Vector3d x = needle.out.normalized();
  const Vector3d y = needle.along.cross(x).normalized();
  const Vector3d z = x.cross(y);
  const double w = needle.width;
  const auto at = [&](double a, double b, double c) -> Vector3d {
    return needle.begin + a * x + b * y + c * z;
  };
  const int kind = Below(rng, 4);
  if (kind == 0) {
    Eigen::Matrix3d R;
    R << x, y, z;
    const Eigen::Quaterniond q(R);
    return test::OneObject("needle", Box{{w, w, 1}},
                           {at(w / 2, 0, 0), {q.x(), q.y(), q.z(), q.w()}});
  }
  if (kind == 1) {
    return test::OneObject("needle",
                           Surface{{at(0, 0, -0.5), at(w, 0, -0.5), at(w, 0, 0.5), at(0, 0, 0.5)},
                                   {{0, 1, 2}, {0, 2, 3}}});
  }
  Solid solid = test::BoxMesh({0, -w / 2, -0.5}, {w, w / 2, 0.5});
  for (Vector3d& v : solid.vertices) v = at(v[0], v[1], v[2]);
  if (kind == 2) return test::OneObject("needle", solid);
  return test::OneObject("needle", Hull{solid.vertices, solid.triangles});
}

Link PlainLink(const char* name, int joint, double mass) {
  Link link;
  link.name = name;
  link.joint = joint;
  link.mass = mass;
  return link;
}

Joint PlainJoint(JointType type, int parent, int child, const Vector3d& offset,
                 const Vector3d& axis) {
  Joint joint;
  joint.name = "joint" + std::to_string(child);
  joint.type = type;
  joint.parent = parent;
  joint.child = child;
  joint.X_PJ.p = offset;
  joint.axis = axis;
  joint.lower = -10;
  joint.upper = 10;
  return joint;
}

Edge JointEdge(const Pose& root, const std::vector<double>& from, const std::vector<double>& to) {
  Edge edge{test::At(root), test::At(root)};
  edge.from.joints = Eigen::Map<const Eigen::VectorXd>(from.data(), static_cast<int>(from.size()));
  edge.to.joints = Eigen::Map<const Eigen::VectorXd>(to.data(), static_cast<int>(to.size()));
  return edge;
}

int CompareSum(const std::vector<double>& terms, const Rational& squared) {
  Rational sum = 0;
  for (const double term : terms) sum += Lift(term);
  if (sum < 0) return -1;
  return cmp(Rational(sum * sum), squared);
}

Verdict ShapeApart(const Robot& robot, const Edge& edge, const Rational& s, int link, int shape,
                   const Object& object) {
  const LinkShape& given = robot.links[link].shapes[shape];
  const exact::PreparedModel prepared =
      exact::PrepareModel(test::OneBodyModel({}, {object}), {.cylinder_sides = 16});
  const exact::RobotPlacement placement = exact::PlaceRobot(robot, edge, s, 128);
  const exact::ConvexBracket moved = exact::Moved(
      exact::Moved(exact::Bracket(given.geometry, 16), exact::ExactPlacement(given.X_LS)),
      placement.links[link]);
  const exact::ConvexBracket body[] = {moved};
  return exact::Separate(body, std::span<const exact::ExactPiece>(prepared.objects[0]), 0).verdict;
}

void Support(const Pose& root, Model* model) {
  model->require = GuideRequirement::kContact;
  model->objects.push_back(test::OneObject("support", Halfspace{{-1, 0, 0}, -8.02}, root));
  model->sites.push_back({0, {8, 0, 8}, 0});
  model->contact.bodies = {0};
}

}  // namespace cguide::fuzz
