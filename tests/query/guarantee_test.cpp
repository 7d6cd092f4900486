#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "ist/query/reference/reference_query.h"
#include "ist/query/relative_pose.h"
#include "ist/query/traversal/search.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/tree_parts.h"
#include "query/scenes.h"
#include "simd/targets.h"
#include "support/exact_query.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// Two bodies, what is true of them, and every engine with one policy.
class Judged {
 public:
  Judged(const TriangleMesh& a, double cells_a, const TriangleMesh& b, double cells_b,
         SpherePolicy policy)
      : policy_(policy),
        bodies_(a, tree_of(a, cells_a), b, tree_of(b, cells_b)),
        reference_(fixed(), moving(), policy) {
    for (const std::string& target : all_targets()) {
      engines_.push_back(std::make_unique<Query>(fixed(), moving(), options_of(policy, target)));
    }
  }

  // How many contacts there are. All targets give one answer, and it and the reference's keep the
  // guarantee.
  std::size_t check(const Eigen::Isometry3d& pose) {
    const FoundPairs answer = ask(*engines_.front(), pose);
    EXPECT_EQ(answer.result.status, QueryStatus::kDone);
    EXPECT_TRUE(answer.result.complete);
    EXPECT_EQ(answer.result.level, 0);
    for (const auto& engine : engines_) {
      EXPECT_TRUE(same(ask(*engine, pose), answer)) << engine->target();
    }
    const ExactPair exact = this->exact(pose);
    EXPECT_TRUE(keeps_guarantee(exact, policy_, answer.leaf_pairs, answer.result.pad))
        << "pose\n"
        << pose.matrix();
    const FoundPairs reference = ask(reference_, pose);
    EXPECT_TRUE(keeps_guarantee(exact, policy_, reference.leaf_pairs, reference.result.pad,
                                published_are_nested(policy_)))
        << "the reference at pose\n"
        << pose.matrix();
    for (const double margin : {0.375 * fixed().voxel_size(), 2 * moving().voxel_size()}) {
      check_within(exact, pose, margin);
    }
    return answer.leaf_pairs.size();
  }

  [[nodiscard]] const SphereTree& fixed() const { return bodies_.fixed; }
  [[nodiscard]] const SphereTree& moving() const { return bodies_.moving; }
  [[nodiscard]] Query& query() { return *engines_.front(); }
  [[nodiscard]] ReferenceQuery& reference() { return reference_; }
  [[nodiscard]] ExactPair exact(const Eigen::Isometry3d& pose) const { return bodies_.at(pose); }

 private:
  // A search with a margin, as contacts make it.
  void check_within(const ExactPair& exact, const Eigen::Isometry3d& pose, double margin) const {
    const SearchPlan plan(fixed(), moving(), policy_);
    Search search(plan, select_kernels(""), 1 << 12);
    const SearchPose from =
        to_float(*relative_pose(pose, fixed().parts().lattice, moving().parts().lattice),
                 lengths_of(fixed(), policy_), lengths_of(moving(), policy_), margin);
    std::vector<LeafPair> found(std::size_t{fixed().leaf_count()} * moving().leaf_count() +
                                kLeafPairSpare);
    LeafPairSink sink(plan, select_kernels(""), found);
    PairLister lister(from, sink);
    search.run(lister);
    found.resize(sink.count());
    const double pad = policy_ == SpherePolicy::kSlab ? from.leaf.slab_fixed : from.leaf.ball;
    EXPECT_TRUE(keeps_guarantee(exact, policy_, found, 2 * pad - margin, true, margin))
        << "margin " << margin << " at pose\n"
        << pose.matrix();
  }

  SpherePolicy policy_;
  RationalBodies bodies_;
  ReferenceQuery reference_;
  std::vector<std::unique_ptr<Query>> engines_;
};

class Guarantee : public ::testing::TestWithParam<SpherePolicy> {};

INSTANTIATE_TEST_SUITE_P(Policies, Guarantee, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

// In any rotation, up to `gap` apart or in each other.
Eigen::Isometry3d near_touch_within(const TriangleMesh& a, const TriangleMesh& b, double gap,
                                    Random& random) {
  const Eigen::Matrix3d rotation = random.rotation();
  const double apart = random.uniform(-gap, gap);
  return near_touch(a, b, rotation, apart, random);
}

TEST_P(Guarantee, IsKeptForRandomBodiesNearTouching) {
  constexpr double kCells[] = {1, 1.5, 2, 3, 5, 9, 13};
  std::size_t touching = 0, free = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(1000 + seed);
    const TriangleMesh a = random_mesh(random), b = random_mesh(random);
    Judged bodies(a, kCells[random.below(7)], b, kCells[random.below(7)], GetParam());
    for (int i = 0; i < 6; ++i) {
      const double gap = bodies.fixed().voxel_size();
      (bodies.check(near_touch_within(a, b, gap, random)) > 0 ? touching : free) += 1;
    }
  }
  EXPECT_GT(touching, 100u);
  EXPECT_GT(free, 5u);
}

// Voxels that are up to a hundred times as large in one body as in the other.
TEST_P(Guarantee, IsKeptForVoxelSizesThatDiffer) {
  for (const double ratio : {1.0, 1.3, 2.0, 3.0, 8.0, 100.0}) {
    for (const bool fixed_is_coarse : {false, true}) {
      SCOPED_TRACE("ratio " + std::to_string(ratio));
      const TriangleMesh coarse = icosphere(1, ratio), fine = box({-1, -0.7, -0.5}, {1, 0.7, 0.5});
      const TriangleMesh &a = fixed_is_coarse ? coarse : fine, &b = fixed_is_coarse ? fine : coarse;
      Judged bodies(a, 6, b, 6, GetParam());
      const double sizes[] = {bodies.fixed().voxel_size(), bodies.moving().voxel_size()};
      EXPECT_NEAR(fixed_is_coarse ? sizes[0] / sizes[1] : sizes[1] / sizes[0], ratio, 0.2 * ratio);
      Random random(static_cast<std::uint64_t>(10 * ratio));
      std::size_t leaf_pairs = 0;
      for (int i = 0; i < 6; ++i) leaf_pairs += bodies.check(near_touch_within(a, b, 0.2, random));
      EXPECT_GT(leaf_pairs, 0u);
    }
  }
}

// Cubes that touch by faces, edges and corners, exactly.
TEST_P(Guarantee, IsKeptOnTheLattice) {
  Judged bodies(box({0, 0, 0}, {4, 3, 2}), 4, box({0, 0, 0}, {3, 2, 3}), 3, GetParam());
  Judged coarse(box({0, 0, 0}, {4, 4, 4}), 4, box({0, 0, 0}, {4, 2, 4}), 2, GetParam());
  std::size_t leaf_pairs = 0;
  for (const Eigen::Matrix3d& turn : quarter_turns()) {
    for (const double x : {-3.0, 0.0, 4.0}) {
      for (const double y : {-2.0, 3.0, 5.0}) {
        for (const double z : {-3.0, 2.0}) {
          leaf_pairs +=
              bodies.check(pose_of(turn, {x, y, z})) + coarse.check(pose_of(turn, {x, z, y}));
        }
      }
    }
  }
  EXPECT_GT(leaf_pairs, 1000u);
}

// A corner of one leaf's cube on a corner of another's, to the last bit of a double: what a test
// without a pad would lose in every second case.
TEST_P(Guarantee, IsKeptWhereCornersMeet) {
  const std::vector<Eigen::Matrix3d> turns = quarter_turns();
  std::size_t leaf_pairs = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(2000 + seed);
    const auto cube = [&random] {
      const Eigen::Vector3d corner = random.point(-9, 9);
      return box(corner, corner + Eigen::Vector3d::Constant(random.uniform(0.5, 3)));
    };
    Judged bodies(cube(), 1 + static_cast<double>(random.below(6)), cube(),
                  1 + static_cast<double>(random.below(6)), GetParam());
    const auto corner = [&random](const Lattice& lattice, int k) {
      Eigen::Vector3d at;
      for (Eigen::Index i = 0; i < 3; ++i) {
        at[i] = lattice.corner[static_cast<std::size_t>(i)] +
                ((k >> i & 1) != 0 ? lattice.voxel_size * lattice.cells : 0);
      }
      return at;
    };
    for (int k = 0; k < 8; ++k) {
      const Eigen::Matrix3d& turn = turns[random.below(turns.size())];
      // The opposite corner of the moving cube, as it is turned.
      const Eigen::Vector3d outward((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1,
                                    (k & 4) != 0 ? 1 : -1);
      const Eigen::Vector3d inward = -(turn.transpose() * outward);
      int opposite = 0;
      for (int i = 0; i < 3; ++i) opposite |= inward[i] > 0 ? 1 << i : 0;
      leaf_pairs +=
          bodies.check(pose_of(turn, corner(bodies.fixed().parts().lattice, k) -
                                         turn * corner(bodies.moving().parts().lattice, opposite)));
    }
  }
  EXPECT_GT(leaf_pairs, is_implicit(GetParam()) ? 300u : 0u);
}

// Moved apart until the answer is empty, and some last bits of a float to either side of that.
TEST_P(Guarantee, IsKeptWhereTheLastContactEnds) {
  for (const double cells : {1.0, 4.0}) {
    const TriangleMesh a = moved(icosphere(1, 1), {3, -5, 1});
    const TriangleMesh b = triangle({0, 0, 0}, {1, 0.25, 0}, {0.5, 1, 0.5});
    Judged bodies(a, cells, b, 2 * cells, GetParam());
    Random random(3);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Matrix3d rotation = random.rotation();
      const auto pose = [&](double t) {
        Eigen::Vector3d at(2.3, -5.4, 0.8);
        at[axis] += t;
        return pose_of(rotation, at);
      };
      const double last = last_touching(
          0, 16, [&](double t) { return ask(bodies.query(), pose(t)).result.leaf_pairs > 0; });
      EXPECT_GT(bodies.check(pose(last)), 0u);
      for (int ulp = 1; ulp <= 8; ++ulp) {
        bodies.check(pose(last * (1 - ulp * 0x1p-24)));
        bodies.check(pose(last * (1 + ulp * 0x1p-24)));
      }
    }
  }
}

// A bent square of two triangles, by the origin, so that a pose's last bit is a small step.
TriangleMesh plate(Random& random) {
  const double bend = random.uniform(0.001, 0.3);
  const auto corner = [&](double x, double y) {
    return Eigen::Vector3d(x, y, random.uniform(-bend, bend));
  };
  TriangleMesh mesh;
  mesh.vertices = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// Two leaves that are roots, whose balls go on overlapping where a ball leaves the other's slab.
TEST(GuaranteeOfOneVoxel, IsKeptWhereSlabsAlonePart) {
  constexpr SpherePolicy kSlab = SpherePolicy::kSlab;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(4000 + seed);
    const TriangleMesh a = plate(random), b = plate(random);
    Judged bodies(a, 0.9, b, 0.9, kSlab);
    const SphereTree &fixed = bodies.fixed(), &moving = bodies.moving();
    ASSERT_EQ(fixed.parts().octree.node_count() + moving.parts().octree.node_count(), 2u);
    Query balls(fixed, moving, options_of(SpherePolicy::kTight));

    // Out of one of the slabs along its normal, from where the balls' centres are one.
    const Eigen::Matrix3d rotation = random.rotation();
    const Eigen::Vector3d centre = fixed.origin() + fixed.parts().saved_ball(0, 0, 0).centre;
    const Eigen::Vector3d moving_centre =
        moving.origin() + moving.parts().saved_ball(0, 0, 0).centre;
    const Eigen::Vector3d normal = seed % 2 == 0
                                       ? fixed.parts().saved_slab(0, 0, 0).normal
                                       : rotation * moving.parts().saved_slab(0, 0, 0).normal;
    const auto pose = [&](double gap) {
      return pose_of(rotation, centre - rotation * moving_centre + gap * normal);
    };
    const double last = last_touching(
        0, 4, [&](double gap) { return bodies.exact(pose(gap)).bounds_meet(kSlab, 0, 0, 0); });
    const auto last_of = [&](auto& query) {
      return last_touching(0, 4,
                           [&](double gap) { return ask(query, pose(gap)).result.leaf_pairs > 0; });
    };
    const double last_answered = last_of(bodies.query());
    EXPECT_GE(last_answered, last);
    EXPECT_GE(last_of(bodies.reference()), last);
    EXPECT_EQ(bodies.check(pose(last)), 1u);
    EXPECT_EQ(bodies.check(pose(last_answered)), 1u);
    const double first_apart = std::nextafter(last_answered, 4);
    EXPECT_EQ(bodies.check(pose(first_apart)), 0u);
    EXPECT_EQ(ask(balls, pose(first_apart)).result.leaf_pairs, 1u) << "the balls part too";
    for (int ulp = 1; ulp <= 8; ++ulp) {
      EXPECT_EQ(bodies.check(pose(last * (1 - ulp * 0x1p-24))), 1u);
      bodies.check(pose(last * (1 + ulp * 0x1p-24)));
      bodies.check(pose(last_answered * (1 - ulp * 0x1p-24)));
      EXPECT_EQ(bodies.check(pose(last_answered * (1 + ulp * 0x1p-24))), 0u);
    }
  }
}

TEST_P(Guarantee, IsKeptWhereOneIsInsideTheOther) {
  Judged bodies(icosphere(2, 4), 15, icosphere(1, 1), 8, GetParam());
  EXPECT_EQ(bodies.check(Eigen::Isometry3d::Identity()), 0u);
  EXPECT_GT(bodies.check(shift({3, 0, 0})), 0u);
}

}  // namespace
}  // namespace ist::test
