// Edges about contact and balance, above a floor whose face is at z = top in the local frame.
//
// Flat stances (see stability_ties.cc): with sites on one plane parallel to a flat floor, balance
// is interior iff the projection of the centre of mass along gravity is inside the hull of the
// sites and gravity is inside the friction cone. Where it is outside the hull, v is outside.
//
// Swings: a point at (x, z) of an arm that turns about the local y axis through (0, 0, h) is never
// higher than h + sqrt(x^2 + z^2), and that high at one instant.
#include <cmath>

#include "tests/fuzz/edge_parts.h"

namespace cguide::fuzz {
namespace {

using Eigen::Vector3d;
using test::Between;

constexpr double kTop = 0.8125;

struct Span {
  double from, to;
};

/** An interval of the given width about a value, met between s = 0.3 and 0.6 or so. */
Span About(TieRng& rng, double value, double width) {
  const double part = Between(rng, 0.3, 0.6);
  Span span{value - part * width, value + (1 - part) * width};
  if (Below(rng, 2) == 0) std::swap(span.from, span.to);
  return span;
}

/** Masses in the way that truth counts them. */
Rational MassOf(const Robot& robot) {
  Rational mass = 0;
  for (const Link& link : robot.links) mass += Lift(link.mass);
  return mass;
}

SlabKind SomeSlab(TieRng& rng) { return static_cast<SlabKind>(Below(rng, kSlabKinds)); }

Verdict ByInside(int side) { return side > 0 ? Verdict::kHolds : Verdict::kFails; }

/** The sole of link 1: a box about its frame with sites at its lower corners. */
void GiveSole(double toe, double heel, double half_width, Model* model) {
  model->robot.links[1].shapes = {
      {{{(toe - heel) / 2, 0, 0}, {}}, Box{{toe + heel, 2 * half_width, 0.0625}}}};
  for (const double x : {toe, -heel}) {
    for (const double y : {half_width, -half_width})
      model->sites.push_back({1, {x, y, -0.03125}, 0});
  }
  model->contact.bodies = {1};
}

}  // namespace

// The arm's centre of mass at (x, y) of its frame is share (x cos - y sin) ahead of the base's.
std::optional<EdgeCase> MakeBalance(TieRng& rng) {
  EdgeCase result;
  Model& model = result.model;
  Robot& robot = model.robot;
  robot.links = {PlainLink("base", -1, Between(rng, 5, 30)), PlainLink("foot", 0),
                 PlainLink("arm", 1, Between(rng, 5, 30))};
  const double foot_z = kTop + 0.03125 + LogBetween(rng, 1e-3, 0.03);
  robot.joints = {
      PlainJoint(JointType::kFixed, 0, 1, {0, 0, foot_z}, {0, 0, 1}),
      PlainJoint(JointType::kContinuous, 0, 2, {0, 0, foot_z + 0.5}, {0, 0, Between(rng, 0.2, 2)})};
  AssignBodiesAndColumns(&robot);
  const double toe = Between(rng, 0.05, 0.15), half_width = 0.25;
  GiveSole(toe, 0.25, half_width, &model);
  model.contact.bodies = {0};  // base and foot are one body
  const double mu = Between(rng, 0.3, 1);
  model.objects = {Slab(SomeSlab(rng), kTop, mu)};
  const bool tilted = Below(rng, 3) == 0;
  if (tilted) model.gravity = {Between(rng, -0.5, 0.5), Between(rng, -0.5, 0.5), -9.8125};

  // Along gravity the centre of mass is projected to the plane of the sites, ahead by `shift`.
  const Rational mass = MassOf(robot), share = Lift(robot.links[2].mass) / mass;
  const double com_z = Between(rng, -0.3, 0.3);
  const Rational foot = Lift(foot_z), height = share * (Lift(foot_z + 0.5) + Lift(com_z));
  const Rational fall = foot - Rational(1, 32) - height;
  const Rational shift = fall * Lift(model.gravity.x()) / Lift(model.gravity.z());
  const double room = toe - NearestDouble(shift);
  if (room < 0.02) return std::nullopt;
  const double margin = Signed(rng, LogBetween(rng, 1e-6, std::min(1e-2, room / 2)));
  const double reach = (room - margin) / NearestDouble(share), turn = Between(rng, -1, 1);
  const Vector3d com(reach * std::cos(turn), reach * std::sin(turn), com_z);
  robot.links[2].com_L = com;

  // (toe - shift)^2 against (share |com_xy|)^2. To the sides and the heel it keeps within 0.2 m.
  const Rational free = Lift(toe) - shift;
  const Vector3q c = Lift(com);
  const Rational peak = share * share * (c[0] * c[0] + c[1] * c[1]);
  const int side = free > 0 ? cmp(Rational(free * free), peak) : -1;
  if (side == 0) return std::nullopt;
  result.truth = ByInside(side);
  const Span span = About(rng, -turn, Between(rng, 0.2, 1.2));
  const Pose place = tilted ? Pose{} : RandomUprightPlace(rng);
  model.objects[0].pieces[0].X_WP = place;
  result.edge = JointEdge(place, {span.from}, {span.to});
  return result;
}

std::optional<EdgeCase> MakeSliding(TieRng& rng) {
  EdgeCase result;
  Model& model = result.model;
  Robot& robot = model.robot;
  robot.links = {PlainLink("base", -1, Between(rng, 5, 80)), PlainLink("foot", 0)};
  robot.links[0].com_L = {0, 0, Between(rng, 1, 2)};
  const double foot_z = kTop + 0.03125 + LogBetween(rng, 1e-3, 0.03);
  robot.joints = {
      PlainJoint(JointType::kPrismatic, 0, 1, {0, 0, foot_z}, {Between(rng, 0.2, 2), 0, 0})};
  AssignBodiesAndColumns(&robot);
  const double toe = Between(rng, 0.1, 0.2), heel = Between(rng, 0.1, 0.2);
  GiveSole(toe, heel, Between(rng, 0.03, 0.1), &model);
  model.objects = {Slab(SomeSlab(rng), kTop, Between(rng, 0.1, 1))};
  // The centre of mass stays at x = 0, the sole covers slide - heel < x < slide + toe.
  const double margin = Signed(rng, LogBetween(rng, 1e-9, 1e-2));
  Span span{};
  if (Below(rng, 2) == 0) {
    span.from = heel - margin;
    span.to = span.from - 0.15;
  } else {
    span.from = -toe + margin;
    span.to = span.from + 0.15;
  }
  if (Below(rng, 2) == 0) std::swap(span.from, span.to);
  const double least = std::min(span.from, span.to), most = std::max(span.from, span.to);
  if (least == -toe || most == heel) return std::nullopt;
  result.truth = least > -toe && most < heel ? Verdict::kHolds : Verdict::kFails;
  const Pose place = RandomUprightPlace(rng);
  model.objects[0].pieces[0].X_WP = place;
  result.edge = JointEdge(place, {span.from}, {span.to});
  return result;
}

namespace {

/** An angle to either side within which an arm of the given length stays within 25 mm of its
 peak. */
double Swing(TieRng& rng, double length) {
  const double most = std::acos(1 - std::min(1.0, 0.025 / length));
  return std::min(1.0, most) * Between(rng, 0.3, 1);
}

/** What the site rises from: a slab, or a ball or a capsule's end below the pivot, of which it is
 as far at the peak and nearer before and after (the pivot is above their centre). */
Object Ground(TieRng& rng) {
  switch (Below(rng, 8)) {
    case 0:
      return test::OneObject("ball", Sphere{kTop});
    case 1:
      return test::OneObject("post", Capsule{kTop - 0.25, 0.5});
    default:
      return Slab(SomeSlab(rng), kTop, 0.6);
  }
}

}  // namespace

std::optional<EdgeCase> MakeContact(TieRng& rng) {
  EdgeCase result;
  Model& model = result.model;
  model.require = GuideRequirement::kContact;
  const double length = Between(rng, 0.1, 0.4), turn = Between(rng, -1, 1);
  const Vector3d site(length * std::sin(turn), 0, length * std::cos(turn));
  const double radius = Below(rng, 2) == 0 ? 0 : 0.001953125;
  const double margin = Signed(rng, LogBetween(rng, 1e-9, 1e-3));
  const double h = kTop + model.contact.epsilon + radius - margin - length;
  // h + |site| - top < epsilon + radius.
  const Vector3q x = Lift(site);
  const int side = CompareSum({model.contact.epsilon, radius, kTop, -h}, x[0] * x[0] + x[2] * x[2]);
  if (side == 0) return std::nullopt;
  result.truth = ByInside(side);

  Robot& robot = model.robot;
  robot.links = {PlainLink("base", -1, 1), PlainLink("arm", 0, 1)};
  robot.links[1].shapes = {{{site, {}}, Sphere{0.001953125}}};
  robot.joints = {
      PlainJoint(JointType::kContinuous, 0, 1, {0, 0, h}, {0, Between(rng, 0.2, 2), 0})};
  AssignBodiesAndColumns(&robot);
  model.sites = {{1, site, radius}};
  model.contact.bodies = {1};
  model.objects = {Ground(rng)};
  const Span span = About(rng, -turn, Swing(rng, length));
  const Pose place = RandomPlace(rng);
  model.objects[0].pieces[0].X_WP = place;
  result.edge = JointEdge(place, {span.from}, {span.to});
  return result;
}

// The second joint undoes the first's turn (a mimic joint of -1, in real arithmetic), so the foot
// keeps level; its frame is on the arm's circle. It stays under the centre of mass: it moves by
// less than 0.15 m to either side and reaches 0.3 m.
std::optional<EdgeCase> MakeFoot(TieRng& rng) {
  EdgeCase result;
  Model& model = result.model;
  const double length = Between(rng, 0.1, 0.4), turn = Between(rng, -1, 1);
  const Vector3d leg(length * std::sin(turn), 0, length * std::cos(turn));
  const double margin = Signed(rng, LogBetween(rng, 1e-9, 1e-3));
  const double sole = 0.03125, h = kTop + model.contact.epsilon + sole - margin - length;
  const Vector3q x = Lift(leg);
  const int side = CompareSum({model.contact.epsilon, sole, kTop, -h}, x[0] * x[0] + x[2] * x[2]);
  if (side == 0) return std::nullopt;
  result.truth = ByInside(side);

  Robot& robot = model.robot;
  robot.links = {PlainLink("base", -1, Between(rng, 5, 80)), PlainLink("foot", 1),
                 PlainLink("leg", 0)};
  std::swap(robot.links[1], robot.links[2]);
  robot.links[0].com_L = {0, 0, Between(rng, 1, 2)};
  robot.joints = {PlainJoint(JointType::kContinuous, 0, 1, {0, 0, h}, {0, 1, 0}),
                  PlainJoint(JointType::kContinuous, 1, 2, leg, {0, 1, 0})};
  robot.joints[1].mimic = Mimic{0, -1, 0};
  AssignBodiesAndColumns(&robot);
  robot.links[2].shapes = {{{}, Box{{0.6, 0.2, 2 * sole}}}};
  for (const double a : {0.3, -0.3}) {
    for (const double b : {0.1, -0.1}) model.sites.push_back({2, {a, b, -sole}, 0});
  }
  model.contact.bodies = {2};
  model.objects = {Slab(SomeSlab(rng), kTop, Between(rng, 0.1, 1))};
  const Span span = About(rng, -turn, Swing(rng, length));
  const Pose place = RandomUprightPlace(rng);
  model.objects[0].pieces[0].X_WP = place;
  result.edge = JointEdge(place, {span.from}, {span.to});
  return result;
}

}  // namespace cguide::fuzz
