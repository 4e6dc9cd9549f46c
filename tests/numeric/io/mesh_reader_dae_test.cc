#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <assimp/Importer.hpp>

#include "cguide/numeric/io/mesh_reader_guard_internal.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

namespace fs = std::filesystem;

// A file with one geometry "g" of the given faces over six points of which two are shared by a
// quadrilateral and a triangle, and the given nodes.
std::string Dae(const std::string& faces, const std::string& nodes) {
  return "<COLLADA><asset><unit meter=\"0.01\"/><up_axis>X_UP</up_axis></asset>"
         "<library_nodes><node id=\"shared\"><translate>0 0 1</translate>"
         "<instance_geometry url=\"#g\"/></node></library_nodes>"
         "<library_geometries><geometry id=\"g\"><mesh><source id=\"s\">"
         "<float_array id=\"a\" count=\"19\">9 0 0 0  1 0 0  1 1 0  0 1 0  2 0 0  0 0 "
         "0.1</float_array>"
         "<technique_common><accessor source=\"#a\" count=\"6\" stride=\"3\" offset=\"1\"/>"
         "</technique_common></source>"
         "<vertices id=\"v\"><input semantic=\"NORMAL\" source=\"#s\"/>"
         "<input semantic=\"POSITION\" source=\"#s\"/></vertices>" +
         faces +
         "</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"vs\">" +
         nodes +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene "
         "url=\"#vs\"/></scene>"
         "</COLLADA>";
}

const char kTriangle[] =
    "<triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>"
    "<p>0 1 5</p></triangles>";
const char kNode[] = "<node><instance_geometry url=\"#g\"/></node>";

std::vector<std::string> Lines(const std::string& text, char kind) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  std::string line;
  while (std::getline(in, line)) {
    if (line[0] == kind) lines.push_back(line);
  }
  return lines;
}

TEST_CASE("triangles, polylists and polygons are read, with the indices of other inputs skipped") {
  const std::string inputs =
      "<input semantic=\"NORMAL\" source=\"#s\" offset=\"0\"/>"
      "<input semantic=\"VERTEX\" source=\"#v\" offset=\"1\"/>";
  const std::string faces = "<triangles count=\"1\">" + inputs + "<p>9 0 9 1 9 5</p></triangles>" +
                            "<polylist count=\"2\">" + inputs +
                            "<vcount>4 3</vcount><p>9 0 9 1 9 2 9 3 9 1 9 4 9 2</p></polylist>" +
                            "<polygons count=\"2\">" + inputs +
                            "<p>9 0 9 1 9 2</p><p>9 3 9 2 9 1 9 0</p></polygons>" +
                            "<lines count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" "
                            "offset=\"0\"/><p>0 1</p></lines>";
  const std::string obj = ObjFromDae(Dae(faces, kNode), "a.dae");
  CHECK(Lines(obj, 'f') == std::vector<std::string>{"f 1 2 6", "f 7 8 9 10", "f 8 11 9",
                                                    "f 13 14 15", "f 16 15 14 13"});
  CHECK(Lines(obj, 'v')[5] == "v 0 0 0.100000001");
}

TEST_CASE("the first transform of a node is the outermost, and nodes nest") {
  const std::string obj =
      ObjFromDae(Dae(kTriangle,
                     "<node><translate>10 0 0</translate><rotate>0 0 1 90</rotate><node>"
                     "<scale>2 3 4</scale><matrix>1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1</matrix>"
                     "<instance_geometry url=\"#g\"/></node></node>"),
                 "a.dae");
  // (1 0 0): +5 along x, times 2, turned to y, +10 along x. The zeros of the turn are cos(90 deg).
  float x = 0, y = 0, z = 0;
  REQUIRE(std::sscanf(Lines(obj, 'v')[1].c_str(), "v %f %f %f", &x, &y, &z) == 3);
  CHECK(x == Approx(10));
  CHECK(y == Approx(12));
  CHECK(z == 0);
}

TEST_CASE("a node may be used several times") {
  const std::string obj =
      ObjFromDae(Dae(kTriangle,
                     "<node><instance_node url=\"#shared\"/></node>"
                     "<node><translate>1 0 0</translate><instance_node url=\"#shared\"/></node>"),
                 "a.dae");
  const auto points = Lines(obj, 'v');
  REQUIRE(points.size() == 12);
  CHECK(points[0] == "v 0 0 1");
  CHECK(points[6] == "v 1 0 1");
  CHECK(Lines(obj, 'f') == std::vector<std::string>{"f 1 2 6", "f 7 8 12"});
}

TEST_CASE("faces are turned under a mirroring transform and only there") {
  CHECK(Lines(ObjFromDae(Dae(kTriangle,
                             "<node><scale>-1 1 1</scale><instance_geometry "
                             "url=\"#g\"/></node>"),
                         "a.dae"),
              'f') == std::vector<std::string>{"f 6 2 1"});
  CHECK(Lines(ObjFromDae(Dae(kTriangle,
                             "<node><scale>-1 -1 1</scale><instance_geometry "
                             "url=\"#g\"/></node>"),
                         "a.dae"),
              'f') == std::vector<std::string>{"f 1 2 6"});
}

// Oriented first moments of a triangle set: the integrals of n and of n x^T over it. They do not
// depend on order, on the corner a triangle starts with or on the diagonal of a flat quadrilateral;
// a turned, lost or moved triangle changes them.
struct Moments {
  std::size_t triangles = 0;
  Eigen::Matrix<double, 3, 4> integral = Eigen::Matrix<double, 3, 4>::Zero();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(HUGE_VAL);
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-HUGE_VAL);

  void Add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    ++triangles;
    const Eigen::Vector3d n = (b - a).cross(c - a) / 2;
    integral.col(0) += n;
    integral.rightCols<3>() += n * ((a + b + c) / 3).transpose();
    low = low.cwiseMin(a).cwiseMin(b).cwiseMin(c);
    high = high.cwiseMax(a).cwiseMax(b).cwiseMax(c);
  }
};

Moments ReadWithAssimp(const fs::path& file) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene =
      importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_PreTransformVertices);
  REQUIRE(scene != nullptr);
  Moments moments;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    const auto Corner = [&mesh](const aiFace& face, int c) {
      const aiVector3D& v = mesh.mVertices[face.mIndices[c]];
      return Eigen::Vector3d(v.x, v.y, v.z);
    };
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices == 3) moments.Add(Corner(face, 0), Corner(face, 1), Corner(face, 2));
    }
  }
  return moments;
}

TEST_CASE("other people's COLLADA files come out as with assimp's own reader") {
  const auto shared = SharedData("robots");
  if (!shared) return;
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(*shared / "robots")) {
    if (entry.path().extension() != ".dae") continue;
    CAPTURE(entry.path().string());
    ++files;
    const Moments expected = ReadWithAssimp(entry.path());
    const TriangleMesh mesh = ReadMesh(entry.path(), Eigen::Vector3d::Ones());
    Moments moments;
    for (const auto& [a, b, c] : mesh.triangles) {
      moments.Add(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    }
    CHECK(moments.triangles == expected.triangles);
    // Coordinates below 1 m and areas below 3 m^2, known to about 1e-7.
    // One of HyQ's six-triangle frames stands under a mirroring matrix, where assimp leaves the
    // triangles facing inwards.
    const double agreement = entry.path().filename() == "trunk.dae" ? 6e-4 : 2e-6;
    CHECK((moments.integral - expected.integral).cwiseAbs().maxCoeff() < agreement);
    CHECK((moments.low - expected.low).cwiseAbs().maxCoeff() < 1e-6);
    CHECK((moments.high - expected.high).cwiseAbs().maxCoeff() < 1e-6);
    CHECK(moments.integral.rightCols<3>().trace() > 3e-6);  // three times a volume, outside out
  }
  CHECK(files == 38);
}

}  // namespace
}  // namespace cguide::numeric::io
