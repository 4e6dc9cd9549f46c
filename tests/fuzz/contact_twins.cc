#include <algorithm>

#include "cguide/exact/core/error.h"
#include "tests/fuzz/twins.h"
#include "tests/numeric/contact_agreement.h"
#include "tests/numeric/geometry_models.h"

namespace cguide::fuzz {
namespace {

using Eigen::Vector3d;
using numeric::Contact;
using numeric::testing::Disagreement;

double Size(ByteStream& in) { return (1 + in.Below(16)) / 16.0; }

std::vector<Vector3d> Points(ByteStream& in, int count) {
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(in.Point());
  return points;
}

PieceShape Shape(ByteStream& in) {
  switch (in.Below(8)) {
    case 0:
      return Sphere{Size(in)};
    case 1:
      return Capsule{Size(in) / 4, Size(in)};
    case 2:
      return Cylinder{Size(in), Size(in)};
    case 3:
      return Hull{Points(in, 4 + in.Below(5)), {}};
    case 4:
      return Halfspace{Vector3d::Unit(in.Below(3)), in.NearGrid()};
    case 5:
      return Surface{Points(in, 4), {{0, 1, 2}, {1, 2, 3}}};
    case 6: {
      const Vector3d upper(Size(in), Size(in), Size(in));
      return test::BoxMesh(-upper, upper);
    }
    default:
      return Box{{Size(in), Size(in), Size(in)}};
  }
}

Pose SomePose(ByteStream& in) {
  Pose X{in.Point() / 2, {}};
  const int kind = in.Below(4);
  if (kind == 1) X.q = {0, 0, 0.6, 0.8};
  if (kind == 2) X.q = {0.5, 0.5, -0.5, 0.5};
  if (kind == 3) {
    const Eigen::Vector4d q = Eigen::Vector4d(in.NearGrid(), in.NearGrid(), 0, 16).normalized();
    X.q = {q[0], q[1], q[2], q[3]};
  }
  return X;
}

Model SomeModel(ByteStream& in) {
  Model model = test::OneBodyModel({}, {});
  const int pieces = 1 + in.Below(4);
  for (int i = 0; i < pieces; ++i) {
    const double friction = 0.25 * (1 + in.Below(3));
    const PieceShape shape = Shape(in);
    model.objects.push_back(test::OneObject("piece", shape, SomePose(in), friction));
  }
  model.contact.epsilon = 0.125;
  model.contact.seam = in.Below(2) == 0 ? 0.001 : 0.03125;
  const int sites = 1 + in.Below(6);
  for (int i = 0; i < sites; ++i) model.sites.push_back({0, in.Point(), in.Below(3) / 16.0});
  return model;
}

}  // namespace

std::string CheckContacts(ByteStream& in, bool, Tally* tally) {
  const Model model = SomeModel(in);
  const Pose X = SomePose(in);
  ++tally->cases;
  std::vector<Contact> fast;
  std::vector<exact::FoundContact> slow;
  try {
    const numeric::World world(model);
    numeric::Workspace workspace(world);
    Place(world, test::At(X), &workspace);
    FindContacts(world, &workspace, &fast);
    slow = exact::FindContacts(exact::ContactScene(model),
                               exact::PlaceRobot(model.robot, test::At(X), 106), {170});
  } catch (const Error&) {  // no model
    ++tally->open;
    return "";
  }
  const bool settled =
      std::all_of(fast.begin(), fast.end(), [](const Contact& c) { return c.certain; });
  ++(settled ? tally->fast : tally->exact);
  return Disagreement(fast, slow);
}

}  // namespace cguide::fuzz
