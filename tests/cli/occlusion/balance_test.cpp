#include <gtest/gtest.h>

#include "answers/occlusion/sides.h"
#include "cli/occlusion/bites.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using answers::Balance, answers::balance_of, answers::Division;
using Vector = Eigen::Vector3d;

const Division kAcross{Vector::UnitX(), 0, false, "+x", "-x"};

// Four triangles whose middles are at x = 3, 1, -1, and 0, and a contact in each.
struct Few {
  TriangleMesh mesh;
  SurfaceOcclusion surface;

  explicit Few(const std::vector<double>& pressed) {
    for (const double x : {3.0, 1.0, -1.0, 0.0}) {
      const auto at = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(), {{x - 1, 0, 0}, {x + 1, 0, 0}, {x, 3, 0}});
      mesh.triangles.push_back({at, at + 1, at + 2});
    }
    surface.regions.resize(2);
    for (std::uint32_t i = 0; i < pressed.size(); ++i) {
      // Of a thinner foundation the first triangle alone.
      surface.regions[i % 2].triangles.push_back(
          {i, 1, pressed[i], i == 0 ? pressed[i] : 0, 2 * pressed[i]});
    }
  }
  [[nodiscard]] std::optional<Balance> about(
      const Division& division,
      const Eigen::Isometry3d& to_fixed = Eigen::Isometry3d::Identity()) const {
    return balance_of(surface, mesh, to_fixed, division);
  }
};

TEST(Balance, SharesAreSumsBySideAndTheAsymmetryIsTheirDifference) {
  const auto found = Few({2, 1, 5}).about(kAcross);
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->shares.first, 100 * 3 / 8.0);
  EXPECT_DOUBLE_EQ(found->shares.second, 100 * 5 / 8.0);
  EXPECT_DOUBLE_EQ(found->shares.asymmetry, 100 * 2 / 8.0);
  EXPECT_DOUBLE_EQ(found->thinner.first, 100);
  EXPECT_DOUBLE_EQ(found->thinner.asymmetry, 100);
  EXPECT_DOUBLE_EQ(found->thicker.second, 100 * 5 / 8.0);
  EXPECT_TRUE(found->centre.isApprox(Vector((2 * 3 + 1 - 5) / 8.0, 1, 0)));
}

TEST(Balance, ATriangleOnThePlaneIsHalfOnEachSide) {
  const auto found = Few({0, 3, 3, 4}).about(kAcross);
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->shares.first, 50);
  EXPECT_DOUBLE_EQ(found->shares.asymmetry, 0);
  EXPECT_DOUBLE_EQ(found->thinner.first + found->thinner.second, 0);  // it is not pressed
}

TEST(Balance, CountsInFixedCoordinatesFromThePlane) {
  Eigen::Isometry3d to_fixed(Eigen::AngleAxisd(std::acos(-1.0), Vector::UnitZ()));
  to_fixed.translation() = Vector(0, 0, 7);
  const Few few({2, 1, 5});
  EXPECT_DOUBLE_EQ(few.about(kAcross, to_fixed)->shares.first, 100 * 5 / 8.0);
  EXPECT_TRUE(few.about(kAcross, to_fixed)->centre.isApprox(Vector(-0.25, -1, 7)));
  const Division beyond{Vector::UnitX(), 2, false, "a", "b"};
  EXPECT_DOUBLE_EQ(few.about(beyond)->shares.first, 25);
}

TEST(Balance, NothingIsWhereNothingIsPressed) {
  EXPECT_FALSE(Few({}).about(kAcross));
  EXPECT_FALSE(Few({0, 0, 0}).about(kAcross));
}

TEST(Balance, OfASphereOnAPlateIsEvenAndMovesWithTheSphere) {
  const auto even = sphere_over_plate({0, 0, -0.05});
  ASSERT_TRUE(even->bite.fixed.sides && even->bite.moving.sides);
  EXPECT_NEAR(even->bite.fixed.sides->shares.first, 50, 1e-6);
  EXPECT_NEAR(even->bite.fixed.fore_aft->shares.first, 50, 1e-6);
  EXPECT_NEAR(even->bite.moving.sides->shares.first, 50, 1e-6);
  EXPECT_LT(even->bite.fixed.sides->centre.norm(), 1e-2);
  const auto aside = sphere_over_plate({0.5, 0, -0.05});
  EXPECT_GT(aside->bite.fixed.sides->shares.first, 65);
  EXPECT_GT(aside->bite.moving.sides->shares.first, 65);
  EXPECT_NEAR(aside->bite.fixed.fore_aft->shares.first, 50, 1e-6);
  EXPECT_NEAR(aside->bite.fixed.sides->centre.x(), 0.5, 0.02);
  const auto beyond = sphere_over_plate({-5, 3, -0.05});
  EXPECT_EQ(beyond->bite.fixed.sides->shares.first, 0);
  EXPECT_EQ(beyond->bite.fixed.sides->shares.asymmetry, 100);
  EXPECT_EQ(beyond->bite.moving.fore_aft->shares.first, 100);
}

}  // namespace
}  // namespace ist::test
