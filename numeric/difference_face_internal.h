#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "cguide/exact/distance_internal.h"
#include "cguide/numeric/gjk_internal.h"
#include "cguide/numeric/integer_vector_internal.h"

namespace cguide::numeric {

using exact::internal::IntegerPoint;

/** Points over Q behind doubles that are only near them; asked for one by one, when doubles do not
 carry a sign. */
class RationalPoints {
 public:
  virtual ~RationalPoints() = default;
  virtual Vector3q Get(bool of_b, int index) const = 0;
};

/** Two sets of points for signs that are filtered in doubles and settled in integers. */
struct HullPair {
  PointSet a;
  PointSet b;
  const RationalPoints* rational = nullptr;  ///< null where the doubles are the points
  /** What the magnitude of a difference is raised by so that its error is below u times that: 0
   where the doubles are the points. */
  double blur = 0;
  bool filter = true;  ///< false where bounds do not hold (kLargest) and integers settle all signs
  long exact_signs = 0;  ///< signs settled in integers
};

/** The filter is for coordinates up to this. */
inline constexpr double kLargest = 0x1p60;

/** The corner a[i] - b[j] of the difference body. */
struct Corner {
  int i = 0;
  int j = 0;
};

struct Simplex {
  int size = 0;
  std::array<Corner, 4> corners{};

  void Push(const Corner& corner) { corners[size++] = corner; }
};

/** A vector with componentwise bounds on its magnitude, by which its error is measured. */
struct Bounded {
  Eigen::Vector3d value;
  Eigen::Vector3d magnitude;
};

/** The corners of a simplex as integers: the real ones are w 2^exponent / scale. `n` is a multiple
 of the vector from the origin to the nearest point of the corners' affine hull:
   one corner     n = w_0,                 d^2 = n.w_0
   two            n = e x (w_0 x e),       d^2 = n.w_0 / e.e            e = w_1 - w_0
   three          n = +-(e_1 x e_2),       d^2 = (n.w_0)^2 / n.n        e_k = w_k - w_0
 (for three the sign is chosen so that n.w_0 >= 0) and d^2 = height / divisor. */
struct IntegerFace {
  int size = 0;
  std::array<IntegerPoint, 4> w;
  IntegerPoint n;
  mpz_class height;      ///< n.w_0, for three corners its square
  mpz_class divisor;     ///< 0 where the corners are affinely dependent
  bool flipped = false;  ///< whether n = -(e_1 x e_2)
  long exponent = 0;
  mpz_class scale = 1;
};

/** p - q for points of the same set, times a positive number. */
IntegerPoint IntegerDifference(const HullPair& hulls, bool of_b, int p, int q);

IntegerFace MakeIntegerFace(const HullPair& hulls, const Simplex& simplex);

/** Weights of the point nearest to the origin, up to one positive factor. For four corners those of
 the origin; dependent corners give zeros. */
std::array<mpz_class, 4> IntegerWeights(const IntegerFace& face);

/** d^2 of the face in lowest terms. */
Rational SquaredHeight(const IntegerFace& face);

/** d^2 of a simplex that holds its nearest point. */
Rational SquaredDistance(const HullPair& hulls, const Simplex& simplex);

/** The face of a simplex (any corners) that holds its point nearest to the origin in its relative
 interior. With four corners left, or height 0, the origin is in it. */
Simplex ReduceExactly(const HullPair& hulls, const Simplex& simplex);

/** A simplex as evidence for a distance: every question is answered in doubles where a bound
 carries the sign, else in integers. */
class Face {
 public:
  Face(HullPair* hulls, const Simplex& simplex);

  /** Whether the corners are independent and the point of their affine hull nearest to the origin
   has weights >= 0; for four corners, whether they hold the origin. */
  bool HoldsNearest();

  /** Whether that point is the origin. @pre HoldsNearest(). */
  bool MeetsOrigin() const { return meets_; }

  /** A corner w with n.w < n.w_0, if there is one. @pre HoldsNearest() and not MeetsOrigin(). */
  std::optional<Corner> Violator();

 private:
  const IntegerFace& Exact();
  bool OrientNormal();
  bool WeightsNonNegative();
  bool HoldsOrigin();
  void MarkKnownTies(std::array<bool, 4>* of_a, std::array<bool, 4>* of_b) const;
  void CollectNear(const PointSet& set, const Bounded& n, const Eigen::Vector3d& origin,
                   std::vector<int>* near) const;
  int Beyond(bool of_b, const std::array<bool, 4>& known);

  HullPair* hulls_;
  Simplex simplex_;
  std::array<Bounded, 4> w_;
  std::array<Bounded, 3> e_;
  Bounded n_;
  bool meets_ = false;
  std::optional<IntegerFace> exact_;
};

}  // namespace cguide::numeric
