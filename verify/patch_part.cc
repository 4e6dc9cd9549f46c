#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "cguide/verify/kept_patch_internal.h"

// Parts of obstacles: how far a foot is from one.
namespace cguide::verify::patch_internal {

using Eigen::Vector3d;
using numeric::Convex;

Vector3d At(const Vector2& a, double t) {
  return (a.c[0] + t * (a.c[1] + t * a.c[2])).head<3>().matrix();
}

double FootPath::Scale() const {
  return lower.cwiseAbs().cwiseMax(upper.cwiseAbs()).sum() + std::abs(height);
}

Part MakePart(const check::PatchPart& name, const std::vector<Vector3d>& v, bool is_face,
              double error, const Plane& plane) {
  Part part;
  part.name = name;
  part.is_face = is_face;
  part.v = v;
  part.error = error;
  part.depth = plane.h - plane.n.dot(v[0]);
  const int count = static_cast<int>(v.size());
  for (int k = 1; k < count; ++k) {
    part.side[k - 1] = v[k] - v[0];
    part.longest = std::max(part.longest, part.side[k - 1].norm());
    part.depth = std::max(part.depth, plane.h - plane.n.dot(v[k]));
  }
  if (count == 2) part.rows.row(0) = part.side[0].transpose() / part.side[0].squaredNorm();
  if (count < 3) return part;
  Eigen::Matrix<double, 3, 2> sides;
  sides << part.side[0], part.side[1];
  part.rows = (sides.transpose() * sides).inverse() * sides.transpose();
  const Vector3d last = is_face ? Vector3d(v[1] + part.side[1]) : v[2];
  part.longest = std::max(part.longest, (v[2] - v[1]).norm());
  part.depth = std::max(part.depth, plane.h - plane.n.dot(last));
  return part;
}

double GapAt(const Part& part, const Vector3d& foot) {
  if (part.v.empty()) return std::max(0.0, part.normal.dot(foot) - part.offset);
  Vector3d rest = foot - part.v[0];
  double outside = 0, sum = 0;
  for (int k = 1; k < static_cast<int>(part.v.size()); ++k) {
    const double l = part.rows.row(k - 1).dot(rest), below = std::max(0.0, -l);
    outside += part.is_face ? std::max(below, l - 1) * part.side[k - 1].norm() : below;
    sum += l;
    rest -= l * part.side[k - 1];
  }
  if (!part.is_face) outside = (outside + std::max(0.0, sum - 1)) * part.longest;
  return rest.norm() + outside;
}

/** f(t) for t in [from, to], as a function of t' in [-1, 1]. The ends are within 2 u, the sums
 within 8 u of the coefficients' sizes. */
Model2 Restricted(const Model2& a, double from, double to) {
  const double m = 0.5 * (from + to), k = 0.5 * (to - from);
  Model2 result;
  result.c[0] = a.c[0] + m * (a.c[1] + m * a.c[2]);
  result.c[1] = k * (a.c[1] + 2 * m * a.c[2]);
  result.c[2] = k * k * a.c[2];
  result.r = (a.r + 32 * kUnit * Magnitude(a)) * kUp;
  return result;
}

double Largest(const Model2& a) { return std::max(-LowerBound(a), UpperBound(a)); }

// As in contact_patch_internal.h of the checker, which proves it.
double GapOver(const Part& part, const FootPath& path, double from, double to) {
  constexpr double kSlop = 64 * kUnit;
  if (part.v.empty()) {
    const Model2 over = Dot<kDegree>(part.normal, path.foot) - Constant<kDegree>(part.offset);
    return std::max(0.0, UpperBound(Restricted(over, from, to)) + part.error);
  }
  Model2 rest[3];
  for (int i = 0; i < 3; ++i) {
    rest[i] =
        Restricted(Coordinate<kDegree>(path.foot, i) - Constant<kDegree>(part.v[0][i]), from, to);
  }
  double outside = 0, size = part.error;
  Model2 sum = Constant<kDegree>(0);
  for (int k = 1; k < static_cast<int>(part.v.size()); ++k) {
    const Vector3d& side = part.side[k - 1];
    Model2 l = Constant<kDegree>(0);
    for (int i = 0; i < 3; ++i) l = l + part.rows(k - 1, i) * rest[i];
    const double below = std::max(0.0, -LowerBound(l));
    outside += part.is_face ? std::max(below, UpperBound(l) - 1) * side.norm() : below;
    sum = sum + l;
    for (int i = 0; i < 3; ++i) rest[i] = rest[i] - side[i] * l;
    size += 4 * Largest(l) * (part.error + kSlop * side.norm());  // of sides, at corners' errors
  }
  if (!part.is_face) {
    outside = (outside + std::max(0.0, UpperBound(sum) - 1)) * (part.longest + 4 * part.error);
  }
  const Vector3d off(Largest(rest[0]), Largest(rest[1]), Largest(rest[2]));
  return (off.norm() + outside + size) * (1 + kSlop) + kSlop * path.Scale();
}

void PartList::AddBox(int piece, const Convex& s) {
  std::vector<Vector3d> v;
  for (int i = 0; i < 8; ++i) {
    v.push_back(s.c + s.R * Vector3d(i & 1 ? s.half[0] : -s.half[0], i & 2 ? s.half[1] : -s.half[1],
                                     i & 4 ? s.half[2] : -s.half[2]));
  }
  for (int face = 0; face < 6; ++face) {
    const int axis = face % 3, begin = face < 3 ? 1 << axis : 0;
    const int a = begin | 1 << (axis + 1) % 3, b = begin | 1 << (axis + 2) % 3;
    Add({piece, face, -1, {}, 1}, {v[begin], v[a], v[b]}, true, s.error);
  }
  for (int i = 0; i < 8; ++i) {
    Add({piece, -1, -1, {i}, 1}, {v[i]}, false, s.error);
    for (const int bit : {1, 2, 4}) {
      if (i & bit) continue;
      Add({piece, -1, -1, {i, i | bit}, 1}, {v[i], v[i | bit]}, false, s.error);
    }
  }
}

}  // namespace cguide::verify::patch_internal
