#include "tests/peers/cgal_peer.h"

#include <CGAL/Gmpzf.h>
#include <CGAL/Polytope_distance_d.h>
#include <CGAL/Polytope_distance_d_traits_3.h>
#include <CGAL/Simple_cartesian.h>

#include <vector>

namespace cguide::peers {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Traits = CGAL::Polytope_distance_d_traits_3<Kernel, CGAL::Gmpzf, double>;

Rational ToRational(const CGAL::Gmpzf& x) {
  Rational result{mpz_class(x.man())};
  const long e = x.exp();
  if (e >= 0) {
    mpq_mul_2exp(result.get_mpq_t(), result.get_mpq_t(), static_cast<mp_bitcnt_t>(e));
  } else {
    mpq_div_2exp(result.get_mpq_t(), result.get_mpq_t(), static_cast<mp_bitcnt_t>(-e));
  }
  return result;
}

}  // namespace

struct CgalPoints::Data {
  std::vector<Kernel::Point_3> points;
};

CgalPoints::CgalPoints(std::span<const Eigen::Vector3d> points) : data_(std::make_shared<Data>()) {
  for (const Eigen::Vector3d& p : points) data_->points.emplace_back(p[0], p[1], p[2]);
}

Rational CgalSquaredDistance(const CgalPoints& a, const CgalPoints& b) {
  const CGAL::Polytope_distance_d<Traits> distance(a.data_->points.begin(), a.data_->points.end(),
                                                   b.data_->points.begin(), b.data_->points.end());
  return ToRational(distance.squared_distance_numerator()) /
         ToRational(distance.squared_distance_denominator());
}

}  // namespace cguide::peers
