#include "answers/occlusion/map_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "cli/occlusion/bites.h"

namespace ist::test {
namespace {

using answers::map_statistics;

// A flat plate of 20 × 20 units, whose numbers are x: they are distributed evenly from -10 to 10.
TEST(MapStatistics, OfEvenNumbers_AreInClosedForm) {
  const auto made = sphere_over_plate({0, 0, 0.5});
  const answers::BiteBody& body = made->bite.fixed;
  std::vector<double> map;
  for (const Eigen::Vector3d& vertex : body.mesh->vertices) map.push_back(vertex.x());
  const auto found = map_statistics(body, map, 1, {});
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->area, 400, 1e-9);
  EXPECT_NEAR(found->mean, 0, 1e-9);
  EXPECT_NEAR(found->deviation, 20 / std::sqrt(12), 0.01);
  EXPECT_NEAR(found->root_mean_square, found->deviation, 1e-9);
  EXPECT_EQ(found->least, -10);
  EXPECT_EQ(found->most, 10);
  for (std::size_t i = 0; i < answers::kPercentiles.size(); ++i) {
    EXPECT_NEAR(found->percentiles[i], -10 + 0.2 * answers::kPercentiles[i], 0.26);
  }
  EXPECT_EQ(found->from, -10);
  ASSERT_EQ(found->histogram.size(), 21U) << "the last bin holds 10 alone";
  EXPECT_NEAR(found->histogram[10], 20, 0.1);
  EXPECT_NEAR(std::accumulate(found->histogram.begin(), found->histogram.end(), 0.0), 400, 1e-9);
  const Eigen::AlignedBox3d right(Eigen::Vector3d(0, -99, -1), Eigen::Vector3d(99, 99, 1));
  const auto half = map_statistics(body, map, 1, right);
  EXPECT_NEAR(half->area, 200, 1e-9);
  EXPECT_NEAR(half->mean, 5, 0.05);
}

TEST(MapStatistics, LeaveOutUnknownNumbers) {
  const auto made = sphere_over_plate({0, 0, 0.5});
  const answers::BiteBody& body = made->bite.fixed;
  std::vector<double> map(body.mesh->vertices.size(), std::nan(""));
  EXPECT_FALSE(map_statistics(body, map, 1, {}).has_value());
  for (const std::uint32_t v : body.mesh->triangles[7]) map[v] = 3;
  const auto found = map_statistics(body, map, 1, {});
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->area, 0.5 * 0.25 * 0.25, 1e-12);
  EXPECT_EQ(found->mean, 3);
  EXPECT_EQ(found->deviation, 0);
  for (const double percentile : found->percentiles) EXPECT_EQ(percentile, 3);
}

}  // namespace
}  // namespace ist::test
