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

TEST_CASE("text STL becomes vertices and faces, and its name may contain its key words") {
  const std::string facet =
      "facet normal nan 0 1\nouter loop\n vertex 0 0 0\n\tvertex 1 0 0\r\nvertex 0 1 0\nendloop\n"
      "endfacet\n";
  const std::string text =
      "solid facet vertex endsolid\n" + facet + "endsolid facet\nsolid\n" + facet + "endsolid";
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  CHECK(GuardMesh(text, MeshFormat::kStl, "a.stl").bytes ==
        points + "f 1 2 3\n" + points + "f 4 5 6\n");
}

TEST_CASE("any line left out of a text STL makes it malformed") {
  const std::vector<std::string> lines = {"solid",        "facet normal 0 0 1", "outer loop",
                                          "vertex 0 0 0", "vertex 1 0 0",       "vertex 0 1 0",
                                          "endloop",      "endfacet",           "endsolid"};
  for (std::size_t missing = 0; missing <= lines.size(); ++missing) {
    std::string text = "solid\nendsolid\n";  // what follows is the second solid
    for (std::size_t i = 0; i < lines.size(); ++i) text += i == missing ? "" : lines[i] + "\n";
    CAPTURE(text);
    const auto refusal = RefusalOf([&] { GuardMesh(text, MeshFormat::kStl, "a.stl"); });
    CHECK(refusal.has_value() == (missing < lines.size()));
  }
}

}  // namespace
}  // namespace cguide::numeric::io
