// Edges over floors that are cut into pieces and over the ridges and tips of meshes.
//
// Cut floors: the slides of MakeSliding. Cracks of up to 1e-5 m under sites that are 1e-3 m or more
// above the floor tilt normals by less than 1e-2, and the force at a point site acts at its centre:
// vertical forces stay admissible, and nothing else can change whether gravity is carried.
//
// Roofs: the distance from a convex set is convex along a line, so a site that moves straight keeps
// within the band above a roof iff it does at both ends, which are compared over Q: at slopes of 3
// to 4 the distance from a side is (3 |x| + 4 z)/5, from the ridge sqrt(x^2 + z^2), from the tip
// sqrt(x^2 + y^2 + z^2), z up from there.
#include <cmath>

#include "tests/fuzz/edge_parts.h"

namespace cguide::fuzz {
namespace {

using Eigen::Vector3d;
using test::Between;

/** A tile over [x, X] x [y, Y] below z = top; a sheet is cut along a diagonal or about a point. */
PieceShape Tile(TieRng& rng, const Vector3d& lower, const Vector3d& upper, int kind) {
  const Solid solid = test::BoxMesh(lower, upper);
  if (kind == 1) return Hull{solid.vertices, solid.triangles};
  if (kind == 2) return solid;
  Surface sheet;
  const double top = upper.z();
  sheet.vertices = {{lower.x(), lower.y(), top},
                    {upper.x(), lower.y(), top},
                    {upper.x(), upper.y(), top},
                    {lower.x(), upper.y(), top}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  if (Below(rng, 2) == 0) return sheet;
  sheet.vertices.push_back(
      {Between(rng, lower.x(), upper.x()), Between(rng, lower.y(), upper.y()), top});
  sheet.triangles = {{0, 1, 4}, {1, 2, 4}, {3, 2, 4}, {3, 0, 4}};  // one the other way round
  return sheet;
}

/** Where the floor is cut: between -2 and 2, some cuts near the middle. */
std::vector<double> Cuts(TieRng& rng) {
  std::vector<double> cuts{-2};
  for (int i = Below(rng, 4); i > 0; --i) cuts.push_back(Between(rng, -0.25, 0.25));
  std::sort(cuts.begin(), cuts.end());
  cuts.push_back(2);
  return cuts;
}

std::vector<Object> CutFloor(TieRng& rng, double top, const Pose& place) {
  const std::vector<double> x = Cuts(rng), y = Cuts(rng);
  const double crack = Below(rng, 2) == 0 ? 0 : LogBetween(rng, 1e-9, 1e-5);
  const bool is_one = Below(rng, 2) == 0, is_mixed = Below(rng, 3) == 0;
  int kind = Below(rng, 4);
  std::vector<Object> objects;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    for (std::size_t j = 0; j + 1 < y.size(); ++j) {
      if (is_mixed) kind = Below(rng, 4);
      const Vector3d lower(x[i] + (i > 0 ? crack : 0), y[j] + (j > 0 ? crack : 0), 0);
      const Vector3d upper(x[i + 1], y[j + 1], top);
      Piece piece{place, {}};
      if (kind ==
          0) {  // its own pose: turned about z alone, so its top is level, and like the others'
        const Vector3d middle = (lower + upper) / 2;
        const double c = place.q.w, s = place.q.z, norm = c * c + s * s;
        const double cos = (c * c - s * s) / norm, sin = 2 * c * s / norm;
        piece.X_WP.p += Vector3d(cos * middle.x() - sin * middle.y(),
                                 sin * middle.x() + cos * middle.y(), middle.z());
        piece.geometry = Box{upper - lower};
      } else {
        piece.geometry = Tile(rng, lower, upper, kind);
      }
      if (!is_one || objects.empty()) {
        objects.push_back({"tile" + std::to_string(objects.size()), Between(rng, 0.1, 1), {}});
      }
      objects.back().pieces.push_back(piece);
    }
  }
  return objects;
}

}  // namespace

std::optional<EdgeCase> MakeTiles(TieRng& rng) {
  std::optional<EdgeCase> result = MakeSliding(rng);
  if (!result) return result;
  const Object& slab = result->model.objects[0];
  result->model.objects = CutFloor(rng, 0.8125, slab.pieces[0].X_WP);
  return result;
}

namespace {

constexpr double kRun = 1, kFall = 0.75;

/** Two slopes about a ridge along y, in n strips each; a solid has a floor and gables besides. */
Solid Roof(int n, double top) {
  Solid roof;
  for (int i = 0; i <= n; ++i) {
    const double y = -1 + 2.0 * i / n;
    roof.vertices.push_back({-kRun, y, top - kFall});
    roof.vertices.push_back({0, y, top});
    roof.vertices.push_back({kRun, y, top - kFall});
  }
  for (int i = 0; i < n; ++i) {
    const int a = 3 * i, b = a + 3;
    for (const std::array<int, 3>& t :
         {std::array{a, a + 1, b + 1}, std::array{a, b + 1, b}, std::array{a + 1, a + 2, b + 2},
          std::array{a + 1, b + 2, b + 1}}) {
      roof.triangles.push_back(t);
    }
  }
  return roof;
}

void CloseRoof(int n, Solid* roof) {
  for (int i = 0; i < n; ++i) {
    const int a = 3 * i, b = a + 3;
    roof->triangles.push_back({a, b, b + 2});
    roof->triangles.push_back({a, b + 2, a + 2});
  }
  const int last = 3 * n;
  roof->triangles.push_back({0, 2, 1});
  roof->triangles.push_back({last, last + 1, last + 2});
}

/** A tip above a square: (3 |x| + 4 z)/5 from each side. */
Solid Tip(double top) {
  Solid tip;
  const double base = top - kFall;
  tip.vertices = {{kRun, kRun, base},
                  {-kRun, kRun, base},
                  {-kRun, -kRun, base},
                  {kRun, -kRun, base},
                  {0, 0, top}};
  tip.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 2, 1}, {0, 3, 2}};
  return tip;
}

/** As one solid, one sheet, or a sheet for each triangle. */
std::vector<Object> AsObjects(TieRng& rng, const Solid& mesh, std::size_t slopes,
                              const Pose& place) {
  const int kind = Below(rng, 3);
  if (kind == 0) return {test::OneObject("roof", mesh, place)};
  std::vector<std::array<int, 3>> faces(mesh.triangles.begin(), mesh.triangles.begin() + slopes);
  if (kind == 1) return {test::OneObject("roof", Surface{mesh.vertices, faces}, place)};
  std::vector<Object> objects;
  for (const std::array<int, 3>& t : faces) {
    const Surface one{{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}, {{0, 1, 2}}};
    objects.push_back(test::OneObject("slope" + std::to_string(objects.size()), one, place));
  }
  return objects;
}

/** Whether p, from the ridge or tip, is nearer to the roof than `limit` (1), farther (-1) or at it
 (0): exact. On a tip the sides' normals lean along x or y. */
int CompareDistance(const Vector3d& p, bool is_tip, const Rational& limit) {
  const Rational x = abs(Lift(p.x())), y = abs(Lift(p.y())), z = Lift(p.z());
  const Rational u = is_tip && y > x ? y : x, v = u == x ? y : x;
  if (4 * u > 3 * z) {
    // Beside the ridge's wedge: a side, or on the tip an edge between two sides.
    const Rational side = (3 * u + 4 * z) / 5;
    const Rational foot = u - side * 3 / 5;  // from the axis, across
    if (!is_tip || v <= foot) return -cmp(side, limit);
    return 2;
  }
  if (is_tip) {
    // The tip's cone of normals is bounded by the four edges (+-1, +-1, -3/4).
    if (u + v > z * 3 / 4) return 2;
    return -cmp(Rational(x * x + y * y + z * z), Rational(limit * limit));
  }
  return -cmp(Rational(x * x + z * z), Rational(limit * limit));
}

/** At a distance from the roof, or thereabouts; the direction leans over to either side. */
Vector3d Above(TieRng& rng, double distance, bool is_tip) {
  const double lean = Between(rng, -0.8, 0.8);
  const double slope = std::atan(0.75);
  const double along = is_tip ? Between(rng, -0.2, 0.2) : Between(rng, -0.5, 0.5);
  if (is_tip) {
    const double within = std::clamp(lean, -0.3, 0.3);
    const Vector3d w = Vector3d(std::sin(within), std::sin(along), 1).normalized();
    return distance * w;
  }
  if (std::abs(lean) <= slope) {
    return {distance * std::sin(lean), along, distance * std::cos(lean)};
  }
  const double side = lean > 0 ? 1 : -1, down = LogBetween(rng, 1e-3, 0.1);
  return {side * (0.6 * distance + 0.8 * down), along, 0.8 * distance - 0.6 * down};
}

}  // namespace

std::optional<EdgeCase> MakeRidges(TieRng& rng) {
  EdgeCase result;
  Model& model = result.model;
  model.require = GuideRequirement::kContact;
  const double radius = Below(rng, 2) == 0 ? 0 : 0.001953125, top = 0.5;
  const double band = model.contact.epsilon + radius;
  const bool is_tip = Below(rng, 4) == 0;
  const int strips = 1 + Below(rng, 5);
  Solid mesh = is_tip ? Tip(top) : Roof(strips, top);
  const std::size_t slopes = is_tip ? 4 : mesh.triangles.size();
  if (!is_tip) CloseRoof(strips, &mesh);

  const double margin = Signed(rng, LogBetween(rng, 1e-9, 1e-3));
  Vector3d ends[] = {Above(rng, band - margin, is_tip),
                     Above(rng, radius + Between(rng, 0.1, 0.99) * model.contact.epsilon, is_tip)};
  if (Below(rng, 2) == 0) std::swap(ends[0], ends[1]);
  // On either side of the ridge's plane x = 0 the distance from that side's slope is linear along
  // the way, four fifths of the height where it crosses and no less than that of the roof, times
  // four fifths, at the end: more than the site's radius and shape throughout.
  const Vector3d &a = ends[0], &b = ends[1];
  if (a.x() * b.x() < 0) {
    const double height = (a.z() * b.x() - b.z() * a.x()) / (b.x() - a.x());
    if (height < 1.3 * (radius + 0.002)) return std::nullopt;
  }
  // As stored: from the tip, sums with `top` are rounded.
  bool inside = true;
  for (Vector3d& p : ends) {
    p.z() = (p.z() + top) - top;
    const int side = CompareDistance(p, is_tip, Lift(model.contact.epsilon) + Lift(radius));
    if (side == 0 || side == 2) return std::nullopt;
    inside = inside && side > 0;
    p.z() += top;
  }
  result.truth = inside ? Verdict::kHolds : Verdict::kFails;
  const Pose place = RandomPlace(rng);
  model.robot.links = {PlainLink("base", -1, 1), PlainLink("site", 0, 1)};
  model.robot.links[1].shapes = {{{}, Sphere{0.0009765625}}};
  // Three slides in the roof's frame, which stands still: x, y and z are linear in s.
  model.robot.links.insert(model.robot.links.begin() + 1, {PlainLink("a", 0), PlainLink("b", 1)});
  model.robot.links[3].joint = 2;
  model.robot.joints = {PlainJoint(JointType::kPrismatic, 0, 1, {0, 0, 0}, {1, 0, 0}),
                        PlainJoint(JointType::kPrismatic, 1, 2, {0, 0, 0}, {0, 1, 0}),
                        PlainJoint(JointType::kPrismatic, 2, 3, {0, 0, 0}, {0, 0, 1})};
  AssignBodiesAndColumns(&model.robot);
  model.sites = {{3, {0, 0, 0}, radius}};
  model.contact.bodies = {3};
  model.objects = AsObjects(rng, mesh, slopes, place);
  result.edge = JointEdge(place, {ends[0].x(), ends[0].y(), ends[0].z()},
                          {ends[1].x(), ends[1].y(), ends[1].z()});
  return result;
}

}  // namespace cguide::fuzz
