#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "cguide/numeric/float_normals_internal.h"
#include "cguide/numeric/insertion_order_internal.h"
#include "cguide/numeric/minors_internal.h"
#include "cguide/numeric/sampling.h"

namespace cguide::numeric {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

Vector6d RandomRow(Rng& rng) {
  Vector6d row;
  for (double& x : row) x = Normal(rng);
  return row;
}

std::vector<int> Order(const std::vector<Vector6d>& rows) {
  std::vector<int> all(rows.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<int> order = all;
  SortOutermostFirst(rows, all, &order);
  return order;
}

}  // namespace

TEST_CASE("the row along the mean is the last one, and linear maps leave the order as it is") {
  Rng rng(1971);
  for (int round = 0; round < 100; ++round) {
    std::vector<Vector6d> rows;
    Vector6d sum = Vector6d::Zero();
    for (int i = 0; i < 20; ++i) {
      rows.push_back(RandomRow(rng));
      rows.back()[0] = 1 + std::abs(rows.back()[0]);
      sum += rows.back();
    }
    rows.push_back(sum / 20);
    const std::vector<int> order = Order(rows);
    CHECK(order.back() == 20);
    Matrix6d map = Matrix6d::Identity();
    for (int k = 0; k < 6; ++k) map.col(k) += 0.3 * RandomRow(rng);
    for (Vector6d& row : rows) row = (map * row).eval();
    CHECK(Order(rows) == order);
  }
}

TEST_CASE("every index is kept, whatever the rows") {
  Rng rng(1972);
  std::vector<Vector6d> rows;
  CHECK(Order(rows).empty());
  for (const double size : {0.0, 1e-320, 1.0, 1e200}) {
    for (int i = 0; i < 4; ++i) rows.push_back(size * RandomRow(rng));
  }
  for (int i = 0; i < 3; ++i) rows.push_back(Vector6d::Unit(2));
  for (int round = 0; round < 2; ++round) {
    std::vector<int> order = Order(rows);
    CHECK(order == Order(rows));
    std::sort(order.begin(), order.end());
    std::vector<int> all(rows.size());
    std::iota(all.begin(), all.end(), 0);
    CHECK(order == all);
    rows.erase(rows.begin() + 4, rows.end() - 3);  // zeros and one direction
  }
}

}  // namespace cguide::numeric
