#include <functional>
#include <thread>

#include "cguide/numeric/io/urdf_document_internal.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

TEST_CASE("two readings that differ in any number, name or shape are refused") {
  const XmlFile xml(Fixture("io/brickman.urdf"));
  const UrdfDocument sound = ParseUrdf(xml);
  const auto LinkNamed = [](UrdfDocument& d, const std::string& name) -> UrdfLink& {
    for (UrdfLink& link : d.links) {
      if (link.name == name) return link;
    }
    throw std::logic_error("no such link");
  };
  const auto JointNamed = [](UrdfDocument& d, const std::string& name) -> UrdfJoint& {
    for (UrdfJoint& joint : d.joints) {
      if (joint.name == name) return joint;
    }
    throw std::logic_error("no such joint");
  };
  const auto Next = [](double* x) { *x = std::nextafter(*x, 1e9); };
  const std::vector<std::function<void(UrdfDocument&)>> faults = {
      [&](auto& d) { Next(&LinkNamed(d, "trunk").mass); },
      [&](auto& d) { Next(&LinkNamed(d, "trunk").com_L.y()); },
      [&](auto& d) { LinkNamed(d, "trunk").collisions.pop_back(); },
      [&](auto& d) { Next(&LinkNamed(d, "trunk").collisions[0].X_LS.p.x()); },
      [&](auto& d) { LinkNamed(d, "trunk").collisions[1].X_LS.q.x += 1e-12; },
      [&](auto& d) { LinkNamed(d, "trunk").collisions[0].geometry = Sphere{1}; },
      [&](auto& d) { Next(&std::get<Box>(LinkNamed(d, "trunk").collisions[0].geometry).size.z()); },
      [&](auto& d) { LinkNamed(d, "trunk").name = "tronk"; },
      [&](auto& d) { Next(&JointNamed(d, "hip").lower); },
      [&](auto& d) { Next(&JointNamed(d, "hip").upper); },
      [&](auto& d) { Next(&JointNamed(d, "hip").axis.x()); },
      [&](auto& d) { Next(&JointNamed(d, "hip").X_PJ.p.z()); },
      [&](auto& d) { JointNamed(d, "hip").parent = JointNamed(d, "hip").child; },
      [&](auto& d) { JointNamed(d, "knee").mimic.reset(); },
      [&](auto& d) { Next(&JointNamed(d, "knee").mimic->multiplier); },
      [&](auto& d) { Next(&JointNamed(d, "knee").mimic->offset); },
      [&](auto& d) {
        JointNamed(d, "hip").mimic = UrdfMimic{"knee", 1, 0};
      }};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    CAPTURE(i);
    UrdfDocument document = sound;
    faults[i](document);
    const auto refusal = RefusalOf([&] { CompareWithUrdfdom(xml, &document); });
    REQUIRE(refusal);
    CHECK(refusal->message.find("reads differently") != std::string::npos);
  }
  UrdfDocument document = sound;
  CHECK_NOTHROW(CompareWithUrdfdom(xml, &document));
}

TEST_CASE("a file that urdfdom refuses gives a warning with its complaint") {
  const TemporaryFolder folder;
  const auto file =
      folder.Write("a.urdf",
                   "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/><joint name=\"j\" "
                   "type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/><limit lower=\"0\" "
                   "upper=\"1\"/></joint></robot>");
  const UrdfDocument document = ParseUrdf(XmlFile(file));
  REQUIRE(document.warnings.size() == 1);
  CHECK(document.warnings[0].find("urdfdom") != std::string::npos);
  CHECK(document.warnings[0].find("effort") != std::string::npos);
}

TEST_CASE("several threads may read at once") {
  const auto Read = [](std::size_t* links) {
    for (int i = 0; i < 50; ++i) {
      *links += ParseUrdf(XmlFile(Fixture("io/brickman.urdf"))).links.size();
    }
  };
  std::size_t a = 0, b = 0;
  std::thread first(Read, &a), second(Read, &b);
  first.join();
  second.join();
  CHECK(a == b);
  CHECK(a > 0);
}

}  // namespace
}  // namespace cguide::numeric::io
