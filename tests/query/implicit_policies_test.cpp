#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ist/query/query.h"
#include "ist/query/reference/reference_query.h"
#include "ist/tree/tree_parts.h"
#include "query/scenes.h"
#include "simd/targets.h"
#include "support/effort.h"

namespace ist::test {
namespace {

// Two bodies, asked with both implicit policies.
class Implicit {
 public:
  Implicit(const SphereTree& fixed, const SphereTree& moving, const std::string& target)
      : simple_(fixed, moving, options_of(SpherePolicy::kSimple, target)),
        table_(fixed, moving, options_of(SpherePolicy::kTable, target)),
        published_(fixed, moving, SpherePolicy::kTable) {}

  // Both find the same leaf pairs, and the published query with `table` some of them.
  void check(const Eigen::Isometry3d& pose) {
    const FoundPairs simple = ask(simple_, pose), table = ask(table_, pose);
    EXPECT_EQ(table.leaf_pairs, simple.leaf_pairs) << pose.matrix();
    const std::vector<LeafPair> published = ask(published_, pose).leaf_pairs;
    EXPECT_TRUE(std::includes(table.leaf_pairs.begin(), table.leaf_pairs.end(), published.begin(),
                              published.end()))
        << pose.matrix();
    found += table.leaf_pairs.size();
    lost_by_published += table.leaf_pairs.size() - published.size();
  }

  std::size_t found = 0, lost_by_published = 0;

 private:
  Query simple_, table_;
  ReferenceQuery published_;
};

class ImplicitPolicies : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Targets, ImplicitPolicies, ::testing::ValuesIn(all_targets()), name_of);

TEST_P(ImplicitPolicies, FindTheSameLeafPairsOfScenes) {
  std::vector<const Scene*> scenes = {&jaws(), &shells()};
  for (const Scene& scene : solids()) scenes.push_back(&scene);
  std::size_t lost = 0;
  for (const Scene* scene : scenes) {
    SCOPED_TRACE(scene->name);
    Implicit bodies(scene->fixed, scene->moving, GetParam());
    Random random(7);
    for (int i = 0; i < 6; ++i) {
      bodies.check(shift(0.05 * i * random.direction()) * scene->pose);
    }
    EXPECT_GT(bodies.found, 1000u);
    lost += bodies.lost_by_published;
  }
  EXPECT_GT(lost, 10u);  // which without nesting all would lose
}

TEST_P(ImplicitPolicies, FindTheSameLeafPairsOfRandomBodies) {
  constexpr double kCells[] = {1.5, 2, 3, 5, 9, 17, 40};
  std::size_t found = 0, lost = 0;
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{60}); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(5000 + seed);
    const TriangleMesh a = random_mesh(random), b = random_mesh(random);
    const SphereTree fixed = tree_of(a, kCells[random.below(7)]),
                     moving = tree_of(b, kCells[random.below(7)]);
    Implicit bodies(fixed, moving, GetParam());
    for (int i = 0; i < 8; ++i) {
      const Eigen::Matrix3d rotation = random.rotation();
      const double gap = random.uniform(-1, 1) * fixed.voxel_size();
      bodies.check(near_touch(a, b, rotation, gap, random));
    }
    found += bodies.found;
    lost += bodies.lost_by_published;
  }
  EXPECT_GT(found, least(10'000u, 500u));
  if (effort() >= 1) {  // few bodies may lose none
    EXPECT_GT(lost, 10u);
  }
}

SphereTree tree_of_masks(std::vector<std::vector<std::uint8_t>> masks) {
  const int depth = static_cast<int>(masks.size());
  LinearOctree octree(std::move(masks));
  const std::size_t leaves = octree.leaf_count();
  return tree_from({TreeVoxels{Lattice{{0, 0, 0}, 0.3, 1U << depth, depth}, std::move(octree),
                               std::vector<PackedNormal>(leaves)},
                    std::nullopt, Orientation::kOutward});
}

// A root of every mask, and a voxel outside it that only just touches one of its leaves: where that
// sticks out of the root's published ball, the published query does not come to it.
TEST_P(ImplicitPolicies, FindALeafOutsideThePublishedRootBall) {
  const SphereTree voxel = tree_of_masks({});
  std::size_t lost = 0;
  for (unsigned mask = 1; mask < 256; ++mask) {
    const SphereTree root = tree_of_masks({{static_cast<std::uint8_t>(mask)}});
    const std::vector<Eigen::Vector3d> leaves = root.leaf_centres();
    const Eigen::Vector3d centre =
        root.origin() + voxels_of(root).ball(SpherePolicy::kTable, 1, 0, {0, 0, 0}).centre;
    for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
      const Eigen::Vector3d out = leaves[leaf] - centre;
      if (out.norm() < 0.1 * root.voxel_size()) continue;
      const Eigen::Vector3d touching =
          leaves[leaf] + 0.999 * kSqrt3 * root.voxel_size() * out.normalized();
      const Eigen::Isometry3d pose = shift(touching - voxel.leaf_centres()[0]);
      for (const bool fixed : {true, false}) {
        Implicit bodies(fixed ? root : voxel, fixed ? voxel : root, GetParam());
        bodies.check(fixed ? pose : pose.inverse());
        EXPECT_GE(bodies.found, 1u) << "mask " << mask << ", leaf " << leaf;
        lost += bodies.lost_by_published;
      }
    }
  }
  EXPECT_GT(lost, 100u);
}

}  // namespace
}  // namespace ist::test
