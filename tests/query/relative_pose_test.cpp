#include "ist/query/relative_pose.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ist/base/pose.h"
#include "ist/query/traversal/search_pose.h"
#include "query/query_cases.h"
#include "support/effort.h"

namespace ist::test {
namespace {

Lattice lattice_at(const Eigen::Vector3d& corner, double voxel_size, int depth) {
  Lattice lattice;
  lattice.corner = {corner[0], corner[1], corner[2]};
  lattice.voxel_size = voxel_size;
  lattice.cells = 1u << depth;
  lattice.depth = depth;
  return lattice;
}

mpq_class frame_origin(const Lattice& lattice, std::size_t axis) {
  return mpq_class(lattice.corner[axis]) + mpq_class(lattice.edge(lattice.depth)) / 2;
}

// Error of the translation, and its length, as doubles: the error from rational numbers.
struct Accuracy {
  double error, length;
};

Accuracy accuracy(const Eigen::Isometry3d& pose, const Lattice& fixed, const Lattice& moving) {
  const RelativePose relative = relative_pose(pose, fixed, moving).value();
  const Eigen::Isometry3d rigid = project_to_rigid(pose).value();
  EXPECT_EQ(relative.rotation, rigid.linear());
  Eigen::Vector3d error, length;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    mpq_class exact = mpq_class(rigid.translation()[row]) - frame_origin(fixed, i);
    for (std::size_t j = 0; j < 3; ++j) {
      exact +=
          mpq_class(rigid.linear()(row, static_cast<Eigen::Index>(j))) * frame_origin(moving, j);
    }
    const mpq_class off = mpq_class(relative.translation[row]) - exact;
    error[row] = off.get_d();
    length[row] = exact.get_d();
  }
  return {error.norm(), length.norm()};
}

TEST(RelativePose, IsRightToItsOwnLastBitsWhereverTheSceneLies) {
  Random random(11);
  for (const double away : {0.0, 1.0, 1e3, 1e6, 1e9}) {
    for (int i = 0; i < samples(200); ++i) {
      const Eigen::Vector3d fixed_corner = away * random.direction() + random.point(-1, 1);
      const Eigen::Vector3d moving_corner = away * random.direction() + random.point(-1, 1);
      const Lattice fixed = lattice_at(fixed_corner, random.uniform(0.1, 1), 3);
      const Lattice moving = lattice_at(moving_corner, random.uniform(0.1, 1), 4);
      const Eigen::Matrix3d rotation =
          project_to_rigid(pose_of(random.rotation(), {0, 0, 0})).value().linear();
      // The two frames a few units from each other.
      const Eigen::Vector3d at = fixed_corner - rotation * moving_corner + random.point(-4, 4);
      const Accuracy found = accuracy(pose_of(rotation, at), fixed, moving);
      EXPECT_LE(found.error, 0x1p-52 * found.length) << "away " << away;
    }
  }
}

TEST(RelativePose, IsExactOnTheLattice) {
  for (const Eigen::Matrix3d& turn : quarter_turns()) {
    const Lattice fixed = lattice_at({1, -2, 3}, 0.5, 3), moving = lattice_at({-4, 5, 7}, 1, 2);
    EXPECT_EQ(accuracy(pose_of(turn, {8, 16, -32}), fixed, moving).error, 0);
  }
}

TEST(RelativePose, StaysFiniteAtTheEndOfTheRange) {
  const Lattice lattice = lattice_at({1, 1, 1}, 1, 0);
  for (const double far : {1e200, 1e308, -1.7976931348623157e308}) {
    const auto relative = relative_pose(shift({far, 0, 0}), lattice, lattice);
    ASSERT_TRUE(relative);
    EXPECT_EQ(relative->translation[0], far);
  }
}

TEST(RelativePose, IsNothingForWhatIsNoRigidMotion) {
  const Lattice lattice = lattice_at({1, 1, 1}, 1, 0);
  EXPECT_FALSE(
      relative_pose(pose_of(2 * Eigen::Matrix3d::Identity(), {0, 0, 0}), lattice, lattice));
  EXPECT_FALSE(relative_pose(shift({std::nan(""), 0, 0}), lattice, lattice));
}

RelativePose random_relative(Random& random) {
  const double away = std::ldexp(1.0, static_cast<int>(random.below(40)) - 20);
  return {random.rotation(), away * random.direction()};
}

// The fixed frame's origin in the moving frame, each number of it rounded once.
TEST(SearchPose, IsThePoseTurnedRoundAndRoundedOnce) {
  Random random(21);
  for (int i = 0; i < samples(2000); ++i) {
    const RelativePose pose = random_relative(random);
    const SearchPose narrowed = to_float(pose, {0.5, 0.1, 0.08}, {0.5, 0.1, 0.08});
    double error = 0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      mpq_class exact = 0;
      for (Eigen::Index k = 0; k < 3; ++k) {
        exact -= mpq_class(pose.rotation(k, axis)) * mpq_class(pose.translation[k]);
        EXPECT_EQ(narrowed.rotation[3 * axis + k], static_cast<float>(pose.rotation(k, axis)));
      }
      const mpq_class off = mpq_class(double{narrowed.translation[axis]}) - exact;
      error = std::max(error, std::abs(off.get_d()));
    }
    EXPECT_LE(error, 0x1p-24 * (1 + 1e-6) * pose.translation.norm());
  }
}

// The error of the kernels grows with the size of both bodies and with their distance. See
// search_pose.cpp.
TEST(SearchPose, HasPadsThatRiseWithBodiesAndPlace) {
  Random random(22);
  for (int i = 0; i < samples(2000); ++i) {
    const RelativePose pose = random_relative(random);
    const double radius = random.uniform(1e-3, 1e3), margin = random.uniform(0, 1);
    const double u = 0x1p-24 * (radius + pose.translation.norm());
    const TreeLengths half{0.5 * radius, 1e3, 0.8};  // for voxels as large no slab rises
    const SearchPose narrowed = to_float(pose, half, half, margin);
    const auto expect_pad = [](float pad, double least, double most) {
      EXPECT_GE(pad, least);
      EXPECT_LE(pad, 1.001 * most);
    };
    expect_pad(narrowed.leaf.ball, 12 * u + margin, 13 * u + margin);
    expect_pad(narrowed.leaf.slab_fixed, 16.9 * u + margin, 17 * u + margin);
    EXPECT_EQ(narrowed.leaf.slab_moving, narrowed.leaf.slab_fixed);
    // Twice the pad of a leaf, and the error of an inner node's test.
    expect_pad(narrowed.inner.ball, 37 * u + margin, 38 * u + margin);
    expect_pad(narrowed.inner.slab_fixed, (2 * 17 + 18.6) * u + margin, 53.1 * u + margin);
    EXPECT_EQ(narrowed.inner.slab_moving, narrowed.inner.slab_fixed);
  }
}

// The slabs of inner nodes are nested for a reach of 5/4 voxel and count as wider for a larger one.
TEST(SearchPose, HasWiderInnerSlabsForLargerPartners) {
  const RelativePose still{Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
  const TreeLengths fine{1e-3, 0.1, 0.08}, coarse{1e-3, 0.8, 0.64};
  const auto inner = [&](const TreeLengths& a, const TreeLengths& b, double margin) {
    return to_float(still, a, b, margin).inner;
  };
  EXPECT_NEAR(inner(fine, fine, 0.04).slab_fixed, 0.04, 1e-5);
  EXPECT_NEAR(inner(fine, fine, 0.3).slab_fixed, 0.3 + (0.38 - 0.125) / 3, 1e-5);
  EXPECT_NEAR(inner(fine, coarse, 0).slab_fixed, (0.64 - 0.125) / 3, 1e-5);
  EXPECT_NEAR(inner(fine, coarse, 0).slab_moving, 0, 1e-5);
  EXPECT_NEAR(inner(coarse, fine, 0).slab_moving, (0.64 - 0.125) / 3, 1e-5);
  EXPECT_NEAR(inner(fine, coarse, 0).ball, 0, 1e-5);
  EXPECT_NEAR(to_float(still, fine, coarse, 0).leaf.slab_fixed, 0, 1e-5);
}

// A margin that grows in two steps is at least as large as a margin that grows in one.
TEST(SearchPose, InflatedHasAllPadsOfALargerMargin) {
  Random random(23);
  for (int i = 0; i < samples(2000); ++i) {
    const RelativePose pose = random_relative(random);
    const TreeLengths a{random.uniform(1, 10), random.uniform(0.1, 1), random.uniform(0.01, 1)},
        b{random.uniform(1, 10), random.uniform(0.1, 1), random.uniform(0.01, 1)};
    const double margin = random.uniform(0, 0.1), by = random.uniform(0, 3);
    const SearchPose whole = to_float(pose, a, b, margin + by),
                     made = inflated(to_float(pose, a, b, margin), by);
    for (const auto& [wanted, found] :
         {std::pair(whole.leaf, made.leaf), std::pair(whole.inner, made.inner)}) {
      EXPECT_GE(found.ball, wanted.ball * (1 - 0x1p-23F));
      EXPECT_LE(found.ball, wanted.ball * (1 + 0x1p-21F));
      EXPECT_GE(found.slab_fixed, wanted.slab_fixed * (1 - 0x1p-23F));
      EXPECT_GE(found.slab_moving, wanted.slab_moving * (1 - 0x1p-23F));
    }
  }
}

}  // namespace
}  // namespace ist::test
