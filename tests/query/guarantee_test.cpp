#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "ist/query/relative_pose.h"
#include "ist/query/traversal/search.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/tree_parts.h"
#include "query/engines.h"
#include "support/effort.h"
#include "support/exact_query.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// Two bodies, what is true of them, and an engine: the fast one on every target.
class Judged {
 public:
  Judged(const TriangleMesh& a, double cells_a, const TriangleMesh& b, double cells_b,
         const Engine& engine)
      : engine_(engine), bodies_(a, tree_of(a, cells_a), b, tree_of(b, cells_b)) {
    Engine on = engine;
    for (const std::string& target :
         engine.published ? std::vector{engine.target} : all_targets()) {
      on.target = target;
      queries_.emplace_back(fixed(), moving(), on);
    }
  }

  // How many leaf pairs there are. All targets give one answer, and it keeps the guarantee.
  std::size_t check(const Eigen::Isometry3d& pose) {
    const FoundPairs answer = ask(query(), pose);
    EXPECT_EQ(answer.result.status, QueryStatus::kDone);
    EXPECT_TRUE(answer.result.complete);
    EXPECT_EQ(answer.result.level, 0);
    for (std::size_t i = 1; i < queries_.size(); ++i) {
      EXPECT_TRUE(same(ask(queries_[i], pose), answer)) << all_targets()[i];
    }
    const ExactPair exact = this->exact(pose);
    EXPECT_TRUE(keeps_guarantee(exact, engine_.policy, answer.leaf_pairs, answer.result.pad,
                                engine_.nested()))
        << "pose\n"
        << pose.matrix();
    for (const double margin : {0.375 * fixed().voxel_size(), 2 * moving().voxel_size()}) {
      if (!engine_.published) check_within(exact, pose, margin);
    }
    return answer.leaf_pairs.size();
  }

  [[nodiscard]] const SphereTree& fixed() const { return bodies_.fixed; }
  [[nodiscard]] const SphereTree& moving() const { return bodies_.moving; }
  [[nodiscard]] EngineQuery& query() { return queries_.front(); }
  [[nodiscard]] ExactPair exact(const Eigen::Isometry3d& pose) const { return bodies_.at(pose); }

 private:
  // A search with a margin, as contacts make it.
  void check_within(const ExactPair& exact, const Eigen::Isometry3d& pose, double margin) const {
    const SpherePolicy policy = engine_.policy;
    const SearchPlan plan(fixed(), moving(), policy);
    Search search(plan, select_kernels(""), 1 << 12);
    const SearchPose from =
        to_float(*relative_pose(pose, parts_of(fixed()).origin, parts_of(moving()).origin),
                 lengths_of(fixed(), policy), lengths_of(moving(), policy), margin);
    std::vector<LeafPair> found(std::size_t{fixed().leaf_count()} * moving().leaf_count() +
                                kLeafPairSpare);
    LeafPairSink sink(plan, select_kernels(""), found);
    PairLister lister(from, sink);
    search.run(lister);
    found.resize(sink.count());
    const double pad = policy == SpherePolicy::kSlab ? from.leaf.slab_fixed : from.leaf.ball;
    EXPECT_TRUE(keeps_guarantee(exact, policy, found, 2 * pad - margin, true, margin))
        << "margin " << margin << " at pose\n"
        << pose.matrix();
  }

  Engine engine_;
  RationalBodies bodies_;
  std::vector<EngineQuery> queries_;
};

class Guarantee : public ::testing::TestWithParam<Engine> {};

INSTANTIATE_TEST_SUITE_P(Engines, Guarantee, ::testing::ValuesIn(engines_of({""})), engine_name);

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
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{40}); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(1000 + seed);
    const TriangleMesh a = random_mesh(random), b = random_mesh(random);
    Judged bodies(a, kCells[random.below(7)], b, kCells[random.below(7)], GetParam());
    for (int i = 0; i < 6; ++i) {
      const double gap = bodies.fixed().voxel_size();
      (bodies.check(near_touch_within(a, b, gap, random)) > 0 ? touching : free) += 1;
    }
  }
  EXPECT_GT(touching, samples(50u));
  if (effort() >= 1) {  // of few, none may be free
    EXPECT_GT(free, 5u);
  }
}

// Voxels that are up to a hundred times as large in one body as in the other.
TEST_P(Guarantee, IsKeptForVoxelSizesThatDiffer) {
  IST_SLOW();
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
      for (int i = 0; i < samples(6); ++i) {
        leaf_pairs += bodies.check(near_touch_within(a, b, 0.2, random));
      }
      if (effort() >= 1) {  // few poses may all be apart
        EXPECT_GT(leaf_pairs, 0u);
      }
    }
  }
}

// Bodies of one size, and up to seven of the one's voxels along a voxel of the other.
TEST_P(Guarantee, IsKeptForCoarseVoxelsBesideFineOnes) {
  IST_SLOW();
  const TriangleMesh ball = icosphere(1, 1), block = box({-1, -0.7, -0.5}, {1, 0.7, 0.5});
  for (const double ratio : {1.0, 1.3, 2.0, 7.0}) {
    for (const auto& [cells_a, cells_b] : {std::pair{10.0, 10 / ratio}, {10 / ratio, 10.0}}) {
      SCOPED_TRACE("ratio " + std::to_string(ratio));
      Judged bodies(ball, cells_a, block, cells_b, GetParam());
      Random random(static_cast<std::uint64_t>(10 * ratio));
      std::size_t leaf_pairs = 0;
      for (int i = 0; i < samples(4); ++i) {
        const Eigen::Matrix3d rotation = random.rotation();
        leaf_pairs += bodies.check(pose_of(rotation, random.uniform(1, 2) * random.direction()));
      }
      if (effort() >= 1) {  // few poses may all be apart
        EXPECT_GT(leaf_pairs, 0u);
      }
    }
  }
}

// Cubes that touch by faces, edges and corners, exactly: spheres overlap, cubes only touch, and
// two cubes by a corner have tangent spheres.
TEST_P(Guarantee, IsKeptOnTheLattice) {
  Judged bodies(box({0, 0, 0}, {4, 3, 2}), 4, box({0, 0, 0}, {3, 2, 3}), 3, GetParam());
  ASSERT_EQ(bodies.fixed().voxel_size(), 1);
  ASSERT_EQ(bodies.moving().voxel_size(), 1);
  std::size_t leaf_pairs = 0;
  for (const Eigen::Matrix3d& turn : quarter_turns()) {
    for (const double x : {-3.0, 0.0, 4.0}) {
      for (const double y : {-2.0, 3.0, 5.0}) {
        for (const double z : {-3.0, 2.0}) leaf_pairs += bodies.check(pose_of(turn, {x, y, z}));
      }
    }
  }
  EXPECT_GT(leaf_pairs, 1000u);
}

TEST_P(Guarantee, IsKeptOnALatticeAndOneTwiceAsCoarse) {
  Judged bodies(box({0, 0, 0}, {4, 4, 4}), 4, box({0, 0, 0}, {4, 2, 4}), 2, GetParam());
  ASSERT_EQ(2 * bodies.fixed().voxel_size(), bodies.moving().voxel_size());
  std::vector<Eigen::Vector3d> places{{4, 0, 0}, {4, 4, 1}, {-4, 4, 4}, {1, 2, -4}};
  for (const double x : {-3.0, 0.0, 4.0}) {
    for (const double y : {-3.0, 2.0}) {
      for (const double z : {-2.0, 3.0, 5.0}) places.emplace_back(x, y, z);
    }
  }
  std::size_t leaf_pairs = 0;
  for (const Eigen::Matrix3d& turn : quarter_turns()) {
    for (const Eigen::Vector3d& at : places) leaf_pairs += bodies.check(pose_of(turn, at));
  }
  EXPECT_GT(leaf_pairs, 1000u);
}

// The faces of a lattice across an axis, exactly.
std::array<mpq_class, 2> faces(const Lattice& lattice, Eigen::Index axis) {
  const mpq_class low(lattice.corner[static_cast<std::size_t>(axis)]);
  return {low, mpq_class(low + mpq_class(lattice.voxel_size) * lattice.cells)};
}

// Where a corner of the turned moving lattice is on corner k of the fixed one, rounded so that it
// is in it.
Eigen::Vector3d corner_in_corner(const Lattice& fixed, const Lattice& moving,
                                 const Eigen::Matrix3d& turn, int k) {
  Eigen::Vector3d at;
  for (Eigen::Index i = 0; i < 3; ++i) {
    Eigen::Index j = 0;
    turn.row(i).cwiseAbs().maxCoeff(&j);
    const bool above = (k >> i & 1) != 0, flipped = turn(i, j) < 0;
    const mpq_class& face = faces(moving, j)[above == flipped ? 1 : 0];
    const mpq_class exact = faces(fixed, i)[above ? 1 : 0] - (flipped ? mpq_class(-face) : face);
    at[i] = exact.get_d();
    if (above ? mpq_class(at[i]) > exact : mpq_class(at[i]) < exact) {
      at[i] = std::nextafter(at[i], above ? -HUGE_VAL : HUGE_VAL);
    }
  }
  return at;
}

// Two lattices of any size, anywhere. A corner of one is in a corner of the other by less than the
// last bit of the translation, and then out of it by as little. A test without a pad loses some of
// those that are in.
TEST_P(Guarantee, IsKeptWhereCornersMeet) {
  const std::vector<Eigen::Matrix3d> turns = quarter_turns();
  std::size_t leaf_pairs = 0;
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{60}); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(2000 + seed);
    const auto cube = [&random] {
      const Eigen::Vector3d corner = random.point(-9, 9);
      return box(corner, corner + Eigen::Vector3d::Constant(random.uniform(0.5, 3)));
    };
    const TriangleMesh a = cube(), b = cube();
    const double cells_a = 1 + static_cast<double>(random.below(6)),
                 cells_b = 1 + static_cast<double>(random.below(6));
    Judged bodies(a, cells_a, b, cells_b, GetParam());
    const Lattice &fixed = voxels_of(bodies.fixed()).lattice,
                  &moving = voxels_of(bodies.moving()).lattice;
    for (int k = 0; k < 8; ++k) {
      const Eigen::Matrix3d& turn = turns[random.below(turns.size())];
      Eigen::Vector3d at = corner_in_corner(fixed, moving, turn, k);
      leaf_pairs += bodies.check(pose_of(turn, at));
      for (Eigen::Index i = 0; i < 3; ++i) {
        at[i] = std::nextafter(at[i], (k >> i & 1) != 0 ? HUGE_VAL : -HUGE_VAL);
      }
      bodies.check(pose_of(turn, at));
    }
  }
  // The first seeds meet nowhere.
  if (effort() >= 1) {
    EXPECT_GT(leaf_pairs, is_implicit(GetParam().policy) ? samples(100u) : 0u);
  }
}

// Moved apart until the answer is empty, and some last bits to either side of that.
TEST_P(Guarantee, IsKeptWhereTheLastContactEnds) {
  const double last_bit = GetParam().last_bit();
  const TriangleMesh a = moved(icosphere(1, 1), {3, -5, 1});
  const TriangleMesh b = triangle({0, 0, 0}, {1, 0.25, 0}, {0.5, 1, 0.5});
  for (const auto& [cells_a, cells_b] : {std::pair{1.0, 1.0}, {1.0, 2.0}, {4.0, 4.0}, {4.0, 8.0}}) {
    Judged bodies(a, cells_a, b, cells_b, GetParam());
    Random random(3);
    for (int k = 0; k < 6; ++k) {
      const Eigen::Matrix3d rotation =
          k < 3 ? random.rotation() : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
      const auto pose = [&](double t) {
        Eigen::Vector3d at(2.3, -5.4, 0.8);
        at[k % 3] += t;
        return pose_of(rotation, at);
      };
      const double last = last_touching(
          0, 16, [&](double t) { return ask(bodies.query(), pose(t)).result.leaf_pairs > 0; });
      for (int bits = 0; bits <= 8; ++bits) {
        EXPECT_GT(bodies.check(pose(last * (1 - bits * last_bit))), 0u);
        bodies.check(pose(last * (1 + bits * last_bit)));
      }
      EXPECT_EQ(bodies.check(pose(std::nextafter(last, 16.0))), 0u);
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

class GuaranteeOfOneVoxel : public ::testing::TestWithParam<Engine> {};

INSTANTIATE_TEST_SUITE_P(Engines, GuaranteeOfOneVoxel,
                         ::testing::ValuesIn(engines_of(SpherePolicy::kSlab, {""})), engine_name);

// Two leaves that are roots. A ball leaves the other's slab while their balls still overlap.
TEST_P(GuaranteeOfOneVoxel, IsKeptWhereSlabsAlonePart) {
  constexpr SpherePolicy kSlab = SpherePolicy::kSlab;
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{60}); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(4000 + seed);
    const TriangleMesh a = plate(random), b = plate(random);
    Judged bodies(a, 0.9, b, 0.9, GetParam());
    const SphereTree &fixed = bodies.fixed(), &moving = bodies.moving();
    ASSERT_EQ(voxels_of(fixed).octree.node_count() + voxels_of(moving).octree.node_count(), 2u);
    Query balls(fixed, moving, options_of(SpherePolicy::kTight));

    // Out of one of the slabs along its normal, from where the balls' centres are one.
    const Eigen::Matrix3d rotation = random.rotation();
    const Eigen::Vector3d centre = fixed.origin() + voxels_of(fixed).saved_ball(0, 0, 0).centre;
    const Eigen::Vector3d moving_centre =
        moving.origin() + voxels_of(moving).saved_ball(0, 0, 0).centre;
    const Eigen::Vector3d normal = seed % 2 == 0
                                       ? voxels_of(fixed).saved_slab(0, 0, 0).normal
                                       : rotation * voxels_of(moving).saved_slab(0, 0, 0).normal;
    const auto pose = [&](double gap) {
      return pose_of(rotation, centre - rotation * moving_centre + gap * normal);
    };
    const double last = last_touching(
        0, 4, [&](double gap) { return bodies.exact(pose(gap)).bounds_meet(kSlab, 0, 0, 0); });
    const double last_answered = last_touching(
        0, 4, [&](double gap) { return ask(bodies.query(), pose(gap)).result.leaf_pairs > 0; });
    EXPECT_GE(last_answered, last);
    EXPECT_EQ(bodies.check(pose(last)), 1u);
    EXPECT_EQ(bodies.check(pose(last_answered)), 1u);
    const double first_apart = std::nextafter(last_answered, 4);
    EXPECT_EQ(bodies.check(pose(first_apart)), 0u);
    EXPECT_EQ(ask(balls, pose(first_apart)).result.leaf_pairs, 1u) << "the balls part too";
    for (int bits = 1; bits <= 8; ++bits) {
      EXPECT_EQ(bodies.check(pose(last * (1 - bits * 0x1p-24))), 1u);
      bodies.check(pose(last * (1 + bits * 0x1p-24)));
      bodies.check(pose(last_answered * (1 - bits * 0x1p-24)));
      EXPECT_EQ(bodies.check(pose(last_answered * (1 + bits * 0x1p-24))), 0u);
    }
  }
}

TEST_P(Guarantee, IsKeptWhereOneIsInsideTheOther) {
  Judged bodies(icosphere(2, 4), 15, icosphere(1, 1), 8, GetParam());
  EXPECT_EQ(bodies.check(Eigen::Isometry3d::Identity()), 0u);
  EXPECT_EQ(bodies.check(shift({0.5, -0.5, 0.25})), 0u);
  EXPECT_GT(bodies.check(shift({3, 0, 0})), 0u);
  EXPECT_GT(bodies.check(shift({3.1, 0, 0})), 0u);
}

}  // namespace
}  // namespace ist::test
