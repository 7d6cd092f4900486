#include <gtest/gtest.h>

#include <vector>

#include "golden/hasher.h"
#include "sweep/pose_source.h"

namespace ist::test {
namespace {

// The hash of the first thousand poses, each column by column.
std::uint64_t hash_of_poses(const PoseSource& source) {
  std::vector<Eigen::Isometry3d> poses(1000);
  source.read(0, poses);
  Hasher hasher;
  for (const Eigen::Isometry3d& pose : poses) {
    for (int entry = 0; entry < 16; ++entry) hasher.add(pose.data()[entry]);
  }
  return hasher.value();
}

PoseBox poses_of_box(PoseBox::Turns turns) {
  PoseBox::Settings settings{.seed = 7, .count = 1000, .turns = turns};
  settings.from = {-1, -2, -3};
  settings.to = {1, 2, 3};
  settings.within = {5, 5, 5};
  settings.about = {1, 2, 3};
  return PoseBox(settings);
}

// Pose i of a sweep has the same bits wherever it is computed. The hashes of the boxes are those of
// the same formulas in Python, too, by numpy's random numbers.
TEST(GoldenSweepPoses, HaveTheSameBitsEverywhere) {
  EXPECT_EQ(hash_of_poses(poses_of_box(PoseBox::Turns::kAny)), 0x53f035f462c1af2f);
  EXPECT_EQ(hash_of_poses(poses_of_box(PoseBox::Turns::kWithin)), 0xec838a62269cf860);
  PoseGrid::Axis move, turn;
  move.direction = {1, 1, 0};
  move.to = 1;
  move.count = 10;
  turn.turns = true;
  turn.direction = {1, 2, -2};
  turn.about = {5, -3, 40};
  turn.from = -360;
  turn.to = 360;
  turn.count = 100;
  EXPECT_EQ(hash_of_poses(PoseGrid({move, turn})), 0xca81af9b2d26c423);
}

}  // namespace
}  // namespace ist::test
