// Edges whose truth is not known from their making, and needles in the way of a humanoid.
#include <vector>

#include "cguide/numeric/io/problem_reader.h"
#include "cguide/verify/edge_audit.h"
#include "tests/fuzz/edge_parts.h"

namespace cguide::fuzz {
namespace {

using Eigen::Vector3d;
using test::Between;

const numeric::Problem& RoomProblem() {
  static const numeric::Problem problem =
      numeric::io::ReadProblem(CGUIDE_FIXTURES "/problems/chair_and_table.yaml");
  return problem;
}

/** Both ends within `step` of a configuration: root position by a fifth, the turn by a tenth. */
Edge EdgeAbout(TieRng& rng, const Configuration& q, double step) {
  const auto moved = [&] {
    Configuration result = q;
    result.X_WB.p += test::RandomPoint(rng, step / 5);
    result.X_WB.q.x += Between(rng, -step, step) / 10;
    result.X_WB.q.y += Between(rng, -step, step) / 10;
    result.X_WB.q.z += Between(rng, -step, step) / 10;
    for (double& x : result.joints) x += Between(rng, -step, step);
    return result;
  };
  const Configuration from = moved();
  return {from, moved()};
}

Edge RoomEdge(TieRng& rng, double lower, double upper) {
  const numeric::Problem& problem = RoomProblem();
  return EdgeAbout(rng, Below(rng, 2) == 0 ? problem.start : problem.goal,
                   LogBetween(rng, lower, upper));
}

/** Edges of the room that are proved, always the same ones. */
const std::vector<Edge>& ProvedRoomEdges() {
  static const std::vector<Edge> edges = [] {
    TieRng rng(2009);
    const numeric::World world(RoomProblem().model);
    verify::EdgeAuditor auditor(world);
    std::vector<Edge> found;
    for (int i = 0; i < 1000 && found.size() < 40; ++i) {
      const Edge edge = RoomEdge(rng, 0.01, 0.05);
      if (VerdictOf(auditor.Audit(0, edge)) == Verdict::kHolds) found.push_back(edge);
    }
    return found;
  }();
  return edges;
}

/** The boxes and hulls of a robot, as (link, shape). */
std::vector<std::pair<int, int>> Cornered(const Robot& robot) {
  std::vector<std::pair<int, int>> found;
  for (std::size_t l = 0; l < robot.links.size(); ++l) {
    const auto& shapes = robot.links[l].shapes;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      if (std::holds_alternative<Box>(shapes[i].geometry) ||
          std::holds_alternative<Hull>(shapes[i].geometry)) {
        found.emplace_back(static_cast<int>(l), static_cast<int>(i));
      }
    }
  }
  return found;
}

}  // namespace

std::optional<EdgeCase> MakeRoomNeedle(TieRng& rng) {
  const std::vector<Edge>& edges = ProvedRoomEdges();
  EdgeCase result{RoomProblem().model, edges.at(rng() % edges.size()), Verdict::kFails, true};
  const Robot& robot = result.model.robot;
  const auto shapes = Cornered(robot);
  const auto [link, shape] = shapes.at(rng() % shapes.size());
  const double s = Between(rng, 0.001, 0.999), depth = LogBetween(rng, 1e-6, 1e-3);
  const auto needle = NeedleAt(rng, robot, result.edge, s, link, shape, 1e-4, depth);
  if (!needle) return std::nullopt;
  result.model.objects.push_back(*needle);
  return result;
}

std::optional<EdgeCase> MakeRoom(TieRng& rng) {
  return EdgeCase{RoomProblem().model, RoomEdge(rng, 0.005, 0.1)};
}

namespace {

ConvexShape SomeShape(TieRng& rng) {
  switch (Below(rng, 5)) {
    case 0:
      return Box{{Between(rng, 0.02, 0.3), Between(rng, 0.02, 0.3), Between(rng, 0.02, 0.3)}};
    case 1:
      return Sphere{Between(rng, 0.02, 0.15)};
    case 2:
      return Cylinder{Between(rng, 0.02, 0.1), Between(rng, 0.05, 0.3)};
    case 3:
      return Capsule{Between(rng, 0.02, 0.1), Between(rng, 0.05, 0.3)};
    default:
      return test::RandomHull(rng, 8, 0.15);
  }
}

PieceShape SomePiece(TieRng& rng) {
  const Solid mesh = test::BoxMesh({-0.1, -0.1, -0.1}, {0.1, 0.2, 0.3});
  switch (Below(rng, 4)) {
    case 0:
      return mesh;
    case 1:
      return Surface{mesh.vertices, mesh.triangles};
    default:
      return std::visit([](const auto& shape) { return PieceShape(shape); }, SomeShape(rng));
  }
}

/** Takes away the obstacles and self pairs that meet at q. */
void ClearAt(const Configuration& q, Model* model) {
  const numeric::World world(*model);
  numeric::Workspace workspace(world);
  numeric::Place(world, q, &workspace);
  std::vector<Object> objects;
  std::vector<bool> meets(model->objects.size());
  model->self_pairs.clear();
  for (const numeric::Pair& pair : numeric::AllPairs(world)) {
    const bool apart = numeric::PairClearance(world, pair, 1e-6, &workspace).lo > 0;
    if (pair.self && apart) model->self_pairs.emplace_back(pair.body, pair.other);
    if (!pair.self && !apart) meets[pair.other] = true;
  }
  for (std::size_t i = 0; i < meets.size(); ++i) {
    if (!meets[i]) objects.push_back(model->objects[i]);
  }
  model->objects = std::move(objects);
}

}  // namespace

// The root's site is within the band of the floor where the edge begins or nearly so.
std::optional<EdgeCase> MakeRobots(TieRng& rng) {
  EdgeCase result;
  Model& model = result.model;
  model.robot = test::RandomRobot(rng, 2 + Below(rng, 5));
  for (Link& link : model.robot.links) link.shapes[0].geometry = SomeShape(rng);
  for (int i = 1 + Below(rng, 4); i > 0; --i) {
    const Pose pose{test::RandomPoint(rng, 1.5), test::RandomQuaternion(rng)};
    model.objects.push_back(test::OneObject("o" + std::to_string(i), SomePiece(rng), pose));
  }
  const int n = static_cast<int>(model.robot.bodies.size());
  const auto neighbours = NeighbourBodies(model.robot);
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      const std::pair pair(i, j);
      if (std::find(neighbours.begin(), neighbours.end(), pair) == neighbours.end()) {
        model.self_pairs.push_back(pair);
      }
    }
  }
  const Configuration q = test::RandomConfiguration(rng, model.robot);
  result.edge = EdgeAbout(rng, q, LogBetween(rng, 0.01, 0.3));
  model.require = GuideRequirement::kContact;
  model.contact.bodies = {0};
  model.sites = {{0, {0, 0, 0}, 0}};
  Vector3d n_W = test::RandomPoint(rng, 1);
  model.objects.push_back(test::OneObject(
      "wall", Halfspace{n_W, n_W.dot(q.X_WB.p) - n_W.norm() * Between(rng, 0.01, 0.045)}));
  // The wall reaches into the root's shape otherwise; only its site is near it.
  model.robot.links[0].shapes[0].geometry = Sphere{0.005};
  model.robot.links[0].shapes[0].X_LS = {};
  for (std::size_t l = 1; l < model.robot.links.size(); ++l) {
    LinkShape& shape = model.robot.links[l].shapes[0];
    if (model.robot.links[l].body == 0) shape = model.robot.links[0].shapes[0];
  }
  ClearAt(q, &model);
  if (model.objects.empty() || model.objects.back().name != "wall") return std::nullopt;
  return result;
}

// A block with sites at its corners, a few millimetres above a floor, a step or a ball, and about
// as many in which it tilts.
std::optional<EdgeCase> MakeBlocks(TieRng& rng) {
  EdgeCase result;
  Model& model = result.model;
  const Vector3d size(Between(rng, 0.1, 0.5), Between(rng, 0.1, 0.5), Between(rng, 0.05, 0.5));
  model = test::OneBodyModel({{{}, Box{size}}}, {});
  model.robot.links[0].com_L = test::RandomPoint(rng, 0.1);
  for (const Vector3d& corner : test::BoxMesh(-size / 2, size / 2).vertices) {
    model.sites.push_back({0, corner, 0});
  }
  const double mu = Between(rng, 0.2, 1), gap = Between(rng, 0.002, 0.03);
  double z = 0;
  switch (Below(rng, 4)) {
    case 0: {  // two boxes side by side, or a low step
      const double step = Below(rng, 2) == 0 ? 0 : Between(rng, -0.02, 0.02);
      const double x = Between(rng, -0.2, 0.2);
      model.objects = {test::BoxObject("left", {-2, -2, -1}, {x, 2, 0}, mu),
                       test::BoxObject("right", {x, -2, -1}, {2, 2, step}, mu)};
      z = std::max(0.0, step);
      break;
    }
    case 1: {  // four posts
      for (const double x : {-1, 1}) {
        for (const double y : {-1, 1}) {
          const Vector3d at(x * size.x() / 2, y * size.y() / 2, -0.5);
          const double radius = Between(rng, 0.02, 0.05);
          const PieceShape post = Below(rng, 2) == 0 ? PieceShape(Cylinder{radius, 1.0})
                                                     : PieceShape(Capsule{radius, 1 - 2 * radius});
          model.objects.push_back(test::OneObject("post", post, {at, {}}, mu));
        }
      }
      break;
    }
    default:
      z = 0.8125;
      model.objects = {Slab(static_cast<SlabKind>(Below(rng, kSlabKinds)), z, mu)};
  }
  const double tilt = LogBetween(rng, 1e-3, 0.1);
  const auto pose = [&] {
    const Vector3d p(Between(rng, -0.05, 0.05), Between(rng, -0.05, 0.05),
                     z + size.z() / 2 + gap + Between(rng, 0, 0.01));
    return Pose{p,
                {Between(rng, -tilt, tilt), Between(rng, -tilt, tilt), Between(rng, -0.2, 0.2), 1}};
  };
  const Pose from = pose();
  result.edge = {test::At(from), test::At(pose())};
  return result;
}

std::span<const EdgeKind> EdgeKinds() {
  static constexpr EdgeKind kKinds[] = {{"needle", &MakeNeedle, false},
                                        {"clip", &MakeClip, false},
                                        {"graze", &MakeGraze, true},
                                        {"miss", &MakeMiss, true},
                                        {"balance", &MakeBalance, true},
                                        {"sliding", &MakeSliding, true},
                                        {"contact", &MakeContact, true},
                                        {"foot", &MakeFoot, true},
                                        {"tiles", &MakeTiles, true},
                                        {"ridges", &MakeRidges, true},
                                        {"room_needle", &MakeRoomNeedle, false},
                                        {"robots", &MakeRobots, true},
                                        {"blocks", &MakeBlocks, true},
                                        {"room", &MakeRoom, true}};
  return kKinds;
}

}  // namespace cguide::fuzz
