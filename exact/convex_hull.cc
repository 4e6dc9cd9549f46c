#include "cguide/exact/convex_hull.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "cguide/exact/core/error.h"

namespace cguide::exact {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Face = std::array<int, 3>;

/** Distinct points in the order of their first appearance, and lexicographically by index. */
struct PointSet {
  std::vector<Point> points;
  std::map<std::array<double, 3>, int> index;
};

PointSet Distinct(const std::vector<Eigen::Vector3d>& input) {
  PointSet set;
  for (const Eigen::Vector3d& p : input) {
    Require(p.allFinite(), "a point of the hull has a NaN or infinite coordinate");
    // Adding +0 turns -0 into +0, so that equal numbers make equal keys.
    const std::array<double, 3> key{p[0] + 0.0, p[1] + 0.0, p[2] + 0.0};
    if (set.index.emplace(key, static_cast<int>(set.points.size())).second) {
      set.points.emplace_back(key[0], key[1], key[2]);
    }
  }
  return set;
}

/** Indices of up to four affinely independent points: a maximal independent subset. */
std::vector<int> AffineBasis(const std::vector<Point>& p) {
  std::vector<int> basis{0};
  const int n = static_cast<int>(p.size());
  int i = 1;
  if (n > 1) basis.push_back(i++);  // distinct points
  for (; i < n && basis.size() == 2; ++i) {
    if (!CGAL::collinear(p[0], p[1], p[i])) basis.push_back(i);
  }
  for (; i < n && basis.size() == 3; ++i) {
    if (!CGAL::coplanar(p[0], p[1], p[basis[2]], p[i])) basis.push_back(i);
  }
  return basis;
}

/** Counter-clockwise strictly convex polygon of a flat set, as indices [Andrew 1979].

 Dropping a coordinate in which the plane's normal does not vanish is an affine bijection from the
 plane to R^2, and it is exact on doubles. The basis triangle tells which coordinate may go. */
std::vector<int> FlatHull(const PointSet& set, const std::vector<int>& basis) {
  int drop = 0;
  const auto project = [&](int i) {
    const Point& p = set.points[i];
    return Kernel::Point_2(p[(drop + 1) % 3], p[(drop + 2) % 3]);
  };
  while (CGAL::collinear(project(basis[0]), project(basis[1]), project(basis[2]))) ++drop;

  std::vector<int> order(set.points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return project(a) < project(b); });

  std::vector<int> chain;
  const auto extend = [&](int i, std::size_t floor) {
    while (chain.size() >= floor + 2 &&
           CGAL::orientation(project(chain[chain.size() - 2]), project(chain.back()), project(i)) !=
               CGAL::LEFT_TURN) {
      chain.pop_back();
    }
    chain.push_back(i);
  };
  for (int i : order) extend(i, 0);
  const std::size_t lower = chain.size() - 1;
  for (auto it = order.rbegin() + 1; it != order.rend(); ++it) extend(*it, lower);
  chain.pop_back();
  return chain;
}

/** Outward triangles of the hull of a set of full dimension, by quickhull [Barber et al. 1996]. */
std::vector<Face> SolidFaces(const PointSet& set, const std::vector<Point>& points) {
  CGAL::Surface_mesh<Point> mesh;
  CGAL::convex_hull_3(points.begin(), points.end(), mesh);
  std::vector<Face> faces;
  for (const auto f : mesh.faces()) {
    Face face{};
    int k = 0;
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) {
      const Point& p = mesh.point(v);
      face[k++] = set.index.at({p[0], p[1], p[2]});
    }
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    faces.push_back(face);
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

/** Corners of the triangulated hull that are extreme points. Quickhull may keep a point inside an
 edge or a facet where several are equally far. A corner is extreme iff the planes of its faces meet
 in the corner alone. Three different ones do: had they a line in common, the tangent cone at the
 corner were a wedge about that line, whose boundary, where the faces lie, has two planes at most.
 Fewer than three planes always have a line in common. */
std::vector<bool> ExtremeCorners(const PointSet& set, const std::vector<Face>& faces) {
  std::vector<std::vector<const Face*>> planes(set.points.size());
  for (const Face& f : faces) {
    for (int corner : f) {
      auto& known = planes[corner];
      if (known.size() == 3) continue;
      const bool is_new = std::none_of(known.begin(), known.end(), [&](const Face* g) {
        return std::all_of(g->begin(), g->end(), [&](int i) {
          return CGAL::coplanar(set.points[f[0]], set.points[f[1]], set.points[f[2]],
                                set.points[i]);
        });
      });
      if (is_new) known.push_back(&f);
    }
  }
  std::vector<bool> extreme(set.points.size());
  for (std::size_t i = 0; i < extreme.size(); ++i) extreme[i] = planes[i].size() == 3;
  return extreme;
}

/** Facets of a triangulated hull: for each triangle a representative of those coplanar with it. */
std::vector<int> FacetOfTriangle(const PointSet& set, const std::vector<Face>& faces,
                                 const std::map<std::pair<int, int>, int>& left_of) {
  std::vector<int> facet(faces.size());
  for (std::size_t i = 0; i < facet.size(); ++i) facet[i] = static_cast<int>(i);
  const auto find = [&](int i) {
    while (facet[i] != i) i = facet[i] = facet[facet[i]];
    return i;
  };
  for (const auto& [edge, face] : left_of) {
    const auto f = face;  // clang 14 does not capture structured bindings
    const int g = left_of.at({edge.second, edge.first});
    const bool flat = std::all_of(faces[g].begin(), faces[g].end(), [&](int i) {
      return CGAL::coplanar(set.points[faces[f][0]], set.points[faces[f][1]],
                            set.points[faces[f][2]], set.points[i]);
    });
    if (flat) facet[find(f)] = find(g);
  }
  for (std::size_t i = 0; i < facet.size(); ++i) facet[i] = find(static_cast<int>(i));
  return facet;
}

/** The same surface with every facet cut into triangles about its corner of lowest index. Quickhull
 cuts facets of more than three corners in an order that depends on where its nodes lie in memory,
 and faces, through the sites placed on them, must be a function of the points. Every corner being
 extreme, a facet is a strictly convex polygon and no triangle of the fan is degenerate. */
std::vector<Face> Canonical(const PointSet& set, const std::vector<Face>& faces) {
  std::map<std::pair<int, int>, int> left_of;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      left_of[{faces[f][k], faces[f][(k + 1) % 3]}] = static_cast<int>(f);
    }
  }
  const std::vector<int> facet = FacetOfTriangle(set, faces, left_of);
  std::map<int, std::map<int, int>> next;  // facet -> corner -> corner after it
  for (const auto& [edge, f] : left_of) {
    if (facet[f] != facet[left_of.at({edge.second, edge.first})]) {
      next[facet[f]][edge.first] = edge.second;
    }
  }
  std::vector<Face> result;
  for (const auto& [id, after] : next) {
    const int apex = after.begin()->first;
    for (int i = after.at(apex); after.at(i) != apex; i = after.at(i)) {
      result.push_back({apex, i, after.at(i)});
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<Face> SolidHull(const PointSet& set) {
  std::vector<Face> faces = SolidFaces(set, set.points);
  const std::vector<bool> extreme = ExtremeCorners(set, faces);
  std::vector<Point> corners;
  bool redundant = false;
  std::set<int> used;
  for (const Face& f : faces) used.insert(f.begin(), f.end());
  for (int i : used) {
    if (extreme[i]) corners.push_back(set.points[i]);
    redundant = redundant || !extreme[i];
  }
  // Among extreme points alone every hull corner is extreme, so one more pass suffices.
  return Canonical(set, redundant ? SolidFaces(set, corners) : faces);
}

Hull Assemble(const PointSet& set, std::vector<Face> faces, std::vector<int> corners) {
  for (const Face& f : faces) corners.insert(corners.end(), f.begin(), f.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  Hull hull;
  std::map<int, int> renumbered;
  for (int i : corners) {
    renumbered[i] = static_cast<int>(hull.vertices.size());
    const Point& p = set.points[i];
    hull.vertices.emplace_back(p[0], p[1], p[2]);
  }
  for (Face f : faces) {
    for (int& i : f) i = renumbered[i];
    hull.faces.push_back(f);
  }
  return hull;
}

Hull HullOf(const PointSet& set) {
  const std::vector<int> basis = AffineBasis(set.points);
  if (basis.size() == 1) return Assemble(set, {}, {0});
  if (basis.size() == 2) {
    // On a line the ends are the lexicographic extremes, and the map is sorted that way.
    return Assemble(set, {}, {set.index.begin()->second, set.index.rbegin()->second});
  }
  if (basis.size() == 4) return Assemble(set, SolidHull(set), {});
  const std::vector<int> polygon = FlatHull(set, basis);
  std::vector<Face> faces;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    faces.push_back({polygon[0], polygon[i - 1], polygon[i]});
    faces.push_back({polygon[0], polygon[i], polygon[i - 1]});
  }
  return Assemble(set, std::move(faces), {});
}

}  // namespace

Hull ConvexHull(const std::vector<Eigen::Vector3d>& points) {
  Require(!points.empty(), "the convex hull of no points is empty");
  const PointSet set = Distinct(points);
  try {
    return HullOf(set);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(Error::Code::kInternal,
                std::string("the convex hull of a mesh could not be computed: ") + e.what());
  }
}

}  // namespace cguide::exact
