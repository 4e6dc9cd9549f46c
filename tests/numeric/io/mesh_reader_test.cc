#include "cguide/numeric/io/mesh_reader.h"

#include <cstring>
#include <numeric>
#include <random>
#include <set>

#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

using Points = std::set<std::array<double, 3>>;

Points PointsOf(const std::vector<Eigen::Vector3d>& vertices) {
  Points points;
  for (const auto& v : vertices) points.insert({v.x(), v.y(), v.z()});
  return points;
}

// The triangles as sets of corners, turned so that the smallest comes first: equal iff the meshes
// have the same oriented triangles.
std::multiset<std::array<std::array<double, 3>, 3>> Oriented(const TriangleMesh& mesh) {
  std::multiset<std::array<std::array<double, 3>, 3>> result;
  for (const auto& t : mesh.triangles) {
    std::array<std::array<double, 3>, 3> corners;
    for (int c = 0; c < 3; ++c) {
      const auto& v = mesh.vertices[t[c]];
      corners[c] = {v.x(), v.y(), v.z()};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    result.insert(corners);
  }
  return result;
}

std::string BinaryStl(const TriangleMesh& mesh, const std::string& header) {
  std::string bytes = header;
  bytes.resize(80, '\0');
  const auto Append = [&bytes](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  Append(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) Append(0.0f);
    for (int i : t) {
      for (int k = 0; k < 3; ++k) Append(static_cast<float>(mesh.vertices[i][k]));
    }
    Append(std::uint16_t{0});
  }
  return bytes;
}

TriangleMesh Brick(const std::string& name) {
  return ReadMesh(Fixture("io/meshes/" + name), Eigen::Vector3d::Ones());
}

TEST_CASE("the same brick comes out of every format") {
  const TriangleMesh stl = Brick("brick.stl");
  CHECK(stl.vertices.size() == 8);
  CHECK(stl.triangles.size() == 12);
  CHECK(SixVolumes(stl.vertices, stl.triangles) == 36);
  for (const char* name : {"brick.off", "brick.obj", "brick.dae"}) {
    CAPTURE(name);
    const TriangleMesh mesh = Brick(name);
    CHECK(mesh.vertices.size() == 8);
    CHECK(mesh.triangles.size() == 12);
    CHECK(PointsOf(mesh.vertices) == PointsOf(stl.vertices));
    CHECK(SixVolumes(mesh.vertices, mesh.triangles) == 36);
  }
}

TEST_CASE("the header of a DAE neither turns nor scales") {
  CHECK(Oriented(Brick("brick_y_up_centimetres.dae")) == Oriented(Brick("brick.dae")));
}

TEST_CASE("node transforms are applied, and a mirroring one keeps the outside outside") {
  const TriangleMesh mesh = Brick("brick_mirrored_node.dae");
  Points expected;
  for (double x : {3, 4}) {
    for (double y : {5, 7}) {
      for (double z : {6, 9}) expected.insert({x, y, z});
    }
  }
  CHECK(PointsOf(mesh.vertices) == expected);
  CHECK(SixVolumes(mesh.vertices, mesh.triangles) == Approx(36));
}

TEST_CASE("scales of every sign keep the outside outside") {
  for (const char* name : {"brick.stl", "brick.off", "brick.obj", "brick.dae"}) {
    for (int signs = 0; signs < 8; ++signs) {
      CAPTURE(name, signs);
      const Eigen::Vector3d scale(signs & 1 ? -2 : 2, signs & 2 ? -0.5 : 0.5, signs & 4 ? -3 : 3);
      const TriangleMesh mesh = ReadMesh(Fixture(std::string("io/meshes/") + name), scale);
      CHECK(SixVolumes(mesh.vertices, mesh.triangles) == Approx(36 * 3));
      Points expected;
      for (const auto& v : Brick(name).vertices) {
        expected.insert(
            {v.x() * scale.x() + 0.0, v.y() * scale.y() + 0.0, v.z() * scale.z() + 0.0});
      }
      CHECK(PointsOf(mesh.vertices) == expected);
    }
  }
}

TEST_CASE("binary STL is read to the bit, also where it begins with solid") {
  std::mt19937_64 rng(20);
  std::uniform_real_distribution<float> u(-5, 5);
  const TemporaryFolder folder;
  for (const char* header : {"", "binary", "solid exported by a careless program"}) {
    TriangleMesh soup;
    for (int i = 0; i < 60; ++i) {
      soup.vertices.emplace_back(u(rng), u(rng), u(rng));
      if (i % 3 == 2) soup.triangles.push_back({i - 2, i - 1, i});
    }
    const auto file = folder.Write("soup.STL", BinaryStl(soup, header));
    CHECK(Oriented(ReadMesh(file, Eigen::Vector3d::Ones())) == Oriented(soup));
  }
}

TEST_CASE("coordinates are the file's floats, times the scale in doubles") {
  const TemporaryFolder folder;
  const TriangleMesh soup{{{0.1f, 0.2f, 0.3f}, {1e-30f, 7.7f, 1}, {3, 1e5f, 1}}, {{0, 1, 2}}};
  const TriangleMesh mesh =
      ReadMesh(folder.Write("a.stl", BinaryStl(soup, "")), {0.001, 1.0 / 3, -7});
  CHECK(mesh.vertices[mesh.triangles[0][2]] ==
        Eigen::Vector3d(double{0.1f} * 0.001, double{0.2f} * (1.0 / 3), double{0.3f} * -7));
}

TEST_CASE("equal vertices are merged, zeros of both signs too, neighbours are not") {
  const TemporaryFolder folder;
  const float next = std::nextafter(1.0f, 2.0f);
  const TriangleMesh soup{
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, -0.0, 0}, {0, 1, -0.0}, {next, 0, 0}},
      {{0, 1, 2}, {3, 4, 5}}};
  const TriangleMesh mesh =
      ReadMesh(folder.Write("a.stl", BinaryStl(soup, "")), Eigen::Vector3d::Ones());
  CHECK(mesh.vertices.size() == 4);
  CHECK(mesh.triangles.size() == 2);
}

TEST_CASE("a text STL of several solids is one mesh") {
  const TemporaryFolder folder;
  const std::string brick = ReadText(Fixture("io/meshes/brick.stl"));
  const auto file = folder.Write("two.stl", brick + brick);
  const TriangleMesh mesh = ReadMesh(file, Eigen::Vector3d::Ones());
  CHECK(mesh.triangles.size() == 24);
  CHECK(mesh.vertices.size() == 8);
}

TEST_CASE("a scale that is zero or not finite is refused") {
  for (double bad : {0.0, std::nan(""), HUGE_VAL}) {
    CHECK_THROWS_AS(ReadMesh(Fixture("io/meshes/brick.stl"), {1, bad, 1}), Error);
  }
  CHECK_THROWS_AS(ReadMesh(Fixture("io/meshes/brick.stl"), {1, 1e7, 1}), Error);
}

TEST_CASE("a missing mesh is an error of input and output") {
  const auto refusal = RefusalOf([] { ReadMesh("/nowhere/a.stl", Eigen::Vector3d::Ones()); });
  REQUIRE(refusal);
  CHECK(refusal->code == Error::Code::kIo);
}

TEST_CASE("every prefix of a mesh file is refused or read, never worse") {
  const TemporaryFolder folder;
  const TriangleMesh brick = Brick("brick.stl");
  const std::pair<std::string, std::string> files[] = {
      {"a.stl", ReadText(Fixture("io/meshes/brick.stl"))},
      {"b.stl", BinaryStl(brick, "solid")},
      {"a.off", ReadText(Fixture("io/meshes/brick.off"))},
      {"a.obj", ReadText(Fixture("io/meshes/brick.obj"))},
      {"a.dae", ReadText(Fixture("io/meshes/brick.dae"))}};
  for (const auto& [name, bytes] : files) {
    CAPTURE(name);
    int refused = 0;
    for (std::size_t size = 0; size < bytes.size(); size += 7) {
      const auto file = folder.Write(name, bytes.substr(0, size));
      if (RefusalOf([&] { ReadMesh(file, Eigen::Vector3d::Ones()); })) ++refused;
    }
    CHECK(refused > static_cast<int>(bytes.size() / 7) / 2);
  }
}

TEST_CASE("changed bytes in a mesh file never do worse than an error") {
  const TemporaryFolder folder;
  std::mt19937_64 rng(12);
  const std::pair<std::string, std::string> files[] = {
      {"a.stl", ReadText(Fixture("io/meshes/brick.stl"))},
      {"b.stl", BinaryStl(Brick("brick.stl"), "")},
      {"a.off", ReadText(Fixture("io/meshes/brick.off"))},
      {"a.obj", ReadText(Fixture("io/meshes/brick.obj"))},
      {"a.dae", ReadText(Fixture("io/meshes/brick.dae"))}};
  for (const auto& [name, bytes] : files) {
    for (int round = 0; round < 100; ++round) {
      std::string changed = bytes;
      for (int i = 0; i < 2; ++i) changed[rng() % changed.size()] = static_cast<char>(rng() % 256);
      const auto file = folder.Write(name, changed);
      try {
        const TriangleMesh mesh = ReadMesh(file, Eigen::Vector3d::Ones());
        for (const auto& v : mesh.vertices) REQUIRE(v.allFinite());
        REQUIRE_NOTHROW(MakePieces(mesh, MeshUse::kAuto, name));
      } catch (const Error& error) {
        REQUIRE(error.code() == Error::Code::kBadInput);
      }
    }
  }
}

}  // namespace
}  // namespace cguide::numeric::io
