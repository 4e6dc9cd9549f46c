#include <catch2/catch.hpp>
#include <cstddef>

#include "cguide/numeric/lanes_internal.h"
#include "cguide/numeric/sampling.h"

namespace cguide::numeric {
namespace {

using V = Pair8;

void Fill(Rng& rng, double (&x)[8]) {
  for (double& value : x) value = 2 * Uniform(rng) - 1;
}

}  // namespace

TEST_CASE("The largest of eight lanes is found wherever it is") {
  Rng rng(51);
  for (int at = 0; at < 8; ++at) {
    double x[8];
    Fill(rng, x);
    x[at] = 2;
    CHECK(Largest(Load<V>(x)) == 2);
  }
}

TEST_CASE("The sum of eight lanes takes the order it is said to") {
  Rng rng(52);
  for (int i = 0; i < 100; ++i) {
    double x[8];
    Fill(rng, x);
    CHECK(Sum(Load<V>(x)) == ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7])));
  }
}

TEST_CASE("The largest value brings its label along and hardly moves") {
  Rng rng(53);
  for (int i = 0; i < 100; ++i) {
    double x[8];
    Fill(rng, x);
    const int at = i % 8;
    x[at] += 3;
    const double found = Largest(Labelled(Load<V>(x), LaneNumbers<V>() + 8, 15));
    CHECK(LabelOf(found, 15) == 8U + static_cast<unsigned>(at));
    CHECK(std::abs(found - x[at]) <= 15 * 0x1p-52 * x[at]);
  }
}

TEST_CASE("Six numbers are loaded at any distance, before two zeros") {
  double x[16], lanes[8];
  for (int i = 0; i < 16; ++i) x[i] = i + 1;
  for (const std::size_t step : {1, 3}) {
    Store(LoadSix<V>(x, step), lanes);
    for (std::size_t i = 0; i < 8; ++i) CHECK(lanes[i] == (i < 6 ? x[i * step] : 0));
  }
}

TEST_CASE("Pairs are taken apart in their order") {
  Duo pair[8];
  for (int i = 0; i < 8; ++i) pair[i] = Duo{static_cast<double>(i), 10.0 + i};
  V first, second;
  Unzip(pair, &first, &second);
  double x[8], y[8];
  Store(first, x);
  Store(second, y);
  for (int i = 0; i < 8; ++i) {
    CHECK(x[i] == i);
    CHECK(y[i] == 10 + i);
  }
}

}  // namespace cguide::numeric
