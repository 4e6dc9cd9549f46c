#include "cguide/numeric/sites.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/kinematics.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMaxVertexSites = 12;
constexpr std::size_t kMaxSites = 24;
constexpr int kRimPoints = 8;
constexpr int kMaxDivisions = 64;  // per edge of a face, whatever the spacing

/** Points that may become sites. Every surface point lies within `resolution` of a candidate. */
struct Candidates {
  std::vector<Vector3d> vertices;
  std::vector<Vector3d> surface;
  double resolution = 0;
};

// Number of parts no longer than `pitch`, at most kMaxDivisions.
int Divisions(double length, double pitch) {
  const double n = std::ceil(length / pitch);
  return n < 1 ? 1 : n > kMaxDivisions ? kMaxDivisions : static_cast<int>(n);
}

// A lattice on the triangle. The small triangles have sides at most e = longest/n; a point of a
// triangle with longest side e is within e/sqrt(3) of a vertex (the circumradius e/(2 sin A), A the
// largest angle, where it is acute: A >= 60 degrees; e/2 where it is not).
void AddTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c, double pitch,
                 Candidates* candidates) {
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  const int n = Divisions(longest, pitch);
  candidates->resolution = std::max(candidates->resolution, longest / n / std::sqrt(3.0));
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j + i <= n; ++j) {
      candidates->surface.push_back(a + (b - a) * i / n + (c - a) * j / n);
    }
  }
}

// A lattice on the parallelogram o + s a + t b with a, b at right angles: a point of a cell is
// within half its diagonal of a corner.
void AddRectangle(const Vector3d& o, const Vector3d& a, const Vector3d& b, double pitch,
                  Candidates* candidates) {
  const int m = Divisions(a.norm(), pitch);
  const int n = Divisions(b.norm(), pitch);
  candidates->resolution =
      std::max(candidates->resolution, std::hypot(a.norm() / m, b.norm() / n) / 2);
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= n; ++j) candidates->surface.push_back(o + a * i / m + b * j / n);
  }
}

Candidates OfShape(const Box& box, double pitch) {
  Candidates candidates;
  const Vector3d h = box.size / 2;
  for (int i = 0; i < 8; ++i) {
    candidates.vertices.emplace_back(i & 1 ? h[0] : -h[0], i & 2 ? h[1] : -h[1],
                                     i & 4 ? h[2] : -h[2]);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d a = Vector3d::Unit((axis + 1) % 3) * box.size[(axis + 1) % 3];
    const Vector3d b = Vector3d::Unit((axis + 2) % 3) * box.size[(axis + 2) % 3];
    AddRectangle(-h, a, b, pitch, &candidates);
    AddRectangle(h, -a, -b, pitch, &candidates);
  }
  return candidates;
}

Candidates OfShape(const Hull& hull, double pitch) {
  Candidates candidates{hull.vertices, {}, 0};
  for (const auto& face : hull.faces) {
    AddTriangle(hull.vertices[face[0]], hull.vertices[face[1]], hull.vertices[face[2]], pitch,
                &candidates);
  }
  return candidates;
}

// Rings of points on the caps and on the side. A surface point differs from a lattice point by at
// most half a step in each of two orthogonal directions; arcs only shorten the distance.
Candidates OfShape(const Cylinder& cylinder, double pitch) {
  Candidates candidates;
  const double r = cylinder.radius, h = cylinder.length / 2;
  const auto at = [&](double radius, double turn, double z) {
    const double angle = 2 * std::numbers::pi * turn;
    return Vector3d(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  for (double z : {-h, h}) {
    for (int i = 0; i < kRimPoints; ++i) {
      candidates.vertices.push_back(at(r, double(i) / kRimPoints, z));
    }
  }
  const int around = std::max(kRimPoints, Divisions(2 * std::numbers::pi * r, pitch));
  const int along = Divisions(2 * h, pitch);
  const int rings = Divisions(r, pitch);
  const double arc = 2 * std::numbers::pi * r / around;
  candidates.resolution = std::hypot(arc, std::max(2 * h / along, r / rings)) / 2;
  for (int i = 0; i < around; ++i) {
    const double turn = double(i) / around;
    for (int k = 0; k <= along; ++k) {
      candidates.surface.push_back(at(r, turn, -h + 2 * h * k / along));
    }
    for (int k = 1; k < rings; ++k) {
      candidates.surface.push_back(at(r * k / rings, turn, -h));
      candidates.surface.push_back(at(r * k / rings, turn, h));
    }
  }
  candidates.surface.emplace_back(0, 0, -h);
  candidates.surface.emplace_back(0, 0, h);
  return candidates;
}

/** Farthest-point sampling: a growing set of chosen points. */
class FarthestPoints {
 public:
  const std::vector<Vector3d>& chosen() const { return chosen_; }

  /** Takes points of `pool`, always the one farthest from all chosen (the first of several), until
   all are within `reach` of a chosen one or `limit` are chosen. */
  void Extend(const std::vector<Vector3d>& pool, double reach, std::size_t limit) {
    std::vector<double> square(pool.size(), std::numeric_limits<double>::infinity());
    for (const Vector3d& c : chosen_) Lower(pool, c, &square);
    while (chosen_.size() < limit && !pool.empty()) {
      const auto farthest = std::max_element(square.begin(), square.end());
      if (!(*farthest > 0) || (reach > 0 && *farthest <= reach * reach)) return;
      chosen_.push_back(pool[static_cast<std::size_t>(farthest - square.begin())]);
      Lower(pool, chosen_.back(), &square);
    }
  }

 private:
  static void Lower(const std::vector<Vector3d>& pool, const Vector3d& c,
                    std::vector<double>* square) {
    for (std::size_t i = 0; i < pool.size(); ++i) {
      (*square)[i] = std::min((*square)[i], (pool[i] - c).squaredNorm());
    }
  }

  std::vector<Vector3d> chosen_;
};

struct Ball {
  Vector3d centre_S = Vector3d::Zero();
  double radius = 0;
};

std::vector<Ball> Points(const Candidates& candidates, double spacing) {
  FarthestPoints points;
  points.Extend(candidates.vertices, 0, kMaxVertexSites);
  // Candidates within spacing - resolution of a site put every surface point within the spacing.
  points.Extend(candidates.surface, std::max(spacing - candidates.resolution, spacing / 2),
                kMaxSites);
  std::vector<Ball> balls;
  for (const Vector3d& p : points.chosen()) balls.push_back({p, 0});
  return balls;
}

template <typename Shape>
std::vector<Ball> SitesOf(const Shape& shape, double spacing) {
  return Points(OfShape(shape, spacing / 8), spacing);
}

std::vector<Ball> SitesOf(const Sphere& sphere, double) {
  return {{Vector3d::Zero(), sphere.radius}};
}

// Balls at most `spacing` apart along the axis, both ends included.
std::vector<Ball> SitesOf(const Capsule& capsule, double spacing) {
  const int n = std::min(Divisions(capsule.length, spacing), static_cast<int>(kMaxSites) - 1);
  std::vector<Ball> balls;
  for (int i = 0; i <= n; ++i) {
    balls.push_back({Vector3d(0, 0, (double(i) / n - 0.5) * capsule.length), capsule.radius});
  }
  return balls;
}

double DistanceTo(const Box& box, const Vector3d& x) {
  return (x.cwiseAbs() - box.size / 2).cwiseMax(0).norm();
}

double DistanceTo(const Sphere& sphere, const Vector3d& x) {
  return std::max(0.0, x.norm() - sphere.radius);
}

double DistanceTo(const Cylinder& cylinder, const Vector3d& x) {
  const double outward = std::max(0.0, std::hypot(x[0], x[1]) - cylinder.radius);
  return std::hypot(outward, std::max(0.0, std::abs(x[2]) - cylinder.length / 2));
}

double DistanceTo(const Capsule& capsule, const Vector3d& x) {
  const double z = std::max(0.0, std::abs(x[2]) - capsule.length / 2);
  return std::max(0.0, Vector3d(x[0], x[1], z).norm() - capsule.radius);
}

double DistanceToSegment(const Vector3d& a, const Vector3d& b, const Vector3d& x) {
  const Vector3d d = b - a;
  const double square = d.squaredNorm();
  const double t = square > 0 ? std::clamp((x - a).dot(d) / square, 0.0, 1.0) : 0.0;
  return (x - a - t * d).norm();
}

double DistanceToTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                          const Vector3d& x) {
  const Vector3d n = (b - a).cross(c - a);
  const auto inside = [&](const Vector3d& p, const Vector3d& q) {
    return (q - p).cross(x - p).dot(n) >= 0;
  };
  if (n.squaredNorm() > 0 && inside(a, b) && inside(b, c) && inside(c, a)) {
    return std::abs((x - a).dot(n)) / n.norm();
  }
  return std::min(
      {DistanceToSegment(a, b, x), DistanceToSegment(b, c, x), DistanceToSegment(c, a, x)});
}

double DistanceTo(const Hull& hull, const Vector3d& x) {
  double nearest = std::numeric_limits<double>::infinity();
  bool outside = hull.faces.empty();
  for (const auto& face : hull.faces) {
    const Vector3d& a = hull.vertices[face[0]];
    const Vector3d& b = hull.vertices[face[1]];
    const Vector3d& c = hull.vertices[face[2]];
    const Vector3d n = (b - a).cross(c - a);
    if ((x - a).dot(n) > 0) outside = true;
    nearest = std::min(nearest, DistanceToTriangle(a, b, c, x));
  }
  for (const Vector3d& v : hull.vertices) nearest = std::min(nearest, (x - v).norm());
  return outside ? nearest : 0;
}

void CheckLink(const Robot& robot, int link) {
  Require(link >= 0 && link < static_cast<int>(robot.links.size()), "the link must exist");
}

}  // namespace

std::vector<Site> DefaultSites(const Robot& robot, int link, const SiteOptions& options) {
  CheckLink(robot, link);
  Require(options.spacing > 0 && std::isfinite(options.spacing), "the spacing must be positive");
  std::vector<Site> sites;
  for (const LinkShape& shape : robot.links[link].shapes) {
    const Transform X_LS = ToTransform(shape.X_LS);
    const std::vector<Ball> balls = std::visit(
        [&](const auto& geometry) { return SitesOf(geometry, options.spacing); }, shape.geometry);
    for (const Ball& ball : balls) sites.push_back({link, X_LS * ball.centre_S, ball.radius});
  }
  return sites;
}

double DistanceToLink(const Robot& robot, int link, const Vector3d& x_L) {
  CheckLink(robot, link);
  double nearest = std::numeric_limits<double>::infinity();
  for (const LinkShape& shape : robot.links[link].shapes) {
    const Transform X_LS = ToTransform(shape.X_LS);
    const Vector3d x_S = X_LS.R.transpose() * (x_L - X_LS.p);
    nearest = std::min(
        nearest, std::visit([&](const auto& g) { return DistanceTo(g, x_S); }, shape.geometry));
  }
  return nearest;
}

}  // namespace cguide::numeric
