#include "ist/query/exact/triangle_bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "ist/query/exact/triangle_distance.h"
#include "query/exact/float_box.h"
#include "query/query_cases.h"
#include "simd/guarded.h"
#include "simd/targets.h"

namespace ist::test {
namespace {

TriangleCorners random_triangle(Random& random, const Eigen::Vector3d& place, double size) {
  TriangleCorners corners;
  for (Eigen::Vector3d& x : corners) {
    x = place;
    for (Eigen::Index i = 0; i < 3; ++i) x[i] += random.uniform(-size, size);
  }
  if (random.below(8) == 0) corners[2] = corners[random.below(2)];  // no area
  return corners;
}

// Some lanes, some triangles to be held against them, and all as doubles.
struct Case {
  std::vector<TriangleCorners> fixed, moving;
  TriangleLanes lanes;
  std::vector<TriangleBounds> bounds;
  std::vector<std::uint32_t> ids;

  Case(Random& random, std::size_t lane_count, std::size_t count, double size,
       const Eigen::Vector3d& origin) {
    const auto triangle = [&] { return random_triangle(random, origin, size); };
    for (std::size_t i = 0; i < lane_count; ++i) {
      fixed.push_back(triangle());
      lanes.add(bounds_of(fixed.back(), origin));
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      moving.push_back(triangle());
      bounds.push_back(bounds_of(moving.back(), origin));
      ids.push_back((i * 7 + 3) % static_cast<std::uint32_t>(count));
    }
  }

  std::vector<NearPair> ask(FindNearFunction find_near, float distance) const {
    Guarded<NearPair> out(fixed.size() * ids.size() + kNearSlack, 1);
    const std::size_t found =
        find_near(lanes, bounds.data(), ids.data(), ids.size(), distance, out.data());
    EXPECT_TRUE(out.intact());
    return {out.data(), out.data() + found};
  }
};

TEST(TriangleBounds, HoldTheirTriangle) {
  Random random(1);
  for (const double size : {1e-12, 1.0, 1e15}) {
    for (int i = 0; i < 2000; ++i) {
      const TriangleCorners t = random_triangle(random, Eigen::Vector3d::Zero(), size);
      const TriangleBounds bounds = bounds_of(t, Eigen::Vector3d::Zero());
      const Eigen::Vector3d normal(bounds.normal[0], bounds.normal[1], bounds.normal[2]);
      EXPECT_LE(normal.norm(), 1);
      for (const Eigen::Vector3d& x : t) {
        EXPECT_TRUE(holds(bounds.box, x));
        EXPECT_LE(double{bounds.bottom}, normal.dot(x));
        EXPECT_GE(double{bounds.top}, normal.dot(x));
      }
      EXPECT_LE(bounds.top - bounds.bottom, 1e-5 * size);
    }
  }
}

// What is not found is farther; much of what is farther is not found.
TEST(FindNear, LeavesOutOnlyWhatIsFarther) {
  Random random(2);
  for (const double size : {1e-12, 1.0, 1e12}) {
    for (const Eigen::Vector3d& origin : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(9, -7, 5)}) {
      std::size_t left_out = 0, farther = 0;
      for (int round = 0; round < 20; ++round) {
        const Case some(random, 40, 40, size, size * origin);
        for (const double distance : {0.0, 0.1 * size, 0.5 * size}) {
          std::vector<std::uint8_t> found(40 * 40);
          for (const NearPair& pair :
               some.ask(find_near_scalar, static_cast<float>(distance * (1 + 0x1p-20)))) {
            found[pair.lane * 40 + pair.triangle] = 1;
          }
          for (std::size_t i = 0; i < found.size(); ++i) {
            const TriangleCorners &a = some.fixed[i / 40], &b = some.moving[i % 40];
            const bool meet = triangles_meet(a, b);
            const bool is_near =
                meet || std::sqrt(ist::distance_squared(a, b)) <= distance * (1 - 1e-7);
            ASSERT_TRUE(!is_near || found[i] != 0);
            farther += !meet && std::sqrt(ist::distance_squared(a, b)) > distance ? 1U : 0U;
            left_out += found[i] == 0 ? 1U : 0U;
          }
        }
      }
      EXPECT_GT(left_out, farther / 2);
    }
  }
}

class FindNearKernel : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Targets, FindNearKernel, ::testing::ValuesIn(vector_targets()), name_of);

TEST_P(FindNearKernel, FindsWhatTheScalarFormFinds) {
  const FindNearFunction find_near = select_kernels(GetParam()).find_near;
  Random random(3);
  std::size_t all = 0;
  for (std::size_t lanes = 0; lanes <= TriangleLanes::kSize; ++lanes) {
    for (const std::size_t count : {0u, 1u, 2u, 17u}) {
      const Case some(random, lanes, count, 1, {0.3, 0.1, -0.2});
      for (const float distance : {0.0F, 0.2F, 1.0F}) {
        const auto wanted = some.ask(find_near_scalar, distance);
        const auto made = some.ask(find_near, distance);
        ASSERT_EQ(made.size(), wanted.size());
        for (std::size_t i = 0; i < made.size(); ++i) {
          ASSERT_EQ(made[i].lane, wanted[i].lane);
          ASSERT_EQ(made[i].triangle, wanted[i].triangle);
        }
        all += made.size();
      }
    }
  }
  EXPECT_GT(all, 10'000u);
}

}  // namespace
}  // namespace ist::test
