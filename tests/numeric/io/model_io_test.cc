#include <functional>
#include <random>

#include "cguide/numeric/io/guide_io.h"
#include "tests/numeric/io/reader_tools.h"
#include "tests/random_robot.h"

namespace cguide::numeric::io {
namespace {

using test::Between;
using test::RandomPoint;
using test::RandomQuaternion;

// A double of any size that the model may hold, subnormals and negative zero among them.
double AnyDouble(std::mt19937_64& rng) {
  switch (rng() % 6) {
    case 0:
      return -0.0;
    case 1:
      return std::ldexp(Between(rng, -1, 1), -1060);
    case 2:
      return static_cast<double>(rng() % 100);
    default:
      return std::ldexp(Between(rng, -1, 1), static_cast<int>(rng() % 30) - 15);
  }
}

Eigen::Vector3d AnyVector(std::mt19937_64& rng) {
  return {AnyDouble(rng), AnyDouble(rng), AnyDouble(rng)};
}

double Positive(std::mt19937_64& rng) { return Between(rng, 1e-3, 2); }

template <typename Mesh>
Mesh RandomMesh(std::mt19937_64& rng) {
  Mesh mesh;
  const int vertices = 3 + static_cast<int>(rng() % 5);
  for (int i = 0; i < vertices; ++i) mesh.vertices.push_back(AnyVector(rng));
  std::vector<std::array<int, 3>> triangles(rng() % 4);
  for (auto& t : triangles) {
    for (int& i : t) i = static_cast<int>(rng() % static_cast<unsigned>(vertices));
  }
  if constexpr (std::is_same_v<Mesh, Hull>) {
    mesh.faces = triangles;
  } else {
    mesh.triangles = triangles;
  }
  return mesh;
}

PieceShape RandomPieceShape(std::mt19937_64& rng) {
  switch (rng() % 8) {
    case 0:
      return Box{{Positive(rng), Positive(rng), Positive(rng)}};
    case 1:
      return Sphere{Positive(rng)};
    case 2:
      return Cylinder{Positive(rng), Positive(rng)};
    case 3:
      return Capsule{Positive(rng), Positive(rng)};
    case 4:
      return RandomMesh<Hull>(rng);
    case 5:
      return Halfspace{AnyVector(rng) + Eigen::Vector3d(0, 0, 1e5), AnyDouble(rng)};
    case 6:
      return RandomMesh<Surface>(rng);
    default:
      return RandomMesh<Solid>(rng);
  }
}

ConvexShape RandomConvexShape(std::mt19937_64& rng) {
  switch (rng() % 5) {
    case 0:
      return Box{{Positive(rng), Positive(rng), Positive(rng)}};
    case 1:
      return Sphere{Positive(rng)};
    case 2:
      return Cylinder{Positive(rng), Positive(rng)};
    case 3:
      return Capsule{Positive(rng), Positive(rng)};
    default:
      return RandomMesh<Hull>(rng);
  }
}

Model RandomModel(std::mt19937_64& rng) {
  Model model;
  model.robot = test::RandomRobot(rng, 4 + static_cast<int>(rng() % 8));
  model.robot.name = rng() % 2 ? "b\xC3\xB6t \"7\"\\ \t" : "";
  for (Link& link : model.robot.links) {
    link.com_L = AnyVector(rng);
    link.shapes.resize(rng() % 3);
    for (LinkShape& shape : link.shapes) {
      shape = {{AnyVector(rng), RandomQuaternion(rng)}, RandomConvexShape(rng)};
    }
  }
  model.objects.resize(rng() % 4);
  for (Object& object : model.objects) {
    object.name = "object " + std::to_string(rng() % 100);
    object.friction = Positive(rng);
    object.pieces.resize(rng() % 3);
    for (Piece& piece : object.pieces) {
      piece = {{AnyVector(rng), RandomQuaternion(rng)}, RandomPieceShape(rng)};
    }
  }
  for (unsigned i = 0; i < rng() % 9; ++i) {
    const int link = static_cast<int>(rng() % model.robot.links.size());
    model.sites.push_back({link, AnyVector(rng), Positive(rng)});
  }
  const int last = static_cast<int>(model.robot.bodies.size()) - 1;
  model.contact.bodies = {0, last};
  if (!model.objects.empty()) model.contact.may_touch = {{last, 0}};
  if (last > 0) model.self_pairs = {{0, last}};
  model.contact.epsilon = Positive(rng);
  model.contact.skin = Between(rng, 0, 1);
  model.contact.generators = 3 + static_cast<int>(rng() % 60);
  model.contact.model = rng() % 2 ? ContactModel::kSites : ContactModel::kNearest;
  model.require = rng() % 2 ? GuideRequirement::kStability : GuideRequirement::kContact;
  model.self_collision = rng() % 2;
  model.gravity = RandomPoint(rng, 10);
  return model;
}

TEST_CASE("a model that is written and read is the same, and so is its text") {
  const TemporaryFolder folder;
  std::mt19937_64 rng(31);
  for (int i = 0; i < 200; ++i) {
    CAPTURE(i);
    const Model model = RandomModel(rng);
    const std::string text = WriteModel(model);
    const Model read = ReadModel(folder.Write("model.json", text));
    REQUIRE(read == model);
    // Equality takes -0 for 0; the text does not.
    REQUIRE(WriteModel(read) == text);
  }
}

TEST_CASE("any change of the model changes its text") {
  std::mt19937_64 rng(32);
  Model model = RandomModel(rng);
  while (model.objects.empty() || model.sites.empty() || model.objects[0].pieces.empty()) {
    model = RandomModel(rng);
  }
  const std::string text = WriteModel(model);
  const auto next = [](double x) { return std::nextafter(x, 1e9); };
  const std::vector<std::function<void(Model&)>> changes = {
      [&](Model& m) { m.gravity[0] = next(m.gravity[0]); },
      [&](Model& m) { m.contact.epsilon = next(m.contact.epsilon); },
      [&](Model& m) { m.contact.skin = next(m.contact.skin); },
      [&](Model& m) { m.contact.seam = next(m.contact.seam); },
      [&](Model& m) { m.contact.generators ^= 64; },
      [&](Model& m) {
        m.contact.model =
            m.contact.model == ContactModel::kSites ? ContactModel::kNearest : ContactModel::kSites;
      },
      [&](Model& m) { m.contact.bodies.pop_back(); },
      [&](Model& m) { m.contact.may_touch.clear(); },
      [&](Model& m) { m.self_pairs.clear(); },
      [&](Model& m) { m.self_collision = !m.self_collision; },
      [&](Model& m) {
        m.require = m.require == GuideRequirement::kContact ? GuideRequirement::kStability
                                                            : GuideRequirement::kContact;
      },
      [&](Model& m) { m.robot.name += "x"; },
      [&](Model& m) { m.robot.links[1].name += "x"; },
      [&](Model& m) { m.robot.links[1].mass = next(m.robot.links[1].mass); },
      [&](Model& m) { m.robot.links[1].com_L[2] = next(m.robot.links[1].com_L[2]); },
      [&](Model& m) { m.robot.joints[0].axis[1] = next(m.robot.joints[0].axis[1]); },
      [&](Model& m) { m.robot.joints[0].lower = next(m.robot.joints[0].lower); },
      [&](Model& m) { m.robot.joints[0].upper = next(m.robot.joints[0].upper); },
      [&](Model& m) { m.robot.joints[0].type = JointType::kPrismatic; },
      [&](Model& m) { m.robot.joints[1].X_PJ.q.w = next(m.robot.joints[1].X_PJ.q.w); },
      [&](Model& m) {
        m.robot.joints[1].mimic = Mimic{0, 1, 0};
      },
      [&](Model& m) { m.objects[0].friction = next(m.objects[0].friction); },
      [&](Model& m) { m.objects[0].name += "x"; },
      [&](Model& m) { m.objects[0].pieces[0].X_WP.p[0] = next(m.objects[0].pieces[0].X_WP.p[0]); },
      [&](Model& m) { m.objects[0].pieces[0].geometry = Sphere{123}; },
      [&](Model& m) { m.sites[0].x_L[0] = next(m.sites[0].x_L[0]); },
      [&](Model& m) { m.sites[0].radius = next(m.sites[0].radius); },
      [&](Model& m) { m.sites.pop_back(); }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    CAPTURE(i);
    Model changed = model;
    changes[i](changed);
    CHECK(WriteModel(changed) != text);
  }
}

TEST_CASE("what the text does not hold follows from the order of links and joints") {
  const TemporaryFolder folder;
  std::mt19937_64 rng(33);
  const Model model = RandomModel(rng);
  const Model read = ReadModel(folder.Write("model.json", WriteModel(model)));
  CHECK(read.robot.bodies == model.robot.bodies);
  CHECK(read.robot.num_columns == model.robot.num_columns);
  CHECK(ColumnNames(read.robot) == ColumnNames(model.robot));
}

TEST_CASE("numbers that no file can hold and names that are no text are not written") {
  std::mt19937_64 rng(34);
  Model model = RandomModel(rng);
  model.robot.links[0].mass = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(WriteModel(model), Error);
  model = RandomModel(rng);
  model.robot.name = "\xFF";
  CHECK_THROWS_AS(WriteModel(model), Error);
}

}  // namespace
}  // namespace cguide::numeric::io
