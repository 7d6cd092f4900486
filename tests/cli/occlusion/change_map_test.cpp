#include "answers/comparison/change_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <variant>

#include "cli/occlusion/bites.h"

namespace ist::test {
namespace {

// A ball sinks by 0.25 over a plate: each of its vertices comes nearer to the plate by as much.
TEST(ChangeMap, OfABallOverAPlate_IsItsWay) {
  const auto before = sphere_over_plate({0, 0, 0.5}), after = sphere_over_plate({0, 0, 0.25});
  const answers::ChangeMap map = answers::change_map(before->bite, after->bite);
  std::size_t known = 0;
  for (std::size_t v = 0; v < map.moving.size(); ++v) {
    const double change = map.moving[v];
    EXPECT_EQ(std::isnan(change), std::isnan(before->bite.moving.surface.vertices[v].distance));
    if (std::isnan(change)) continue;
    EXPECT_NEAR(change, -0.25, 1e-12);
    ++known;
  }
  EXPECT_GT(known, 100U);
  EXPECT_GE(map.most(), 0.25 - 1e-12);
  EXPECT_LE(map.most(), 0.2501) << "no point of the plate comes nearer by more";
  const auto bodies = answers::change_arrays(before->bite, after->bite, map);
  ASSERT_EQ(bodies.size(), 2U);
  ASSERT_EQ(bodies[1].data.point_arrays.size(), 3U);
  EXPECT_EQ(bodies[1].data.point_arrays[2].name, "Change");
  EXPECT_EQ(std::get<std::vector<float>>(bodies[1].data.point_arrays[2].numbers).size(),
            map.moving.size());
}

TEST(ChangeMap, OfOneBite_IsZero) {
  const auto made = sphere_over_plate({0, 0, -0.1});
  EXPECT_EQ(answers::change_map(made->bite, made->bite).most(), 0);
}

}  // namespace
}  // namespace ist::test
