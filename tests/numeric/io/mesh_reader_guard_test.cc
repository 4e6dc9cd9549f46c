#include "cguide/numeric/io/mesh_reader_guard_internal.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

TEST_CASE("OFF is brought to its plain form") {
  const std::string text =
      "OFF # header\n\n# counts\n 3 1 0\n0 0 0 9\n1e0 0 0\n\n0 +1. 0\r\n3 0 1 2 255 0 0\n";
  CHECK(GuardMesh(text, MeshFormat::kOff, "a.off").bytes ==
        "OFF\n3 1 0\n0 0 0\n1e0 0 0\n0 +1. 0\n3 0 1 2\n");
  CHECK(GuardMesh("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2", MeshFormat::kOff, "a.off").bytes ==
        "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
}

TEST_CASE("OBJ is brought to vertices and faces with absolute indices") {
  const std::string text =
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0 1\nvn 0 0 1\nv 0 1 0\nusemtl red\nf 1/9/9 2//9 3/9\n"
      "f -1 -2 -3\nl 1 2\nv 0 0 1\nf -1 1 2 3 # late\n";
  CHECK(GuardMesh(text, MeshFormat::kObj, "a.obj").bytes ==
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\nv 0 0 1\nf 4 1 2 3\n");
}

TEST_CASE("the name of a text STL may contain its key words") {
  const std::string text =
      "solid facet vertex endfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
      "vertex 0 1 0\nendloop\nendfacet\nendsolid facet\n";
  CHECK(GuardMesh(text, MeshFormat::kStl, "a.stl").bytes == text);
}

}  // namespace
}  // namespace cguide::numeric::io
