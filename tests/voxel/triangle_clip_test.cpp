#include "ist/voxel/triangle_clip.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <vector>

#include "ist/voxel/morton.h"
#include "support/effort.h"
#include "support/exact.h"
#include "support/random.h"

namespace ist {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

std::vector<Eigen::Vector3d> corners_of(const ClippedTriangle& polygon) {
  return {polygon.corners.begin(), polygon.corners.begin() + polygon.count};
}

double nearest(const Eigen::Vector3d& to, const std::vector<Eigen::Vector3d>& points) {
  double distance = HUGE_VAL;
  for (const Eigen::Vector3d& p : points) distance = std::min(distance, (p - to).norm());
  return distance;
}

// Each corner of the one is a corner of the other, or nearly.
void expect_the_exact_clip(const Corners& triangle, const Eigen::Vector3d& low,
                           const Eigen::Vector3d& high, double tolerance) {
  ClippedTriangle clipped;
  clip_triangle(triangle, low, high, clipped);
  const std::vector<Eigen::Vector3d> found = corners_of(clipped);
  const test::ExactPolygon exact = test::exact_triangle(triangle);
  const test::ExactBox box{test::exact(low), test::exact(high)};
  std::vector<Eigen::Vector3d> expected;
  for (const test::ExactPoint& p : test::clip(exact, box)) {
    expected.emplace_back(p[0].get_d(), p[1].get_d(), p[2].get_d());
  }
  if (found.empty() != expected.empty()) {  // right only where they do no more than touch
    const mpq_class hair = found.empty() ? -1e-14 : 1e-14;
    EXPECT_EQ(test::clip(exact, test::grown(box, hair)).empty(), found.empty());
    return;
  }
  for (const Eigen::Vector3d& p : found) EXPECT_LE(nearest(p, expected), tolerance);
  for (const Eigen::Vector3d& p : expected) EXPECT_LE(nearest(p, found), tolerance);
  for (const Eigen::Vector3d& p : found) {
    EXPECT_TRUE((p.array() >= low.array() - tolerance).all());
    EXPECT_TRUE((p.array() <= high.array() + tolerance).all());
  }
}

TEST(ClipTriangle, LeavesTheCornersOfTheExactClip) {
  test::Random random(1);
  for (int i = 0; i < test::samples(3000); ++i) {
    const double size = i % 2 == 0 ? 1 : 4;
    const Corners triangle{random.point(-size, size), random.point(-size, size),
                           random.point(-size, size)};
    expect_the_exact_clip(triangle, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, 1e-11);
  }
}

TEST(ClipTriangle, CutsCornersAndEdgesThatLieOnThePlanesOfTheBox) {
  test::Random random(2);
  for (int i = 0; i < test::samples(3000); ++i) {
    const Corners triangle{random.point_on_grid(-2, 3, 0.5), random.point_on_grid(-2, 3, 0.5),
                           random.point_on_grid(-2, 3, 0.5)};
    expect_the_exact_clip(triangle, {0, 0, 0}, {1, 1, 1}, 1e-14);
  }
}

TEST(ClipTriangle, KeepsTheTurnAndTheAreas) {
  test::Random random(3);
  for (int i = 0; i < test::samples(1000); ++i) {
    const Corners triangle{random.point(-2, 2), random.point(-2, 2), random.point(-2, 2)};
    ClippedTriangle clipped;
    clip_triangle(triangle, {-1, -1, -1}, {1, 1, 1}, clipped);
    if (clipped.count == 0) continue;
    const test::ExactPolygon exact = test::clip(
        test::exact_triangle(triangle),
        {test::exact(Eigen::Vector3d(-1, -1, -1)), test::exact(Eigen::Vector3d(1, 1, 1))});
    test::ExactPoint twice_area{};  // of the exact piece, as a vector
    for (std::size_t k = 2; k < exact.size(); ++k) {
      twice_area = twice_area + test::cross(exact[k - 1] - exact[0], exact[k] - exact[0]);
    }
    Eigen::Vector3d found = Eigen::Vector3d::Zero();
    const auto corners = corners_of(clipped);
    for (std::size_t k = 2; k < corners.size(); ++k) {
      found += (corners[k - 1] - corners[0]).cross(corners[k] - corners[0]);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double expected = twice_area[static_cast<std::size_t>(axis)].get_d();
      EXPECT_NEAR(found[axis], expected, 1e-12);
      EXPECT_NEAR(clipped.projected_area(axis), std::abs(expected) / 2, 1e-12);
    }
  }
}

TEST(ClipTriangle, TakesPointsAndSegments) {
  const Eigen::Vector3d low(0, 0, 0), high(1, 1, 1), inside(0.5, 0.5, 0.5), outside(2, 0.5, 0.5);
  expect_the_exact_clip({inside, inside, inside}, low, high, 0);
  expect_the_exact_clip({outside, outside, outside}, low, high, 0);
  expect_the_exact_clip({inside, outside, outside}, low, high, 0);
  expect_the_exact_clip({outside, inside, outside}, low, high, 0);
  expect_the_exact_clip({high, high, outside}, low, high, 0);
  expect_the_exact_clip({Eigen::Vector3d(1, 0, 0), {1, 1, 0}, {1, 1, 1}}, low, high, 0);
}

TEST(ClipTriangle, NeverLeavesMoreCornersThanThereIsRoomFor) {
  test::Random random(4);
  int most = 0;
  for (int i = 0; i < test::samples(200'000); ++i) {
    // Slivers along the planes of the box are where rounding adds corners.
    Corners triangle{random.point(-2, 2), random.point(-2, 2), random.point(-2, 2)};
    if (i % 2 == 0) triangle[2] = triangle[0] + random.uniform(0, 1) * (triangle[1] - triangle[0]);
    if (i % 3 == 0) {
      for (Eigen::Vector3d& p : triangle) p[0] = 1 + random.uniform(-4e-16, 4e-16);
    }
    ClippedTriangle clipped;
    clip_triangle(triangle, {-1, -1, -1}, {1, 1, 1}, clipped);
    ASSERT_GE(clipped.count, 0);
    ASSERT_LE(clipped.count, ClippedTriangle::kMaxCorners);
    for (const Eigen::Vector3d& p : corners_of(clipped)) ASSERT_TRUE(p.allFinite());
    most = std::max(most, clipped.count);
  }
  // One in some thousand triangles has nine corners: six planes cut it.
  EXPECT_GE(most, test::effort() < 1 ? 8 : 9);
}

TEST(TriangleSlicer, GivesWhatClippingTheWholeTriangleGives) {
  test::Random random(5);
  for (int i = 0; i < test::samples(300); ++i) {
    const Corners triangle{random.point(0, 6), random.point(0, 6), random.point(0, 6)};
    const double pad = i % 2 == 0 ? 0 : 1e-3;
    TriangleSlicer slicer(triangle, pad);
    for (int call = 0; call < 100; ++call) {
      // In order of z, y, x at first, then anyhow: the answer must not depend on it.
      const auto n = static_cast<std::uint32_t>(call);
      const Cell cell = call < 50 ? Cell{n % 4, n / 4 % 4, n / 16}
                                  : Cell{random.below(6), random.below(6), random.below(6)};
      const Eigen::Vector3d low(cell[0], cell[1], cell[2]);
      const std::vector<Eigen::Vector3d> sliced =
          corners_of(slicer.cube(cell[0], cell[1], cell[2]));
      ClippedTriangle whole;
      clip_triangle(triangle, low.array() - pad, low.array() + (1 + pad), whole);
      const std::vector<Eigen::Vector3d> expected = corners_of(whole);
      ASSERT_EQ(sliced.empty(), expected.empty());
      for (const Eigen::Vector3d& p : sliced) EXPECT_LE(nearest(p, expected), 1e-12);
      for (const Eigen::Vector3d& p : expected) EXPECT_LE(nearest(p, sliced), 1e-12);
    }
  }
}

}  // namespace
}  // namespace ist
