#include "ist/query/reference/reference_query.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "ist/base/error.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "query/query_cases.h"
#include "support/exact_query.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

struct Engine {
  SpherePolicy policy;
  SphereSource source;
};

std::string name_of(const Engine& engine) {
  return std::string(to_string(engine.policy)) +
         (engine.source == SphereSource::kSaved ? "Saved" : "OnTheFly");
}

// Every policy, from both sources, against the oracle.
class ReferenceOracle : public ::testing::TestWithParam<Engine> {
 protected:
  struct Bodies : RationalBodies {
    Bodies(const TriangleMesh& a, double cells_a, const TriangleMesh& b, double cells_b)
        : RationalBodies(a, tree_of(a, cells_a), b, tree_of(b, cells_b)) {}
  };

  [[nodiscard]] static ReferenceQuery query(const Bodies& bodies) {
    return {bodies.fixed, bodies.moving, GetParam().policy, GetParam().source};
  }
  static std::size_t check(const Bodies& bodies, ReferenceQuery& query,
                           const Eigen::Isometry3d& pose) {
    const FoundPairs answer = ask(query, pose);
    EXPECT_EQ(answer.result.status, QueryStatus::kDone);
    EXPECT_TRUE(answer.result.complete);
    EXPECT_EQ(answer.result.level, 0);
    EXPECT_TRUE(keeps_guarantee(bodies.at(pose), GetParam().policy, answer.leaf_pairs,
                                answer.result.pad, published_are_nested(GetParam().policy)))
        << "pose\n"
        << pose.matrix();
    return answer.leaf_pairs.size();
  }
};

INSTANTIATE_TEST_SUITE_P(Engines, ReferenceOracle,
                         ::testing::Values(Engine{SpherePolicy::kSimple, SphereSource::kOnTheFly},
                                           Engine{SpherePolicy::kSimple, SphereSource::kSaved},
                                           Engine{SpherePolicy::kTable, SphereSource::kOnTheFly},
                                           Engine{SpherePolicy::kTable, SphereSource::kSaved},
                                           Engine{SpherePolicy::kTight, SphereSource::kOnTheFly},
                                           Engine{SpherePolicy::kTight, SphereSource::kSaved},
                                           Engine{SpherePolicy::kSlab, SphereSource::kOnTheFly},
                                           Engine{SpherePolicy::kSlab, SphereSource::kSaved}),
                         [](const auto& engine) { return name_of(engine.param); });

TEST_P(ReferenceOracle, RandomBodiesNearTouching) {
  constexpr double kCells[] = {1, 1.5, 2, 3, 5, 9, 13};
  std::size_t touching = 0, free = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const TriangleMesh a = random_mesh(random), b = random_mesh(random);
    const Bodies bodies(a, kCells[random.below(7)], b, kCells[random.below(7)]);
    ReferenceQuery reference = query(bodies);
    for (int i = 0; i < 6; ++i) {
      // One point of each brought together, and then a little apart.
      const Eigen::Matrix3d rotation = random.rotation();
      const Eigen::Vector3d on_a = a.vertices[random.below(a.vertices.size())];
      const Eigen::Vector3d on_b = b.vertices[random.below(b.vertices.size())];
      const double gap = random.uniform(-1, 1) * bodies.fixed.voxel_size();
      const Eigen::Isometry3d pose =
          pose_of(rotation, on_a - rotation * on_b + gap * random.direction());
      (check(bodies, reference, pose) > 0 ? touching : free) += 1;
    }
  }
  EXPECT_GT(touching, 100u);
  EXPECT_GT(free, 5u);
}

TEST_P(ReferenceOracle, VoxelSizesThatDiffer) {
  const TriangleMesh ball = icosphere(1, 1), block = box({-1, -0.7, -0.5}, {1, 0.7, 0.5});
  for (const double ratio : {1.0, 1.3, 2.0, 7.0}) {
    for (const auto& [cells_a, cells_b] : {std::pair{10.0, 10 / ratio}, {10 / ratio, 10.0}}) {
      const Bodies bodies(ball, cells_a, block, cells_b);
      ReferenceQuery reference = query(bodies);
      Random random(static_cast<std::uint64_t>(10 * ratio));
      std::size_t leaf_pairs = 0;
      for (int i = 0; i < 4; ++i) {
        const Eigen::Isometry3d pose =
            pose_of(random.rotation(), random.uniform(1, 2) * random.direction());
        leaf_pairs += check(bodies, reference, pose);
      }
      EXPECT_GT(leaf_pairs, 0u);
    }
  }
}

// Cubes that touch by faces, edges and corners, exactly: spheres overlap, cubes only touch, and
// two cubes by a corner have tangent spheres.
TEST_P(ReferenceOracle, OnTheLattice) {
  const Bodies bodies(box({0, 0, 0}, {4, 3, 2}), 4, box({0, 0, 0}, {3, 2, 3}), 3);
  ReferenceQuery reference = query(bodies);
  ASSERT_EQ(bodies.fixed.voxel_size(), 1);
  ASSERT_EQ(bodies.moving.voxel_size(), 1);
  std::size_t leaf_pairs = 0;
  for (const Eigen::Matrix3d& turn : quarter_turns()) {
    for (const double x : {-3.0, 0.0, 4.0}) {
      for (const double y : {-2.0, 3.0, 5.0}) {
        for (const double z : {-3.0, 2.0}) {
          leaf_pairs += check(bodies, reference, pose_of(turn, {x, y, z}));
        }
      }
    }
  }
  EXPECT_GT(leaf_pairs, 1000u);
}

TEST_P(ReferenceOracle, OnTheLatticeAtTwiceTheVoxelSize) {
  const Bodies bodies(box({0, 0, 0}, {4, 4, 4}), 4, box({0, 0, 0}, {4, 2, 4}), 2);
  ReferenceQuery reference = query(bodies);
  for (const Eigen::Matrix3d& turn : quarter_turns()) {
    for (const Eigen::Vector3d& at : {Eigen::Vector3d(4, 0, 0), Eigen::Vector3d(4, 4, 1),
                                      Eigen::Vector3d(-4, 4, 4), Eigen::Vector3d(1, 2, -4)}) {
      check(bodies, reference, pose_of(turn, at));
    }
  }
}

TEST_P(ReferenceOracle, OneInsideTheOther) {
  const Bodies bodies(icosphere(2, 4), 15, icosphere(1, 1), 8);
  ReferenceQuery reference = query(bodies);
  EXPECT_EQ(check(bodies, reference, Eigen::Isometry3d::Identity()), 0u);
  EXPECT_EQ(check(bodies, reference, shift({0.5, -0.5, 0.25})), 0u);
  EXPECT_GT(check(bodies, reference, shift({3.1, 0, 0})), 0u);
}

TEST_P(ReferenceOracle, FarApartIsOneTest) {
  const Bodies bodies(icosphere(1, 1), 8, icosphere(1, 1), 8);
  ReferenceQuery reference = query(bodies);
  for (const double far :
       {10.0, 1e3, 1e9, 1e26, 1e200, 1e308, -1e308, std::numeric_limits<double>::max()}) {
    for (int axis = 0; axis < 4; ++axis) {
      const Eigen::Vector3d at = axis == 3 ? Eigen::Vector3d::Constant(far)
                                           : Eigen::Vector3d(far * Eigen::Vector3d::Unit(axis));
      const FoundPairs answer = ask(reference, shift(at));
      EXPECT_EQ(answer.result.status, QueryStatus::kDone);
      EXPECT_TRUE(answer.result.complete);
      EXPECT_EQ(answer.result.leaf_pairs, 0u) << "at " << at.transpose();
      EXPECT_EQ(answer.result.sphere_tests, 1u) << "at " << at.transpose();
    }
  }
}

// Moved apart until the answer is empty, to the last bit, and some bits to either side of it.
TEST_P(ReferenceOracle, TangentSpheres) {
  for (const double cells : {1.0, 4.0}) {
    for (const bool turned : {false, true}) {
      const Bodies bodies(moved(icosphere(1, 1), {3, -5, 1}), cells,
                          triangle({0, 0, 0}, {1, 0.25, 0}, {0.5, 1, 0.5}), cells);
      ReferenceQuery reference = query(bodies);
      Random random(turned ? 3 : 4);
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Matrix3d rotation =
            turned ? random.rotation() : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
        const auto pose = [&](double t) {
          Eigen::Vector3d at(2.3, -5.4, 0.8);
          at[axis] += t;
          return pose_of(rotation, at);
        };
        const double last = last_touching(
            0, 16, [&](double t) { return ask(reference, pose(t)).result.leaf_pairs > 0; });
        double below = last, above = last;
        for (int ulp = 0; ulp <= 8; ++ulp) {
          EXPECT_GT(check(bodies, reference, pose(below)), 0u);
          check(bodies, reference, pose(above));
          below = std::nextafter(below, 0.0);
          above = std::nextafter(above, 16.0);
        }
      }
    }
  }
}

// Two grids of any size, anywhere, a corner of one just inside a corner of the other: by less than
// the last bit of the translation, so that a test without a pad loses some of them.
TEST_P(ReferenceOracle, RoundingLosesNoTouch) {
  const std::vector<Eigen::Matrix3d> turns = quarter_turns();
  std::size_t leaf_pairs = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto cube = [&random] {
      const Eigen::Vector3d corner = random.point(-9, 9);
      return box(corner, corner + Eigen::Vector3d::Constant(random.uniform(0.5, 3)));
    };
    const Bodies bodies(cube(), 1 + static_cast<double>(random.below(5)), cube(),
                        1 + static_cast<double>(random.below(5)));
    ReferenceQuery reference = query(bodies);
    // Both faces of the grids along an axis; those of the moving one as it is turned.
    const auto faces = [](const Lattice& lattice, std::size_t axis) {
      const mpq_class low(lattice.corner[axis]);
      return std::array{low, mpq_class(low + mpq_class(lattice.voxel_size) * lattice.cells)};
    };
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Matrix3d& turn = turns[random.below(turns.size())];
      Eigen::Vector3d at;
      for (Eigen::Index i = 0; i < 3; ++i) {
        Eigen::Index j = 0;
        turn.row(i).cwiseAbs().maxCoeff(&j);
        const bool above = (corner >> i & 1) != 0, flipped = turn(i, j) < 0;
        const auto fixed = faces(bodies.fixed.parts().lattice, static_cast<std::size_t>(i));
        const auto moving = faces(bodies.moving.parts().lattice, static_cast<std::size_t>(j));
        const mpq_class& face = moving[above == flipped ? 1 : 0];
        const mpq_class exact = fixed[above ? 1 : 0] - (flipped ? mpq_class(-face) : face);
        at[i] = exact.get_d();
        const double inward = above ? -HUGE_VAL : HUGE_VAL;
        if (above ? mpq_class(at[i]) > exact : mpq_class(at[i]) < exact) {
          at[i] = std::nextafter(at[i], inward);
        }
      }
      leaf_pairs += check(bodies, reference, pose_of(turn, at));
    }
  }
  EXPECT_GT(leaf_pairs, is_implicit(GetParam().policy) ? 300u : 0u);
}

// Circumspheres of cubes that meet in a corner touch in a point; the surfaces there may touch too.
TEST(Reference, CubesThatTouchByACornerAreInTheAnswer) {
  const TriangleMesh block = box({0, 0, 0}, {1, 1, 1});
  const SphereTree tree = tree_of(block, 1);
  for (const SpherePolicy policy : kSpherePolicies) {
    ReferenceQuery query(tree, tree, policy);
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d at((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                               (corner & 4) != 0 ? 1 : -1);
      EXPECT_EQ(ask(query, shift(at)).result.leaf_pairs, 1u);
      EXPECT_EQ(ask(query, shift(1.001 * at)).result.leaf_pairs, 0u);
    }
  }
}

// The surfaces in a contact are no farther apart than the resolution.
TEST(Reference, ResolutionBoundsTheDistanceOfSurfaces) {
  const TriangleMesh left = box({0, 0, 0}, {1, 1, 1}), right = box({0, 0, 0}, {1, 1, 1});
  const SphereTree fixed = tree_of(left, 5), moving = tree_of(right, 3);
  for (const SpherePolicy policy : kSpherePolicies) {
    ReferenceQuery query(fixed, moving, policy);
    const double last = last_touching(1, 4, [&](double x) {
      return ask(query, shift({x, 0, 0})).result.leaf_pairs > 0;
    });
    const QueryResult result = ask(query, shift({last, 0, 0})).result;
    EXPECT_LE(last - 1, result.resolution);
    EXPECT_GE(result.resolution, result.pad);
    EXPECT_GT(result.pad, 0);
    EXPECT_LT(result.pad, 1e-13);
  }
}

TEST(Reference, BoundsThatAreNotThereAreRefused) {
  BuildOptions options;
  options.voxel_size = 0.5;
  options.spheres = SpherePolicy::kTable;
  const SphereTree table = build_tree(icosphere(1, 1), options);
  options.spheres = SpherePolicy::kTight;
  const SphereTree tight = build_tree(icosphere(1, 1), options);
  const SphereTree slab = tree_of(icosphere(1, 1), 4);
  EXPECT_THROW(ReferenceQuery(slab, table, SpherePolicy::kTight), Error);
  EXPECT_THROW(ReferenceQuery(table, slab, SpherePolicy::kTight), Error);
  EXPECT_THROW(ReferenceQuery(slab, tight, SpherePolicy::kSlab), Error);
  EXPECT_THROW(ReferenceQuery(tight, slab, SpherePolicy::kSlab), Error);
  EXPECT_NO_THROW(ReferenceQuery(table, slab, SpherePolicy::kTable));
  EXPECT_NO_THROW(ReferenceQuery(slab, tight, SpherePolicy::kTight));
}

// Two flat sheets face to face, a voxel's edge apart. A leaf's ball reaches 0.71 edges: as far as
// the other sheet's balls, but not to its slabs.
TEST(Reference, SlabsTellSheetsApartThatBallsDoNot) {
  const TriangleMesh sheet = joined(open_strip(2), moved(open_strip(2), {0, 1, 0}));
  const SphereTree tree = tree_of(sheet, 8);
  const double gap = tree.voxel_size();
  ReferenceQuery tight(tree, tree, SpherePolicy::kTight), slab(tree, tree, SpherePolicy::kSlab);
  const FoundPairs balls = ask(tight, shift({0, 0, gap})), slabs = ask(slab, shift({0, 0, gap}));
  EXPECT_GT(balls.result.leaf_pairs, 64u);
  EXPECT_EQ(slabs.result.leaf_pairs, 0u);
  EXPECT_LE(slabs.result.sphere_tests, balls.result.sphere_tests);
  EXPECT_GT(ask(slab, shift({0, 0, 0})).result.leaf_pairs, 0u);
}

}  // namespace
}  // namespace ist::test
