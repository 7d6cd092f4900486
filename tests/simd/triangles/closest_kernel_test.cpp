#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "ist/base/float_environment.h"
#include "ist/query/triangles/triangle_distance.h"
#include "query/query_cases.h"
#include "simd/targets.h"
#include "simd/triangles/closest.h"
#include "support/effort.h"
#include "support/random.h"

namespace ist::test {
namespace {

// Each form of the kernel of closest parts against the scalar one, bit by bit.
class ClosestKernel : public ::testing::TestWithParam<std::string> {
 protected:
  template <class Number>
  void expect_same(int times, const Number& number) {
    const ScopedFloatEnvironment environment;
    const Kernels& kernels = select_kernels(GetParam());
    for (int i = 0; i < times; ++i) {
      TriangleOctet pairs;
      for (auto* side : {&pairs.fixed, &pairs.moving}) {
        for (auto& corner : *side) {
          for (auto& coordinate : corner) {
            for (double& x : coordinate) x = number();
          }
        }
      }
      const PlainMove move = plain_move(pose_of(random_.rotation(), random_.point(-1, 1)));
      OctetDistances made, wanted;
      kernels.clusters.closest_octet(pairs, move, made);
      closest_octet_scalar(pairs, move, wanted);
      ASSERT_EQ(std::memcmp(&made, &wanted, sizeof made), 0) << i;
    }
  }
  Random random_{5};
};

TEST_P(ClosestKernel, OfRandomTriangles) {
  expect_same(samples(2'000), [&] { return random_.uniform(-1, 1); });
}

TEST_P(ClosestKernel, OfTrianglesOnAGrid) {
  for (const std::size_t size : {1u, 2u, 3u}) {
    expect_same(samples(500), [&] { return static_cast<double>(random_.below(size)); });
  }
}

TEST_P(ClosestKernel, OfSlivers) {
  for (const double width : {1e-6, 1e-12, 1e-200}) {
    int at = 0;
    expect_same(samples(500), [&] {
      return at++ % 3 == 0 ? random_.uniform(-1, 1) : width * random_.uniform(-1, 1);
    });
  }
}

TEST_P(ClosestKernel, OfNumbersThatOverflowAndOfNone) {
  const double odd[] = {0.0,     -0.0,   1e-310, 1e160,
                        1e308,   -1e308, 1.0,    std::numeric_limits<double>::quiet_NaN(),
                        HUGE_VAL};
  expect_same(samples(500), [&] { return odd[random_.below(std::size(odd))]; });
}

INSTANTIATE_TEST_SUITE_P(Targets, ClosestKernel, ::testing::ValuesIn(all_targets()), name_of);

}  // namespace
}  // namespace ist::test
