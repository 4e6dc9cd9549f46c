#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <random>

#include "cguide/exact/core/error.h"
#include "cguide/verify/certificate_writer.h"
#include "cguide/verify/edge_audit.h"
#include "tests/verify/sliding_foot.h"

// Proofs for every model in a box: what holds and what must not, by closed form and by members.
namespace cguide::verify {
namespace {

using check::Robustness;
using Eigen::Vector3d;
using numeric::World;
using test::Between;
using test::Slide;
using test::SlidingFoot;
using Rng = std::mt19937_64;

bool IsProved(const Model& model, const Edge& edge, const Robustness& box) {
  const World world(model);
  return EdgeAuditor(world, box).Audit(0, edge).proof.has_value();
}

/** Proofs that were found for one box, asked about another. */
bool Accepts(const Model& model, const Edge& edge, const Robustness& proved,
             const Robustness& asked, int bits = 0) {
  const World world(model);
  const EdgeFinding finding = EdgeAuditor(world, proved).Audit(0, edge);
  REQUIRE(finding.proof);
  return check::Checker(model, {bits, asked}).CheckEdge(edge, *finding.proof).empty();
}

Object Floor(double friction = 0.6) {
  return test::OneObject("floor", Halfspace{{0, 0, 1}, 0}, {}, friction);
}

/** Stands still on a plane that rises by `slope` along y; balance needs friction of that. */
Model OnSlope(double slope) {
  Model model = SlidingFoot({test::OneObject("slope", Halfspace{{0, -slope, 1}, -0.05}, {}, 0.6)});
  model.contact.epsilon = 0.2;
  model.robot.links[0].com_L = {0, 0, -0.75};  // low, so that it does not topple
  return model;
}

/** A random member of the box, on its border. The base of the sliding foot carries all mass and
 does not turn, so that its centre of mass is displaced as it is. */
Model Member(Model model, const Robustness& box, Rng& rng) {
  const auto anywhere = [&](double radius) {
    const Vector3d v = test::RandomPoint(rng, 1);
    return Vector3d(radius * v.normalized());
  };
  for (Object& object : model.objects) {
    object.friction = std::max(0.0, object.friction - box.friction);
    const Vector3d t = anywhere(box.pose * (1 - 1e-9));
    for (Piece& piece : object.pieces) {
      if (auto* halfspace = std::get_if<Halfspace>(&piece.geometry)) {
        halfspace->offset += halfspace->normal.dot(t) / halfspace->normal.squaredNorm();
      } else {
        piece.X_WP.p += t;
      }
    }
  }
  Vector3d e = anywhere(box.com * (1 - 1e-9));
  if (Between(rng, 0, 1) < 0.5) e = box.com * (1 - 1e-9) * Vector3d(e[0], e[1], 0).normalized();
  if (box.com > 0) model.robot.links[0].com_L += e;
  return model;
}

/** What the foot stands on, and things beside it. */
std::vector<Object> RandomGround(Rng& rng) {
  const auto rails = [](const PieceShape& shape, double y, double z) {
    return std::vector<Object>{test::OneObject("left", shape, {{0, y, z}, {}}),
                               test::OneObject("right", shape, {{0, -y, z}, {}})};
  };
  std::vector<Object> ground;
  switch (static_cast<int>(Between(rng, 0, 7))) {
    case 0:
      ground = {Floor()};
      break;
    case 1:
      ground = {test::OneObject("box", Box{{2, 2, 0.1}}, {{0, 0, -0.05}, {}})};
      break;
    case 2:
      ground = {test::OneObject("sheet", test::Sheet())};
      break;
    case 3:
      ground = {test::OneObject("slab", Solid{test::SlabVertices(), test::kSlabFaces})};
      break;
    case 4:
      ground = {test::OneObject("slab", Hull{test::SlabVertices(), test::kSlabFaces})};
      break;
    case 5:
      ground = rails(Box{{2, 0.02, 0.02}}, Between(rng, 0.055, 0.065), -0.01);
      break;
    default:
      ground = rails(Box{{2, 0.03, 0.1}}, Between(rng, 0.04, 0.06), -0.05);
  }
  if (Between(rng, 0, 1) < 0.5) {
    ground.push_back(test::OneObject("post", Box{{0.02, 0.3, 0.5}},
                                     {{Between(rng, 0.17, 0.25), 0, 0.25 - 1e-3}, {}}));
  }
  if (Between(rng, 0, 1) < 0.3) {
    ground.push_back(test::OneObject("tile", Box{{0.4, 0.4, 0.05}},
                                     {{0, 0, -0.025 - Between(rng, -0.001, 0.004)}, {}}));
  }
  return ground;
}

bool IsRefuted(const Model& model, const Edge& edge) {
  const World world(model);
  EdgeWorkspace collision(world);
  StabilityEdgeWorkspace stability(world);
  return DecideEdgeCollision(world, edge, {}, &collision).verdict == Verdict::kFails ||
         DecideEdgeStability(world, edge, {}, &stability).verdict == Verdict::kFails;
}

}  // namespace

TEST_CASE("A centre of mass that may be elsewhere keeps as far from the rim of the foot") {
  // The foot reaches 0.1 m from its middle along x, 0.05 m along y.
  const Model model = SlidingFoot(0.6);
  CHECK(IsProved(model, Slide(0, 0.07), {0, 0, 0.02}));
  CHECK_FALSE(IsProved(model, Slide(0, 0.0801), {0, 0, 0.02}));
  CHECK(IsProved(model, Slide(0, 0.0801), {0, 0, 0.01}));
  CHECK_FALSE(IsProved(model, Slide(0, 0), {0, 0, 0.0501}));
  CHECK(IsProved(model, Slide(0, 0), {0, 0, 0.035}));
}

TEST_CASE("Objects that may be elsewhere stay in the band, under the foot and apart from it") {
  const Model model = SlidingFoot(0.6);  // 5 mm above, in a band of 40 mm
  CHECK(IsProved(model, Slide(0, 0.05), {0, 0.0049, 0}));
  CHECK_FALSE(IsProved(model, Slide(0, 0.05), {0, 0.0051, 0}));
  Edge high = Slide(0, 0.05);
  high.from.X_WB.p.z() = high.to.X_WB.p.z() = 0.82 + 0.038;
  CHECK(IsProved(model, high, {0, 0.0019, 0}));
  CHECK_FALSE(IsProved(model, high, {0, 0.0021, 0}));
  // A slab that ends 3 mm beyond the sole.
  const Model slab =
      SlidingFoot({test::OneObject("slab", Box{{2, 0.106, 0.1}}, {{0, 0, -0.05}, {}})});
  CHECK(IsProved(slab, Slide(0, 0.05), {0, 0.0029, 0}));
  CHECK(IsProved(slab, Slide(0, 0.05), {0, 0, 0}));
  // A post 4 mm before the foot, 20 mm above the floor so that contacts do not see it.
  for (const bool mesh : {false, true}) {
    Model post = model;
    const PieceShape shape = mesh
                                 ? PieceShape(test::BoxMesh({-0.01, -0.1, -0.28}, {0.01, 0.1, 0.3}))
                                 : PieceShape(Box{{0.02, 0.2, 0.56}});
    post.objects.push_back(test::OneObject("post", shape, {{0.1 + 0.05 + 0.014, 0, 0.3}, {}}));
    CHECK(IsProved(post, Slide(0, 0.05), {0, 0.0039, 0}));
    CHECK_FALSE(IsProved(post, Slide(0, 0.05), {0, 0.0041, 0}));
  }
}

TEST_CASE("Two objects side by side may be moved against each other") {
  // Flush tiles: one of them may rise above the other, and then it is the one to stand on.
  const Model tiles =
      SlidingFoot({test::OneObject("left", Box{{1, 2, 0.1}}, {{-0.5, 0, -0.05}, {}}),
                   test::OneObject("right", Box{{1, 2, 0.1}}, {{0.5, 0, -0.05}, {}})});
  CHECK(IsProved(tiles, Slide(-0.02, 0.02), {0, 0.001, 0}));
  CHECK(IsProved(tiles, Slide(-0.06, 0.07), {}));
  CHECK_FALSE(IsProved(tiles, Slide(-0.098, 0.098), {0, 0.001, 0}));
  // Nor does the certifier by itself hold what it is not: here sites cross the seam.
  const World world(SlidingFoot({test::BoxObject("left", {-1, -1, -0.1}, {0.05, 1, 0}),
                                 test::BoxObject("right", {0.05, -1, -0.1}, {1, 1, 0})}));
  CHECK(EdgeAuditor(world).Audit(0, Slide(-0.07, 0.05)).proof);
  for (const double pose : {1e-7, 1e-6, 1e-5, 1e-4}) {
    CAPTURE(pose);
    CHECK(EdgeAuditor(world, {0, pose, 0}).Audit(0, Slide(-0.07, 0.05)).refusal == "");
  }
}

TEST_CASE("A certificate names its box and is checked for it") {
  const Model model = SlidingFoot(0.6);
  const Edge edge = Slide(0, 0.03);
  const Robustness box{0.05, 0.002, 0.01};
  const World world(model);
  const EdgeFinding finding = EdgeAuditor(world, box).Audit(0, edge);
  REQUIRE(finding.proof);
  const Path path{{"slide"}, {edge.from, edge.to}};
  const std::string text = WriteCertificate(model, path, "test", {&*finding.proof}, box);
  const check::Certificate read = check::ParseCertificate(text);
  CHECK(read.robust == box);
  CHECK(WriteCertificate(read.model, read.path, read.tool, {&read.proofs[0]}, read.robust) == text);
  CHECK(check::CheckCertificate(read).IsProved());
  nlohmann::json json = nlohmann::json::parse(text);
  const auto is_proved = [](const nlohmann::json& certificate) {
    try {
      return check::CheckCertificate(check::ParseCertificate(certificate.dump())).IsProved();
    } catch (const Error&) {
      return false;
    }
  };
  for (const auto& [key, value] : {std::pair("friction", 0.6),
                                   {"pose", 0.01},
                                   {"com", 0.1},
                                   {"friction", -0.1},
                                   {"pose", -1e-9},
                                   {"com", -1.0}}) {
    CAPTURE(key, value);
    nlohmann::json altered = json;
    altered["robust"][key] = value;
    CHECK_FALSE(is_proved(altered));
    altered["robust"].erase(key);
    CHECK_FALSE(is_proved(altered));
  }
  json.erase("robust");  // forces for other centres of mass say nothing of this one
  CHECK_FALSE(is_proved(json));
}

TEST_CASE("Less friction than a slope asks for is not proved") {
  const Model model = OnSlope(0.5);
  CHECK(IsProved(model, Slide(0, 0), {0.09, 0, 0}));
  CHECK_FALSE(IsProved(model, Slide(0, 0), {0.11, 0, 0}));
  CHECK_FALSE(IsProved(model, Slide(0, 0), {0.7, 0, 0}));
}

TEST_CASE("The checker takes a proof for smaller boxes, not for greater ones") {
  for (const int bits : {0, 128}) {
    const Model flat = SlidingFoot(0.6);
    CHECK(Accepts(flat, Slide(0, 0.03), {0.05, 0.002, 0.01}, {0.05, 0.002, 0.01}, bits));
    CHECK(Accepts(flat, Slide(0, 0.03), {0.05, 0.002, 0.01}, {0.04, 0.001, 0.01}, bits));
    CHECK_FALSE(Accepts(flat, Slide(0, 0.03), {0.05, 0.002, 0.01}, {0.05, 0.006, 0.01}, bits));
    CHECK_FALSE(Accepts(flat, Slide(0, 0.03), {0.05, 0.002, 0.01}, {0.05, 0.002, 0.06}, bits));
    // A proof of the model alone has no forces for another centre of mass.
    CHECK_FALSE(Accepts(flat, Slide(0, 0.03), {}, {0, 0, 1e-9}, bits));
    CHECK_FALSE(Accepts(OnSlope(0.5), Slide(0, 0), {0.05, 0, 0}, {0.2, 0, 0}, bits));
  }
}

// Proofs are found for a smaller box, so that it is the checker that says how far they go.
TEST_CASE("No member of a box for which an edge is proved is refuted") {
  Rng rng(20261126);
  int proved = 0, stretched = 0, open = 0;
  for (int round = 0; round < 200; ++round) {
    const Model model = SlidingFoot(RandomGround(rng));
    Edge edge = Slide(Between(rng, -0.08, 0.08), Between(rng, -0.08, 0.08));
    for (Configuration* q : {&edge.from, &edge.to}) {
      q->X_WB.p += Vector3d(0, Between(rng, -0.004, 0.004), Between(rng, -0.004, 0.02));
    }
    const Robustness box{Between(rng, 0, 0.3), std::pow(10, Between(rng, -5, -2)),
                         std::pow(10, Between(rng, -4, -1.3))};
    const double share = round % 2 ? 1 : 0.4;
    const Robustness found{box.friction, share * box.pose, box.com};
    const World world(model);
    const auto proof = EdgeAuditor(world, found).Audit(0, edge).proof;
    if (!proof || !check::Checker(model, {0, box}).CheckEdge(edge, *proof).empty()) {
      ++open;
      continue;
    }
    ++proved;
    stretched += share < 1;
    for (int k = 0; k < 12; ++k) {
      CAPTURE(round, k, box.friction, box.pose, box.com);
      REQUIRE_FALSE(IsRefuted(Member(model, box, rng), edge));
    }
  }
  CHECK(proved > 40);
  CHECK(stretched > 10);
  CHECK(open > 20);
}

}  // namespace cguide::verify
