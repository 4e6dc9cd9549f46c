// Near ties of contacts: sites whose distance from an obstacle is within 2^-30 m of an end of the
// band r < d < r + eps, or exactly there, about faces, edges, corners and the seams of obstacles
// that are cut into pieces; sites equally far from two pieces; pieces that end at the seam's
// radius.
//
// The link and every piece have the same pose X, and all else is stated in the frame of X, in few
// bits. So whatever the rotation of X, which is rational, distances are exactly those of that
// frame, where obstacles are boxes along the axes: the truth is a matter of clamping coordinates.
#include <algorithm>
#include <optional>

#include "cguide/exact/rational_kinematics.h"
#include "tests/fuzz/near_ties.h"
#include "tests/fuzz/twins.h"
#include "tests/numeric/contact_agreement.h"
#include "tests/numeric/geometry_models.h"

namespace cguide::fuzz {
namespace {

using Eigen::Vector3d;

// 15/512 m: a multiple of 3 and of 5, so that corners and edges have sites at exactly this
// distance.
constexpr double kEpsilon = 15.0 / 512;
constexpr double kGrain = 1.0 / 256;  ///< of the seam's cases (m)
constexpr double kSeam = 5 * kGrain;  ///< wide, so that ties about it have few bits

struct AxisBox {
  Vector3d lower;
  Vector3d upper;
};

Vector3q Clamped(const AxisBox& box, Vector3q x) {
  for (int i = 0; i < 3; ++i)
    x[i] = std::clamp<Rational>(x[i], Lift(box.lower[i]), Lift(box.upper[i]));
  return x;
}

Rational SquaredDistance(const AxisBox& box, const Vector3q& x) {
  return exact::SquaredNorm(x - Clamped(box, x));
}

/** A scene, the sites about it, and how many contacts each has in truth. */
struct Scene {
  Model model;
  Pose X;
  std::vector<int> expected;
  std::vector<char> tied;

  void AddSite(const Vector3d& x, double radius, int contacts, bool tie) {
    model.sites.push_back({0, x, radius});
    expected.push_back(contacts);
    tied.push_back(tie);
  }
};

Pose RandomPose(TieRng& rng) {
  Pose X{AnyPoint(rng), {}};
  switch (Below(rng, 16)) {  // wide numbers in one scene of eight, which take most of the time
    default:
      break;
    case 0:
    case 1:
    case 2:
    case 3:
    case 6:
    case 7:
      X.q = {0.5, Below(rng, 2) == 0 ? 0.5 : -0.5, 0.5, 0.5};
      break;
    case 4:
      X.q = {0, 0.6, 0, 0.8};  // what is stored: the doubles next to these
      break;
    case 5:
      X.q = test::RandomQuaternion(rng);
  }
  return X;
}

// The box as a shape that has the pose X itself.
PieceShape ShapeOf(TieRng& rng, const AxisBox& box) {
  const Solid mesh = test::BoxMesh(box.lower, box.upper);
  const int kind = Below(rng, 24);  // few meshes: they take the exact twin ten times as long
  if (kind == 0) return Surface{mesh.vertices, mesh.triangles};
  if (kind == 1) return mesh;
  if (kind < 12 && box.lower == -box.upper) return Box{box.upper - box.lower};
  return Hull{mesh.vertices, {}};
}

void AddObject(TieRng& rng, const AxisBox& box, Scene* scene) {
  const double friction = 0.25 * (1 + Below(rng, 3));
  scene->model.objects.push_back(test::OneObject("piece", ShapeOf(rng, box), scene->X, friction));
}

Scene EmptyScene(TieRng& rng) {
  Scene scene;
  scene.X = RandomPose(rng);
  scene.model = test::OneBodyModel({}, {});
  scene.model.contact.epsilon = kEpsilon;
  scene.model.contact.seam = kSeam;
  return scene;
}

Vector3d Displacement(TieRng& rng) { return TinyStep(rng) * GridPoint(rng, 2, 4); }

// From a face, an edge or a corner of the box outwards: `out` has a component along each axis that
// leaves the box and an integer length.
struct Feature {
  Vector3d y;
  Vector3d out;
  double length;
};

Feature RandomFeature(TieRng& rng, const AxisBox& box, const std::optional<double>& cut) {
  static const Vector3d kOut[] = {{1, 0, 0}, {3, 4, 0}, {4, 3, 0}, {1, 2, 2}, {2, 1, 2}, {2, 2, 1}};
  static const double kLength[] = {1, 5, 5, 3, 3, 3};
  const int kind = Below(rng, 6), first = Below(rng, 3);
  Feature feature{Vector3d::Zero(), Vector3d::Zero(), kLength[kind]};
  for (int i = 0; i < 3; ++i) {
    const int axis = (first + i) % 3;
    const bool up = Below(rng, 2) == 0;
    feature.out[axis] = up ? kOut[kind][i] : -kOut[kind][i];
    const double part = Below(rng, 5) / 4.0;
    feature.y[axis] = box.lower[axis] + part * (box.upper[axis] - box.lower[axis]);
    if (kOut[kind][i] != 0) feature.y[axis] = up ? box.upper[axis] : box.lower[axis];
    if (axis == 0 && cut && kOut[kind][i] == 0 && Below(rng, 2) == 0) feature.y[0] = *cut;
  }
  return feature;
}

// Ends of the band about a box that is whole or two tiles side by side.
Scene BandScene(TieRng& rng) {
  Scene scene = EmptyScene(rng);
  AxisBox box;
  box.upper = (Vector3d::Ones() * 3 + GridPoint(rng, 2, 1)) / 16;
  box.lower = -box.upper;
  std::optional<double> cut;
  if (Below(rng, 2) == 0) {
    cut = box.lower[0] + (1 + Below(rng, 3)) / 4.0 * 2 * box.upper[0];
    AxisBox left = box, right = box;
    left.upper[0] = right.lower[0] = *cut;
    AddObject(rng, left, &scene);
    AddObject(rng, right, &scene);
  } else {
    AddObject(rng, box, &scene);
  }
  for (int k = 0; k < 24; ++k) {
    const Feature feature = RandomFeature(rng, box, cut);
    const double radius = Below(rng, 2) * kEpsilon / 2;
    const bool touching = radius > 0 && Below(rng, 3) == 0;
    const double distance = touching ? radius : radius + kEpsilon;
    const Vector3d x = feature.y + distance / feature.length * feature.out + Displacement(rng);
    const Rational squared = SquaredDistance(box, Lift(x)), r = Lift(radius);
    const Rational end = r + Lift(kEpsilon);
    scene.AddSite(x, radius, squared > r * r && squared < end * end,
                  squared == r * r || squared == end * end);
  }
  return scene;
}

// Sites over a floor, and beside a second piece whose edge is as far from them. The edge is within
// the seam of the point below the site: whichever of the two is nearer is the only contact, and
// both are where neither is.
Scene RivalScene(TieRng& rng) {
  Scene scene = EmptyScene(rng);
  const AxisBox floor{{-0.25, -0.25, -0.25}, {0, 0.25, 0}};
  const AxisBox step{{kGrain, -0.25, -0.25}, {0.25, 0.25, kGrain}};
  AddObject(rng, floor, &scene);
  AddObject(rng, step, &scene);
  for (int k = 0; k < 24; ++k) {
    const Vector3d x = Vector3d(-2 * kGrain, GridValue(rng, 3, 16), 5 * kGrain) + Displacement(rng);
    const Rational a = SquaredDistance(floor, Lift(x)), b = SquaredDistance(step, Lift(x));
    scene.AddSite(x, 0, a == b ? 2 : 1, a == b);
  }
  return scene;
}

// A second piece hovers over the floor. Its lower edge, which is nearer to the site than the point
// y below it, is at the seam's radius from y: within it, y is no contact. The piece's upper edge
// is one.
Scene SeamScene(TieRng& rng) {
  Scene scene = EmptyScene(rng);
  const AxisBox floor{{-0.25, -0.25, -0.25}, {0, 0.25, 0}};
  const AxisBox beam{{2 * kGrain, -0.25, 4 * kGrain}, {0.25, 0.25, 5 * kGrain}};
  AddObject(rng, floor, &scene);
  AddObject(rng, beam, &scene);
  for (int k = 0; k < 24; ++k) {
    const Vector3d x = Vector3d(-kGrain, GridValue(rng, 3, 16), 7 * kGrain) + Displacement(rng);
    const Rational apart = SquaredDistance(beam, Clamped(floor, Lift(x)));
    const Rational seam = Lift(kSeam);
    scene.AddSite(x, 0, apart > seam * seam ? 2 : 1, apart == seam * seam);
  }
  return scene;
}

using numeric::Contact;
using numeric::testing::Disagreement;

/** What both say of one site, against the truth and one another. */
std::string CheckSite(const Scene& scene, int site, const std::vector<Contact>& all_fast,
                      const std::vector<exact::FoundContact>& all_slow, Tally* tally) {
  std::vector<Contact> fast;
  std::vector<exact::FoundContact> slow;
  for (const Contact& c : all_fast) {
    if (c.site == site) fast.push_back(c);
  }
  for (const exact::FoundContact& c : all_slow) {
    if (c.site == site) slow.push_back(c);
  }
  const bool settled =
      std::all_of(fast.begin(), fast.end(), [](const Contact& c) { return c.certain; });
  const bool decided =
      std::all_of(slow.begin(), slow.end(), [](const auto& c) { return c.contact.certain; });
  tally->cases += settled || decided;
  tally->tied += (settled || decided) && scene.tied[site];
  ++(settled ? tally->fast : decided ? tally->exact : tally->open);
  tally->checked += settled || decided;  // the clamped coordinates are the independent solver
  if (decided && static_cast<int>(slow.size()) != scene.expected[site]) {
    return "the exact twin finds " + std::to_string(slow.size()) + " contacts of " +
           std::to_string(scene.expected[site]);
  }
  if (settled && static_cast<int>(fast.size()) != scene.expected[site]) {
    return "doubles find " + std::to_string(fast.size()) + " certain contacts of " +
           std::to_string(scene.expected[site]);
  }
  return Disagreement(fast, slow);
}

}  // namespace

std::string TiesOfContacts(TieRng& rng, long, Tally* tally) {
  const int kind = Below(rng, 8);
  const Scene scene = kind == 0 ? RivalScene(rng) : kind == 1 ? SeamScene(rng) : BandScene(rng);
  const numeric::World world(scene.model);
  numeric::Workspace workspace(world);
  Place(world, test::At(scene.X), &workspace);
  std::vector<Contact> fast;
  FindContacts(world, &workspace, &fast);
  const exact::ContactScene exact_scene(scene.model);
  const auto slow = exact::FindContacts(
      exact_scene, exact::PlaceRobot(scene.model.robot, exact::RationalConfiguration{scene.X, {}}));
  for (int site = 0; site < static_cast<int>(scene.model.sites.size()); ++site) {
    const std::string wrong = CheckSite(scene, site, fast, slow, tally);
    if (!wrong.empty()) {
      return wrong + " (kind " + std::to_string(kind) + ", site " + std::to_string(site) + ")";
    }
  }
  return "";
}

}  // namespace cguide::fuzz
