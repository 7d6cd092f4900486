#include "support/conformal.h"

#include <gtest/gtest.h>

#include "ist/query/inside.h"
#include "ist/query/query.h"
#include "ist/tree/sphere_tree.h"

namespace ist::test {
namespace {

constexpr double kVoxelSize = 0.25;

SphereTree triangle_tree_of(const TriangleMesh& mesh) {
  BuildOptions options;
  options.voxel_size = kVoxelSize;
  options.keep_triangles = true;
  BuildReport report;
  SphereTree tree = build_tree(mesh, options, &report);
  EXPECT_EQ(report.turned_components, 0u);
  return tree;
}

// Where surfaces lie along each other there is most to find, and the answer is as certain.
TEST(Conformal, TheGapIsKnownAtAnyTime) {
  for (const ConformalPair& pair : conformal_pairs(3, 4, 0.3)) {
    SCOPED_TRACE(pair.name);
    const SphereTree fixed = triangle_tree_of(pair.fixed), moving = triangle_tree_of(pair.moving);
    Query query(fixed, moving);
    const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    const DistanceResult gap = query.distance(pose, 0);
    EXPECT_NEAR(gap.distance.lower, pair.gap, 0.01 * pair.gap);
    EXPECT_NEAR(gap.distance.upper, pair.gap, 0.01 * pair.gap);
    EXPECT_EQ(query.intersects(pose).answer, ist::Answer::kNo);
    EXPECT_EQ(InsideTest(pair.fixed, pair.moving).at(pose),
              pair.name == "shells" || pair.name == "inside" ? Inside::kMoving : Inside::kNone);
    std::vector<LeafPair> leaf_pairs(1 << 20);
    for (const std::uint64_t tests : {1u, 100u, 10'000u, 100'000'000u}) {
      const QueryResult result = query.leaf_pairs(pose, leaf_pairs, {.tests = tests});
      EXPECT_LE(result.distance->lower, 1.01 * pair.gap);
      EXPECT_GE(result.distance->upper, 0.99 * pair.gap);
    }
  }
}

}  // namespace
}  // namespace ist::test
