#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "cguide/numeric/convex_distance.h"

namespace cguide::test {

struct BoxCase {
  Eigen::Vector3d center;
  Eigen::Vector3d half;
};

/** Two sets of points whose hulls are the case. */
struct ConvexPair {
  std::vector<Eigen::Vector3d> a;
  std::vector<Eigen::Vector3d> b;
  /** Where the hulls are axis-aligned boxes with exactly these numbers, for solvers with a box. */
  std::optional<std::array<BoxCase, 2>> boxes;
};

/** Kinds of pairs that have made float solvers err. Every hull has volume; rounding makes no pair
 other than it is: the doubles are the case. */
enum class PairCategory {
  kRandom,         ///< random hulls at any distance, overlapping included
  kGridBoxes,      ///< boxes with all numbers multiples of 1/8
  kParallelFaces,  ///< boxes face to face, gap 0 or +-1e-16 .. 1e-4
  kNearTouch,      ///< random hulls moved to a distance of +-1e-12 .. 1e-3 (negative: overlap)
  kThreshold,      ///< likewise, 0.01 +- 1e-12 .. 1e-6
  kThin,           ///< turned plates and needles, 1e-7 .. 1e-2 thick
  kFarNearTouch,   ///< near touch, 50 m from the origin
  kTouching,       ///< hulls on a grid that share exactly one corner and a plane between them
  kNested          ///< one inside the other
};

inline constexpr PairCategory kPairCategories[] = {
    PairCategory::kRandom,       PairCategory::kGridBoxes, PairCategory::kParallelFaces,
    PairCategory::kNearTouch,    PairCategory::kThreshold, PairCategory::kThin,
    PairCategory::kFarNearTouch, PairCategory::kTouching,  PairCategory::kNested};

inline const char* NameOf(PairCategory category) {
  static constexpr const char* kNames[] = {
      "random", "grid boxes",         "parallel faces", "near touch", "threshold 0.01",
      "thin",   "near touch at 50 m", "touching",       "nested"};
  return kNames[static_cast<int>(category)];
}

namespace cases {

using Points = std::vector<Eigen::Vector3d>;
using Random = std::mt19937_64;

inline double Uniform(Random& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}

inline Eigen::Vector3d Direction(Random& rng) {
  while (true) {
    const Eigen::Vector3d v(Uniform(rng, -1, 1), Uniform(rng, -1, 1), Uniform(rng, -1, 1));
    if (v.norm() > 0.1 && v.norm() < 1) return v / v.norm();
  }
}

/** Points near an ellipsoid, nearly all of them corners of their hull. */
inline Points Ellipsoid(Random& rng, int count, double size) {
  const Eigen::Vector3d half(Uniform(rng, 0.3, 1) * size, Uniform(rng, 0.3, 1) * size,
                             Uniform(rng, 0.3, 1) * size);
  Points points;
  for (int i = 0; i < count; ++i) points.push_back(Direction(rng).cwiseProduct(half));
  return points;
}

inline void Move(Points* points, const Eigen::Vector3d& by) {
  for (Eigen::Vector3d& p : *points) p += by;
}

inline Points Corners(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
  Points points;
  for (int k = 0; k < 8; ++k) {
    points.push_back(
        {k & 1 ? upper[0] : lower[0], k & 2 ? upper[1] : lower[1], k & 4 ? upper[2] : lower[2]});
  }
  return points;
}

/** The vector between closest points, rounded; zero where the hulls meet. */
inline Eigen::Vector3d Between(const Points& a, const Points& b) {
  std::vector<Vector3q> p, q;
  for (const auto& x : a) p.push_back(Lift(x));
  for (const auto& x : b) q.push_back(Lift(x));
  const auto closest =
      numeric::ClosestPoints(p, q, numeric::SquaredConvexDistance(std::span(a), std::span(b)));
  Eigen::Vector3d v;
  for (int k = 0; k < 3; ++k) v[k] = NearestDouble(closest.a[k] - closest.b[k]);
  return v;
}

/** +-10^-low .. 10^-high. */
inline double Tiny(Random& rng, int low, int high) {
  const double size = std::pow(10.0, -Uniform(rng, high, low));
  return rng() % 2 ? size : -size;
}

inline int Count(Random& rng) { return 4 + static_cast<int>(rng() % 21); }

/** Two random hulls whose distance is `distance` up to rounding; an overlap where it is < 0. */
inline ConvexPair AtDistance(Random& rng, int count_a, int count_b, double distance) {
  ConvexPair pair;
  Eigen::Vector3d v;
  do {
    pair.a = Ellipsoid(rng, count_a, 0.3);
    pair.b = Ellipsoid(rng, count_b, 0.3);
    Move(&pair.b, 0.9 * Direction(rng));
    v = Between(pair.a, pair.b);
  } while (v.norm() < 0.01);
  Move(&pair.b, (1 - distance / v.norm()) * v);
  return pair;
}

inline ConvexPair GridBoxes(Random& rng) {
  const auto grid = [&rng](int low, int high) {
    return (low + static_cast<int>(rng() % static_cast<unsigned>(high - low + 1))) / 8.0;
  };
  std::array<BoxCase, 2> boxes;
  for (BoxCase& box : boxes) {
    box.center = {grid(-8, 8), grid(-8, 8), grid(-8, 8)};
    box.half = {grid(1, 6), grid(1, 6), grid(1, 6)};
  }
  const auto corners = [](const BoxCase& box) {
    return Corners(box.center - box.half, box.center + box.half);
  };
  return {corners(boxes[0]), corners(boxes[1]), boxes};
}

inline ConvexPair ParallelFaces(Random& rng) {
  const auto extent = [&rng] { return Uniform(rng, 0.05, 0.5); };
  const double gap = rng() % 5 == 0 ? 0 : Tiny(rng, 16, 4);
  const Eigen::Vector3d shift(Uniform(rng, -0.3, 0.3), Uniform(rng, -0.3, 0.3), 0);
  const double face = extent();
  ConvexPair pair;
  pair.a = Corners({-extent(), -extent(), -extent()}, {extent(), extent(), face});
  pair.b = Corners(shift + Eigen::Vector3d(-extent(), -extent(), face + gap),
                   shift + Eigen::Vector3d(extent(), extent(), face + gap + extent()));
  const int axis = static_cast<int>(rng() % 3);
  for (Points* points : {&pair.a, &pair.b}) {
    for (Eigen::Vector3d& p : *points) std::swap(p[2], p[axis]);
  }
  return pair;
}

inline Eigen::Matrix3d Rotation(Random& rng) {
  const Eigen::Vector3d x = Direction(rng);
  const Eigen::Vector3d d = Direction(rng);
  const Eigen::Vector3d z(x[1] * d[2] - x[2] * d[1], x[2] * d[0] - x[0] * d[2],
                          x[0] * d[1] - x[1] * d[0]);
  if (z.norm() < 0.1) return Rotation(rng);
  const Eigen::Vector3d n = z / z.norm();
  Eigen::Matrix3d R;
  R.col(0) = x;
  R.col(1) = Eigen::Vector3d(n[1] * x[2] - n[2] * x[1], n[2] * x[0] - n[0] * x[2],
                             n[0] * x[1] - n[1] * x[0]);
  R.col(2) = n;
  return R;
}

inline ConvexPair Thin(Random& rng) {
  ConvexPair pair;
  for (Points* points : {&pair.a, &pair.b}) {
    const double thin = std::pow(10.0, -Uniform(rng, 2, 7));
    const Eigen::Vector3d half(0.5, rng() % 2 ? 0.5 : thin, thin);
    const Eigen::Matrix3d R = Rotation(rng);
    for (const Eigen::Vector3d& p : Corners(-half, half)) points->push_back(R * p);
  }
  Move(&pair.b, Uniform(rng, 0, 0.8) * Direction(rng));
  return pair;
}

inline ConvexPair Touching(Random& rng) {
  ConvexPair pair;
  for (Points* points : {&pair.a, &pair.b}) {
    *points = Ellipsoid(rng, Count(rng), 40);
    for (Eigen::Vector3d& p : *points) {
      for (double& x : p) x = std::round(x) / 64;
    }
  }
  const Eigen::Vector3d n = Direction(rng);
  const auto farthest = [](const Points& points, const Eigen::Vector3d& along) {
    return *std::max_element(points.begin(), points.end(), [&](const auto& p, const auto& q) {
      return along.dot(p) < along.dot(q);
    });
  };
  Move(&pair.b, farthest(pair.a, n) - farthest(pair.b, -n));
  return pair;
}

inline ConvexPair Nested(Random& rng) {
  ConvexPair pair{Ellipsoid(rng, 12 + Count(rng), 0.5), Ellipsoid(rng, Count(rng), 0.02), {}};
  Move(&pair.b, 0.05 * Direction(rng));
  return pair;
}

}  // namespace cases

inline ConvexPair MakeConvexPair(PairCategory category, std::mt19937_64& rng) {
  using namespace cases;
  switch (category) {
    case PairCategory::kRandom: {
      ConvexPair pair{Ellipsoid(rng, Count(rng), 0.3), Ellipsoid(rng, Count(rng), 0.3), {}};
      Move(&pair.b, Uniform(rng, 0, 1) * Direction(rng));
      return pair;
    }
    case PairCategory::kGridBoxes:
      return GridBoxes(rng);
    case PairCategory::kParallelFaces:
      return ParallelFaces(rng);
    case PairCategory::kNearTouch:
      return AtDistance(rng, Count(rng), Count(rng), Tiny(rng, 12, 3));
    case PairCategory::kThreshold:
      return AtDistance(rng, Count(rng), Count(rng), 0.01 + Tiny(rng, 12, 6));
    case PairCategory::kThin:
      return Thin(rng);
    case PairCategory::kFarNearTouch: {
      ConvexPair pair = AtDistance(rng, Count(rng), Count(rng), Tiny(rng, 12, 3));
      const Eigen::Vector3d away(50, -30 * Uniform(rng, -1, 1), 10);
      Move(&pair.a, away);
      Move(&pair.b, away);
      return pair;
    }
    case PairCategory::kTouching:
      return Touching(rng);
    case PairCategory::kNested:
      break;
  }
  return Nested(rng);
}

}  // namespace cguide::test
