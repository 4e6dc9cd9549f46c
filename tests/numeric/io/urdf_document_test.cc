#include <algorithm>
#include <random>
#include <set>

#include "cguide/numeric/io/urdf_document_internal.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

// Links "0" ... with joints in the order of `children`; -1 as parent leaves the link out.
UrdfDocument Document(const std::vector<int>& parents, const std::vector<int>& children) {
  UrdfDocument document;
  document.file = "f";
  document.links.resize(parents.size());
  for (std::size_t i = 0; i < parents.size(); ++i) document.links[i].name = std::to_string(i);
  for (int child : children) {
    UrdfJoint joint;
    joint.name = "to" + std::to_string(child);
    joint.parent = parents[child];
    joint.child = child;
    document.joints.push_back(joint);
  }
  return document;
}

TEST_CASE("links are ordered depth first, children in the order of their joints") {
  //     2          joints written: 2-4, 2-0, 4-1, 4-3
  //   4   0
  //  1 3
  UrdfDocument document = Document({2, 4, -1, 4, 2}, {4, 0, 1, 3});
  OrderLinks(&document);
  CHECK(document.link_order == std::vector<int>{2, 4, 1, 3, 0});
  CHECK(document.joint_order == std::vector<int>{0, 2, 3, 1});
}

TEST_CASE("random trees in random order come out parents first, each link once") {
  std::mt19937_64 rng(7);
  for (int round = 0; round < 300; ++round) {
    const int size = 1 + static_cast<int>(rng() % 40);
    std::vector<int> names(size), parents(size, -1), children;
    for (int i = 0; i < size; ++i) names[i] = i;
    std::shuffle(names.begin(), names.end(), rng);
    for (int i = 1; i < size; ++i) {
      parents[names[i]] = names[rng() % i];
      children.push_back(names[i]);
    }
    std::shuffle(children.begin(), children.end(), rng);
    UrdfDocument document = Document(parents, children);
    OrderLinks(&document);
    REQUIRE(document.link_order.size() == document.links.size());
    std::set<int> seen = {document.link_order[0]};
    REQUIRE(parents[document.link_order[0]] == -1);
    for (std::size_t i = 0; i < document.joint_order.size(); ++i) {
      const UrdfJoint& joint = document.joints[document.joint_order[i]];
      REQUIRE(joint.child == document.link_order[i + 1]);
      REQUIRE(seen.count(joint.parent) == 1);
      REQUIRE(seen.insert(joint.child).second);
    }
  }
}

TEST_CASE("a random graph that is no tree is refused") {
  std::mt19937_64 rng(8);
  int refused = 0;
  for (int round = 0; round < 500; ++round) {
    const int size = 2 + static_cast<int>(rng() % 8);
    UrdfDocument document = Document(std::vector<int>(size, -1), {});
    std::vector<int> above(size, -1);
    bool tree = true;
    for (int j = 0; j + 1 < size; ++j) {
      UrdfJoint joint;
      joint.parent = static_cast<int>(rng() % size);
      joint.child = static_cast<int>(rng() % size);
      tree = tree && above[joint.child] < 0;
      above[joint.child] = joint.parent;
      document.joints.push_back(joint);
    }
    // size - 1 edges to distinct children: a tree iff every link climbs to a link without parent.
    for (int i = 0; i < size && tree; ++i) {
      int at = i;
      for (int steps = 0; steps < size && above[at] >= 0; ++steps) at = above[at];
      tree = above[at] < 0;
    }
    CHECK(RefusalOf([&] { OrderLinks(&document); }).has_value() != tree);
    refused += tree ? 0 : 1;
  }
  CHECK(refused > 100);
  CHECK(refused < 499);
}

TEST_CASE("a chain of ten thousand links is read, a longer one refused") {
  const auto Chain = [](int size) {
    std::string text = "<robot name=\"chain\">";
    for (int i = 0; i < size; ++i) {
      text += "<link name=\"l" + std::to_string(i) + "\"/>";
      if (i == 0) continue;
      text += "<joint name=\"j" + std::to_string(i) + "\" type=\"fixed\"><parent link=\"l" +
              std::to_string(i - 1) + "\"/><child link=\"l" + std::to_string(i) + "\"/></joint>";
    }
    return text + "</robot>";
  };
  const TemporaryFolder folder;
  CHECK(ParseUrdf(XmlFile(folder.Write("a.urdf", Chain(10'000)))).link_order.size() == 10'000);
  CHECK_THROWS_AS(ParseUrdf(XmlFile(folder.Write("b.urdf", Chain(10'001)))), Error);
}

TEST_CASE("capsules are left out with a warning that names the link and the line") {
  const TemporaryFolder folder;
  const auto file =
      folder.Write("a.urdf",
                   "<robot name=\"r\">\n<link name=\"arm\">\n"
                   "<collision><geometry><sphere radius=\"1\"/></geometry></collision>\n"
                   "<collision><geometry>\n<capsule radius=\"1\" length=\"2\"/>\n"
                   "</geometry></collision>\n</link>\n</robot>\n");
  const UrdfDocument document = ParseUrdf(XmlFile(file));
  REQUIRE(document.links.size() == 1);
  CHECK(document.links[0].collisions.size() == 1);
  REQUIRE(document.warnings.size() == 1);
  CHECK(document.warnings[0].find(file.string() + ":5: ") == 0);
  CHECK(document.warnings[0].find("\"arm\"") != std::string::npos);
}

TEST_CASE("visuals, transmissions and extensions are not looked at") {
  const TemporaryFolder folder;
  const auto file = folder.Write(
      "a.urdf",
      "<robot name=\"r\"><material name=\"m\"><color "
      "rgba=\"x\"/></material><gazebo><link/></gazebo>"
      "<transmission name=\"t\"><joint name=\"j\"/></transmission>"
      "<link name=\"a\"><visual><geometry><teapot/></geometry><material name=\"undefined\"/>"
      "</visual></link></robot>");
  const UrdfDocument document = ParseUrdf(XmlFile(file));
  CHECK(document.links.size() == 1);
  CHECK(document.joints.empty());
  CHECK(document.warnings.empty());
}

}  // namespace
}  // namespace cguide::numeric::io
