// Leaves alone decide: an answer equals the scalar test of leaves on all pairs of leaves, float for
// float, whatever was tested on the way down.

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "ist/query/relative_pose.h"
#include "ist/query/traversal/search.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/tree_parts.h"
#include "query/scenes.h"
#include "simd/lanes.h"
#include "simd/targets.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// The children of leaves' parents, whichever tree goes down in the last step.
SearchSide leaf_side(SearchSide side) {
  side.descends = true;
  side.emits_slots = false;
  return side;
}

// Two trees, and every engine of the fast path with one policy.
class AllPairs {
 public:
  AllPairs(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy)
      : fixed_(fixed), moving_(moving), policy_(policy), plan_(fixed, moving, policy) {
    const SearchStep& last = plan_.steps().back();
    EXPECT_TRUE(last.leaves);
    slabs_ = last.fixed.slabs != nullptr;
    fixed_side_ = leaf_side(last.fixed);
    const SearchSide side = leaf_side(last.moving);
    const auto parents = static_cast<std::uint32_t>(voxels_of(moving).octree.nodes(1).size() - 1);
    for (std::uint32_t parent = 0; parent < parents; ++parent) {
      if (lanes_.empty() || lanes_.back().count + 8 > MovingLanes::kSize) {
        lanes_.push_back({std::make_unique<MovingLanes>(), 0});
      }
      Lanes& lanes = lanes_.back();
      lanes.count += decode(side, parent, *lanes.moving, lanes.count);
    }
    for (const std::string& target : all_targets()) {
      for (const int workers : {1, 2}) {
        queries_.push_back(
            std::make_unique<Query>(fixed, moving, options_of(policy, target, workers)));
      }
    }
  }

  // The answer of every engine, and of a search with a margin by the best.
  std::size_t check(const Eigen::Isometry3d& pose, double margin) {
    const RelativePose relative =
        *relative_pose(pose, parts_of(fixed_).origin, parts_of(moving_).origin);
    const TreeLengths fixed = lengths_of(fixed_, policy_), moving = lengths_of(moving_, policy_);
    const std::vector<LeafPair> expected = by_leaves(to_float(relative, fixed, moving));
    for (const auto& query : queries_) {
      const FoundPairs found = ask(*query, pose);
      EXPECT_EQ(found.leaf_pairs, expected)
          << query->target() << " with " << query->workers() << " at\n"
          << pose.matrix();
    }
    const SearchPose wider = to_float(relative, fixed, moving, margin);
    const std::vector<LeafPair> within = by_leaves(wider);
    std::vector<LeafPair> out(within.size() + 1 + kLeafPairSpare);
    Search search(plan_, select_kernels(""), 1 << 12);
    LeafPairSink sink(plan_, select_kernels(""), out);
    PairLister lister(wider, sink);
    search.run(lister);
    out.resize(sink.count());
    EXPECT_EQ(out, within) << "margin " << margin << " at\n" << pose.matrix();
    return expected.size();
  }

 private:
  struct Lanes {
    std::unique_ptr<MovingLanes> moving;
    std::size_t count;
  };

  [[nodiscard]] std::vector<LeafPair> by_leaves(const SearchPose& pose) const {
    std::vector<LeafPair> pairs;
    const auto parents = static_cast<std::uint32_t>(voxels_of(fixed_).octree.nodes(1).size() - 1);
    auto fixed = std::make_unique<FixedLanes>();
    FixedRows rows{};
    for (std::uint32_t parent = 0; parent < parents; ++parent) {
      const std::uint32_t count = decode(fixed_side_, parent, *fixed, 0);
      for (std::uint32_t row = 0; row < count; ++row) {
        turn(pose, pose.leaf, slabs_, *fixed, row, rows);
        for (const Lanes& lanes : lanes_) {
          for (std::size_t at = 0; at < lanes.count; ++at) {
            if (!PairTest(rows, row, *lanes.moving, at, slabs_).overlap()) continue;
            pairs.push_back({fixed->id[row], lanes.moving->id[at]});
          }
        }
      }
    }
    return pairs;
  }

  const SphereTree& fixed_;
  const SphereTree& moving_;
  SpherePolicy policy_;
  SearchPlan plan_;
  SearchSide fixed_side_{};
  bool slabs_ = false;
  std::vector<Lanes> lanes_;
  std::vector<std::unique_ptr<Query>> queries_;
};

class AllPairsOf : public ::testing::TestWithParam<SpherePolicy> {};

INSTANTIATE_TEST_SUITE_P(Policies, AllPairsOf, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

TEST_P(AllPairsOf, VoxelSizesThatDiffer) {
  const TriangleMesh ball = icosphere(3, 1), block = box({-0.9, -0.7, -0.8}, {0.9, 0.7, 0.8});
  Random random(1);
  std::size_t found = 0;
  for (const double ratio : {1.0, 1.2, 1.5, 2.0, 3.0, 5.0, 8.0}) {
    for (const bool fixed_is_coarse : {false, true}) {
      SCOPED_TRACE("ratio " + std::to_string(ratio));
      const double fine = 32, coarse = fine / ratio;
      const SphereTree fixed = tree_of(ball, fixed_is_coarse ? coarse : fine),
                       moving = tree_of(block, fixed_is_coarse ? fine : coarse);
      AllPairs pairs(fixed, moving, GetParam());
      const double size = fixed.voxel_size() + moving.voxel_size();
      for (int i = 0; i < samples(3); ++i) {
        const double margin = size * (i == 0 ? 0.1 : random.uniform(0, 2));
        const Eigen::Isometry3d pose =
            near_touch(ball, block, random.rotation(), size * random.uniform(0, 3), random);
        found += pairs.check(pose, margin);
      }
    }
  }
  EXPECT_GT(found, least(10'000u, 200u));
}

// Faces on the planes of both lattices, to the last bit: many bounds touch in a point.
TEST_P(AllPairsOf, OnTheLattice) {
  const TriangleMesh a = box({0, 0, 0}, {14, 9, 5}), b = box({0, 0, 0}, {6, 12, 4});
  std::size_t found = 0;
  for (const double coarser : {1.0, 2.0}) {
    const SphereTree fixed = tree_of(a, 14), moving = tree_of(b, 12 / coarser);
    AllPairs pairs(fixed, moving, GetParam());
    Random random(2);
    for (int i = 0; i < samples(12); ++i) {
      const Eigen::Matrix3d turn = quarter_turns()[random.below(24)];
      const Eigen::Vector3d at = random.point(-6, 12);
      found += pairs.check(pose_of(turn, at.array().round()), i % 2 == 0 ? 1 : 0.5);
    }
  }
  EXPECT_GT(found, least(1'000u, 50u));
}

TEST_P(AllPairsOf, RandomBodies) {
  constexpr double kCells[] = {1, 2, 5, 9, 17, 30};
  std::size_t found = 0;
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{60}); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(3000 + seed);
    const TriangleMesh a = random_mesh(random), b = random_mesh(random);
    const SphereTree fixed = tree_of(a, kCells[random.below(6)]),
                     moving = tree_of(b, kCells[random.below(6)]);
    AllPairs pairs(fixed, moving, GetParam());
    const double size = fixed.voxel_size() + moving.voxel_size();
    for (int i = 0; i < 2; ++i) {
      found += pairs.check(near_touch(a, b, random.rotation(), size * random.uniform(0, 2), random),
                           size * random.uniform(0, 2));
    }
  }
  EXPECT_GT(found, least(4'000u, 20u));
}

// A body and a speck far from it, on a grid of 40,000 cells: the pads are a sixth of a voxel, and
// the leaves that they alone keep are many.
TEST_P(AllPairsOf, FarFromTheirFramesOrigins) {
  const TriangleMesh speck = triangle({0, 0, 0}, {0.02, 0, 0}, {0, 0.02, 0.01});
  const auto with_speck = [&](const TriangleMesh& body, const Eigen::Vector3d& away) {
    return joined(body, moved(speck, away));
  };
  const TriangleMesh a = with_speck(icosphere(2, 1), {3000, 1, 2});
  const TriangleMesh b = with_speck(box({-0.7, -0.5, -0.6}, {0.7, 0.5, 0.6}), {1, -2600, 3});
  std::size_t found = 0;
  Random random(4);
  for (const double coarser : {1.0, 3.0}) {
    const SphereTree fixed = tree_of(a, 40'000), moving = tree_of(b, 35'000 / coarser);
    ASSERT_GE(fixed.depth(), 15);
    AllPairs pairs(fixed, moving, GetParam());
    for (int i = 0; i < samples(4); ++i) {
      const Eigen::Vector3d at = random.uniform(0.9, 1.7) * random.direction();
      found += pairs.check(pose_of(random.rotation(), at), 0.05);
    }
  }
  EXPECT_GT(found, least(1'000u, 20u));
}

// Specks of one leaf or a few. The balls above hardly exceed those of the leaves, so the rounding
// of each level decides where specks part: inner nodes need more pad than leaves.
TEST_P(AllPairsOf, SpecksFarFromTheirFramesOrigins) {
  const auto speck = [](const Eigen::Vector3d& at, double size) {
    return triangle(at, at + Eigen::Vector3d(size, 0, 0),
                    at + Eigen::Vector3d(0, size, 0.5 * size));
  };
  Random random(6);
  std::size_t found = 0, apart = 0;
  for (const double size : {0.02, 0.3}) {
    const TriangleMesh a = joined(speck({0, 0, 0}, size), speck({3000, 2000, 2500}, 0.02)),
                       b = joined(speck({0, 0, 0}, size), speck({-2500, 3000, 2000}, 0.02));
    const SphereTree fixed = tree_of(a, 30'000), moving = tree_of(b, 28'000);
    AllPairs pairs(fixed, moving, GetParam());
    Query query(fixed, moving, options_of(GetParam()));
    for (int i = 0; i < samples(8); ++i) {
      const Eigen::Matrix3d rotation = random.rotation();
      const Eigen::Vector3d direction = random.direction();
      const auto pose = [&](double t) { return pose_of(rotation, t * direction); };
      const double last =
          last_touching(0, 5, [&](double t) { return ask(query, pose(t)).result.leaf_pairs > 0; });
      for (int k = 0; k < 60; ++k) {
        const std::size_t here = pairs.check(pose(last + random.uniform(-1e-3, 1e-3)), 0.01);
        found += here;
        apart += here == 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(found, least(100u, 10u));
  EXPECT_GT(apart, least(100u, 10u));
}

// What is near the last contact, and where the roots alone decide.
TEST_P(AllPairsOf, WhereTheLastContactEnds) {
  const TriangleMesh ball = icosphere(2, 1), block = box({-1, -0.7, -0.5}, {1, 0.7, 0.5});
  Random random(5);
  for (const double cells : {1.0, 2.0, 12.0}) {
    const SphereTree fixed = tree_of(ball, cells), moving = tree_of(block, cells);
    AllPairs pairs(fixed, moving, GetParam());
    Query query(fixed, moving, options_of(GetParam()));
    for (int i = 0; i < samples(3); ++i) {
      const Eigen::Matrix3d rotation = random.rotation();
      const Eigen::Vector3d direction = random.direction();
      const auto pose = [&](double t) { return pose_of(rotation, t * direction); };
      const double last = last_touching(
          0.5, 16, [&](double t) { return ask(query, pose(t)).result.leaf_pairs > 0; });
      EXPECT_GT(pairs.check(pose(last), 0.01), 0u);
      for (int ulp = -6; ulp <= 6; ++ulp) pairs.check(pose(last * (1 + ulp * 0x1p-24)), 1e-6);
    }
  }
}

}  // namespace
}  // namespace ist::test
