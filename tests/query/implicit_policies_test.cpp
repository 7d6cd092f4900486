#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "ist/query/query.h"
#include "ist/query/reference/reference_query.h"
#include "query/scenes.h"
#include "simd/targets.h"

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
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(5000 + seed);
    const TriangleMesh a = random_mesh(random), b = random_mesh(random);
    const SphereTree fixed = tree_of(a, kCells[random.below(7)]),
                     moving = tree_of(b, kCells[random.below(7)]);
    Implicit bodies(fixed, moving, GetParam());
    for (int i = 0; i < 8; ++i) {
      const Eigen::Matrix3d rotation = random.rotation();
      const Eigen::Vector3d on_a = a.vertices[random.below(a.vertices.size())];
      const Eigen::Vector3d on_b = b.vertices[random.below(b.vertices.size())];
      const double gap = random.uniform(-1, 1) * fixed.voxel_size();
      bodies.check(pose_of(rotation, on_a - rotation * on_b + gap * random.direction()));
    }
    found += bodies.found;
    lost += bodies.lost_by_published;
  }
  EXPECT_GT(found, 10'000u);
  EXPECT_GT(lost, 10u);
}

}  // namespace
}  // namespace ist::test
