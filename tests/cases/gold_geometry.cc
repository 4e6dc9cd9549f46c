#include "tests/cases/gold.h"
#include "tests/cases/gold_lines.h"

namespace cguide::testing {
namespace {

using Eigen::Vector3d;

// The geometry of models is stored as doubles: other numbers are no case.
Eigen::VectorXd Doubles(Line& line, int count) {
  const auto doubles = AsDoubles(line.Numbers(count));
  if (!doubles) line.Refuse("every number must be a double");
  return *doubles;
}

Vector3d Point(Line& line) { return Doubles(line, 3); }

void AddTriangle(Line& line, GoldTriangles::Set* set) {
  const int n = static_cast<int>(set->vertices.size());
  for (int k = 0; k < 3; ++k) set->vertices.push_back(Point(line));
  set->triangles.push_back({n, n + 1, n + 2});
}

/** Boxes, balls and hulls, which are bodies and objects; nothing for other words. */
std::optional<ConvexShape> ReadConvex(Line& line, const std::string& kind) {
  if (kind == "box") return Box{Point(line)};
  if (kind == "sphere") return Sphere{Doubles(line, 1)[0]};
  if (kind == "hull") return Hull{};
  if (kind != "cylinder" && kind != "capsule") return std::nullopt;
  const Eigen::VectorXd size = Doubles(line, 2);
  if (kind == "cylinder") return Cylinder{size[0], size[1]};
  return Capsule{size[0], size[1]};
}

PieceShape ReadPiece(Line& line) {
  const std::string kind = line.Word();
  if (kind == "surface") return Surface{};
  if (kind == "solid") return Solid{};
  if (kind == "halfspace") {
    const Eigen::VectorXd numbers = Doubles(line, 4);
    return Halfspace{numbers.head<3>(), numbers[3]};
  }
  const auto convex = ReadConvex(line, kind);
  if (!convex) line.Refuse("unknown shape \"" + kind + "\"");
  return std::visit([](const auto& shape) -> PieceShape { return shape; }, *convex);
}

std::vector<Vector3d>* Vertices(PieceShape* piece) {
  if (Hull* hull = std::get_if<Hull>(piece)) return &hull->vertices;
  if (Surface* surface = std::get_if<Surface>(piece)) return &surface->vertices;
  if (Solid* solid = std::get_if<Solid>(piece)) return &solid->vertices;
  return nullptr;
}

std::vector<std::array<int, 3>>* Triangles(PieceShape* piece) {
  if (Surface* surface = std::get_if<Surface>(piece)) return &surface->triangles;
  if (Solid* solid = std::get_if<Solid>(piece)) return &solid->triangles;
  return nullptr;
}

void ReadObjectLine(Line& line, GoldBodies* bodies) {
  if (line.key() == "object") {
    bodies->piece = ReadPiece(line);
  } else if (line.key() == "object-vertex") {
    if (!Vertices(&bodies->piece)) line.Refuse("the object has no vertices");
    Vertices(&bodies->piece)->push_back(Point(line));
  } else {
    if (!Triangles(&bodies->piece)) line.Refuse("the object has no triangles");
    const int i = line.Integer(), j = line.Integer();
    Triangles(&bodies->piece)->push_back({i, j, line.Integer()});
  }
}

void ReadBodyLine(Line& line, GoldBodies* bodies) {
  if (line.key() == "body") {
    const std::string kind = line.Word();
    const auto shape = ReadConvex(line, kind);
    if (!shape) line.Refuse("a body is a box, sphere, cylinder, capsule or hull");
    bodies->shape = *shape;
    return;
  }
  Hull* hull = std::get_if<Hull>(&bodies->shape);
  if (!hull) line.Refuse("the body is no hull");
  hull->vertices.push_back(Point(line));
}

void ReadPose(Line& line, Pose* X) {
  if (line.key().ends_with("-at")) {
    X->p = Point(line);
  } else {
    const Eigen::VectorXd q = Doubles(line, 4);
    X->q = {q[0], q[1], q[2], q[3]};
  }
}

void ReadBodiesLine(Line& line, GoldBodies* bodies) {
  const std::string& key = line.key();
  if (key == "body" || key == "body-vertex") {
    ReadBodyLine(line, bodies);
  } else if (key == "object" || key == "object-vertex" || key == "object-triangle") {
    ReadObjectLine(line, bodies);
  } else if (key == "body-at" || key == "body-turn") {
    ReadPose(line, &bodies->body_X);
  } else if (key == "object-at" || key == "object-turn") {
    ReadPose(line, &bodies->object_X);
  } else if (key == "expect") {
    bodies->expect = Choose<Meeting>(
        line,
        {{"apart", Meeting::kApart}, {"touch", Meeting::kTouch}, {"overlap", Meeting::kOverlap}});
  } else if (key == "squared") {
    bodies->squared = line.Number();
  } else if (key == "depth") {
    bodies->depth = line.Number();
  } else {
    line.Refuse("unknown key \"" + key + "\"");
  }
}

}  // namespace

std::vector<GoldTriangles> ReadGoldTriangles(const std::string& file) {
  std::vector<GoldTriangles> all;
  GoldTriangles sets;
  Walk(
      file, "triangles",
      [&](const std::string& name) {
        sets = GoldTriangles{};
        sets.name = name;
        sets.squared = -1;
      },
      [&](Line& line) {
        if (line.key() == "a") {
          AddTriangle(line, &sets.a);
        } else if (line.key() == "b") {
          AddTriangle(line, &sets.b);
        } else if (line.key() == "squared") {
          sets.squared = line.Number();
        } else {
          line.Refuse("unknown key \"" + line.key() + "\"");
        }
      },
      [&](Line& line) {
        if (sets.a.triangles.empty() || sets.b.triangles.empty() || sets.squared < 0) {
          line.Refuse("the case needs triangles a and b and a squared distance");
        }
        all.push_back(sets);
      });
  return all;
}

std::vector<GoldBodies> ReadGoldBodies(const std::string& file) {
  std::vector<GoldBodies> all;
  GoldBodies bodies;
  bool expected = false;
  Walk(
      file, "bodies",
      [&](const std::string& name) {
        bodies = GoldBodies{};
        bodies.name = name;
        expected = false;
      },
      [&](Line& line) {
        expected |= line.key() == "expect";
        ReadBodiesLine(line, &bodies);
      },
      [&](Line& line) {
        if (!expected) line.Refuse("the case says nothing about what to expect");
        all.push_back(bodies);
      });
  return all;
}

}  // namespace cguide::testing
