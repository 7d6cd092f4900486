#include <gtest/gtest.h>

#include <cmath>

#include "answers/occlusion/bite.h"
#include "cli/occlusion/bites.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using answers::teeth_of, answers::ToothLabels;

// Four triangles, six vertices: 0 2 4 / 1 3 5.
const TriangleMesh kStrip = open_strip(2);

TEST(Teeth, SumTheContactsOfTheirTriangles) {
  SurfaceOcclusion surface;
  surface.vertices.resize(6);
  for (std::size_t v = 0; v < 6; ++v) surface.vertices[v].distance = 0.1 * static_cast<double>(v);
  surface.regions.resize(2);
  surface.regions[0].triangles = {{0, 0.5, 3, 0, 8, 0.05}, {1, 0.25, 1, 0, 4, -0.5}};
  surface.regions[1].triangles = {{0, 0.125, 2, 0, 4, 0.1}, {3, 1, 2, 0, 4, 0.05}};
  const auto teeth = teeth_of(surface, kStrip, {12, 11, 13, 0});
  ASSERT_EQ(teeth.size(), 3U);
  EXPECT_EQ(teeth[0].number, 11);
  EXPECT_EQ(teeth[0].least_distance, -0.5) << "between its vertices";
  EXPECT_EQ(teeth[0].area, 0.25);
  EXPECT_EQ(teeth[0].share, 1 / 8.0);
  EXPECT_EQ(teeth[0].share_thicker, 4 / 20.0);
  EXPECT_EQ(teeth[1].number, 12);
  EXPECT_EQ(teeth[1].area, 0.625);
  EXPECT_EQ(teeth[1].share, 5 / 8.0);
  EXPECT_EQ(teeth[1].share_thinner, 0) << "that foundation is not pressed";
  EXPECT_EQ(teeth[1].least_distance, 0);
  EXPECT_EQ(teeth[2].number, 13);
  EXPECT_EQ(teeth[2].share, 0);
  std::uint32_t first = 6;
  for (const std::uint32_t v : kStrip.triangles[2]) first = std::min(first, v);
  EXPECT_EQ(teeth[2].least_distance, 0.1 * first);
}

TEST(Teeth, BeyondTheReachHaveNoDistance) {
  SurfaceOcclusion surface;
  surface.vertices.resize(6);
  for (SurfaceDistance& one : surface.vertices) one.distance = std::nan("");
  const auto teeth = teeth_of(surface, kStrip, {0, 0, 36, 36});
  ASSERT_EQ(teeth.size(), 1U);
  EXPECT_TRUE(std::isnan(teeth[0].least_distance));
  EXPECT_EQ(teeth[0].share, 0);
}

TEST(Teeth, OfABiteShareAllThatIsLabelled) {
  const auto made = sphere_over_plate({1, 0, -0.05});
  const answers::BiteBody& body = made->bite.fixed;
  ToothLabels labels;
  for (const Triangle& t : body.mesh->triangles) {
    labels.push_back(
        (body.mesh->vertices[t[0]] + body.mesh->vertices[t[1]] + body.mesh->vertices[t[2]]).x() > 3
            ? 11
            : 21);
  }
  const auto teeth = teeth_of(body.surface, *body.mesh, labels);
  ASSERT_EQ(teeth.size(), 2U);
  EXPECT_NEAR(teeth[0].share + teeth[1].share, 1, 1e-12);
  EXPECT_NEAR(teeth[0].share, 0.5, 1e-6);
  double area = 0;
  for (const ContactRegion& region : body.surface.regions) area += region.area;
  EXPECT_NEAR(teeth[0].area + teeth[1].area, area, 1e-9);
  EXPECT_EQ(std::min(teeth[0].least_distance, teeth[1].least_distance),
            body.surface.regions[0].least_distance);
}

}  // namespace
}  // namespace ist::test
