#include "cguide/numeric/io/urdf_packages_internal.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

namespace fs = std::filesystem;

std::string Resolve(const std::string& uri, const fs::path& from, const PackageMap& packages = {}) {
  return fs::weakly_canonical(ResolveUri(uri, from, packages, "here:1")).string();
}

TEST_CASE("a package is found as a folder of its name above the file") {
  const TemporaryFolder folder;
  const std::string mesh = fs::canonical(folder.Write("ws/robot/meshes/a.stl", "x")).string();
  const fs::path urdf = folder.path() / "ws/robot/urdf/deep/robot.urdf";
  fs::create_directories(urdf.parent_path());
  CHECK(Resolve("package://robot/meshes/a.stl", urdf) == mesh);
  CHECK(Resolve("package:///robot/meshes/a.stl", urdf) == mesh);
  CHECK(Resolve("package://robot//meshes/a.stl", urdf) == mesh);
  CHECK(Resolve("model://robot/meshes/a.stl", urdf) == mesh);
  CHECK(Resolve("../../meshes/a.stl", urdf) == mesh);
  CHECK(Resolve(mesh, urdf) == mesh);
  CHECK(Resolve("file://" + mesh, urdf) == mesh);
}

TEST_CASE("a package is found by the name in its package.xml") {
  const TemporaryFolder folder;
  folder.Write("checkout-1.2/package.xml", "<package><name>robot</name></package>");
  const std::string mesh = fs::canonical(folder.Write("checkout-1.2/a.stl", "x")).string();
  const fs::path urdf = folder.path() / "checkout-1.2/urdf/robot.urdf";
  CHECK(Resolve("package://robot/a.stl", urdf) == mesh);
  CHECK_THROWS_AS(Resolve("package://other/a.stl", urdf), Error);
}

TEST_CASE("a broken package.xml on the way is passed over") {
  const TemporaryFolder folder;
  folder.Write("robot/urdf/package.xml", "<package><name>robot");
  const std::string mesh = fs::canonical(folder.Write("robot/a.stl", "x")).string();
  CHECK(Resolve("package://robot/a.stl", folder.path() / "robot/urdf/r.urdf") == mesh);
}

TEST_CASE("the nearest folder that has the file wins") {
  const TemporaryFolder folder;
  const std::string far = fs::canonical(folder.Write("robot/far.stl", "x")).string();
  const std::string near = fs::canonical(folder.Write("ws/robot/near.stl", "x")).string();
  const fs::path urdf = folder.path() / "ws/urdf/r.urdf";
  CHECK(Resolve("package://robot/near.stl", urdf) == near);
  CHECK(Resolve("package://robot/far.stl", urdf) == far);
}

TEST_CASE("a listed package is looked for where it is listed and nowhere else") {
  const TemporaryFolder folder;
  folder.Write("robot/a.stl", "x");
  const std::string mesh = fs::canonical(folder.Write("elsewhere/b.stl", "x")).string();
  const PackageMap packages = {{"robot", folder.path() / "elsewhere"}};
  CHECK(Resolve("package://robot/b.stl", folder.path() / "r.urdf", packages) == mesh);
  const auto refusal =
      RefusalOf([&] { Resolve("package://robot/a.stl", folder.path() / "r.urdf", packages); });
  REQUIRE(refusal);
  CHECK(refusal->message.find("elsewhere/a.stl") != std::string::npos);
}

TEST_CASE("a refusal lists the places that were tried") {
  const TemporaryFolder folder;
  const auto refusal =
      RefusalOf([&] { Resolve("package://robot/m/a.stl", folder.path() / "ws/urdf/r.urdf"); });
  REQUIRE(refusal);
  CHECK(refusal->code == Error::Code::kIo);
  CHECK(refusal->message.find("here:1: ") == 0);
  for (const char* tried : {"ws/urdf/robot/m/a.stl", "ws/robot/m/a.stl"}) {
    CHECK(refusal->message.find((folder.path() / tried).string()) != std::string::npos);
  }
  CHECK(refusal->message.find("say where package \"robot\" is") != std::string::npos);
}

}  // namespace
}  // namespace cguide::numeric::io
