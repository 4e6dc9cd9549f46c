#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "tests/cases/convex_pairs.h"

namespace cguide::test {

struct TriangleCase {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
};

/** A closed bumpy surface about the origin: rings of
 longitude and latitude, radius between 0.7 and 1 of `size`. Faces: 2 columns (rows - 1). */
inline TriangleCase BumpySphere(std::mt19937_64& rng, int rows, int columns, double size) {
  TriangleCase result;
  for (int r = 1; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const double theta = M_PI * r / rows, phi = 2 * M_PI * c / columns;
      const double radius = size * cases::Uniform(rng, 0.7, 1);
      result.vertices.push_back(radius * Eigen::Vector3d(std::sin(theta) * std::cos(phi),
                                                         std::sin(theta) * std::sin(phi),
                                                         std::cos(theta)));
    }
  }
  const int north = static_cast<int>(result.vertices.size());
  result.vertices.push_back({0, 0, size});
  result.vertices.push_back({0, 0, -size});
  const auto at = [columns](int r, int c) { return r * columns + c % columns; };
  for (int c = 0; c < columns; ++c) {
    result.triangles.push_back({north, at(0, c), at(0, c + 1)});
    result.triangles.push_back({north + 1, at(rows - 2, c + 1), at(rows - 2, c)});
    for (int r = 0; r + 2 < rows; ++r) {
      result.triangles.push_back({at(r, c), at(r + 1, c), at(r + 1, c + 1)});
      result.triangles.push_back({at(r, c), at(r + 1, c + 1), at(r, c + 1)});
    }
  }
  return result;
}

/** A square of side 2 `half` in the plane z, cut into 2 n^2 triangles. */
inline TriangleCase Sheet(int n, double half, double z) {
  TriangleCase result;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      result.vertices.push_back({half * (2.0 * i / n - 1), half * (2.0 * j / n - 1), z});
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int at = i * (n + 1) + j;
      result.triangles.push_back({at, at + n + 1, at + n + 2});
      result.triangles.push_back({at, at + n + 2, at + 1});
    }
  }
  return result;
}

/** Loose triangles with corners on an integer grid, degenerate ones included. */
inline TriangleCase GridSoup(std::mt19937_64& rng, int count, int size) {
  TriangleCase result;
  for (int i = 0; i < 3 * count; ++i) {
    Eigen::Vector3d p;
    for (double& x : p) x = static_cast<int>(rng() % (2u * static_cast<unsigned>(size) + 1)) - size;
    result.vertices.push_back(p);
  }
  for (int t = 0; t < count; ++t) result.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  return result;
}

inline void Move(TriangleCase* set, const Eigen::Vector3d& by) { cases::Move(&set->vertices, by); }

}  // namespace cguide::test
