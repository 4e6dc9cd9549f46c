#include <catch2/catch.hpp>

#include "cguide/numeric/float_normals_internal.h"
#include "cguide/numeric/minors_internal.h"
#include "cguide/numeric/sampling.h"

namespace cguide::numeric {
namespace {

Vector6d RandomRow(Rng& rng) {
  Vector6d row;
  for (double& x : row) x = Normal(rng);
  return row;
}

}  // namespace

TEST_CASE("normals by lanes are those one by one, to the bit") {
  Rng rng(1973);
  std::vector<Vector6d> rows;
  for (int i = 0; i < 30; ++i) rows.push_back(RandomRow(rng));
  for (const std::size_t count : {0, 1, 7, 8, 9, 50}) {
    FloatNormals normals;
    normals.sets.resize(count);
    for (auto& set : normals.sets) {
      for (std::int32_t& row : set) row = static_cast<std::int32_t>(rng() % 30);
    }
    normals.Compute(rows);
    REQUIRE(normals.normals.size() == count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto r = [&](int k) { return rows[normals.sets[i][k]].data(); };
      Vector6d y;
      NormalOfRows<double, double, double>(r(0), r(1), r(2), r(3), r(4), y.data());
      CHECK(normals.normals[i] == y);
      CHECK(normals.largest[i] == y.cwiseAbs().maxCoeff());
      const double* const a = r(5);
      CHECK(normals.products[i] == ((y[0] * a[0] + y[1] * a[1]) + (y[2] * a[2] + y[3] * a[3])) +
                                       (y[4] * a[4] + y[5] * a[5]));
    }
  }
}

}  // namespace cguide::numeric
