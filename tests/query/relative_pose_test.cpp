#include "ist/query/relative_pose.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "ist/base/pose.h"
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

}  // namespace
}  // namespace ist::test
