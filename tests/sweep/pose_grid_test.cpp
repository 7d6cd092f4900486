// Poses on a grid: their order, their ends, and their motions.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "sweep/pose_source.h"

namespace ist::test {
namespace {

PoseGrid::Axis move(const Eigen::Vector3d& direction, double from, double to, std::uint64_t count) {
  return {false, direction, Eigen::Vector3d::Zero(), from, to, count};
}

PoseGrid::Axis turn(const Eigen::Vector3d& direction, const Eigen::Vector3d& about, double from,
                    double to, std::uint64_t count) {
  return {true, direction, about, from, to, count};
}

std::vector<Eigen::Isometry3d> all_of(const PoseGrid& grid) {
  std::vector<Eigen::Isometry3d> poses(grid.count());
  grid.read(0, poses);
  return poses;
}

TEST(PoseGrid, TheLastAxisGoesFastest) {
  const PoseGrid grid({move(Eigen::Vector3d::UnitX(), 0, 1, 2),
                       move(Eigen::Vector3d::UnitY(), 0, 2, 3),
                       move(Eigen::Vector3d::UnitZ(), 0, 3, 4)});
  const std::vector<Eigen::Isometry3d> poses = all_of(grid);
  ASSERT_EQ(poses.size(), 24U);
  for (std::size_t x = 0, i = 0; x < 2; ++x) {
    for (std::size_t y = 0; y < 3; ++y) {
      for (std::size_t z = 0; z < 4; ++z, ++i) {
        const Eigen::Vector3d place(static_cast<double>(x), static_cast<double>(y),
                                    static_cast<double>(z));
        EXPECT_EQ(poses[i].translation(), place) << i;
        EXPECT_EQ(poses[i].linear(), Eigen::Matrix3d::Identity());
      }
    }
  }
}

TEST(PoseGrid, ADirectionHasAnyLengthButZero) {
  const auto last = [](double length) {
    const Eigen::Vector3d along = length * Eigen::Vector3d(1, 2, 2);
    return all_of(PoseGrid({move(along, 0, 3, 2), turn(along, {1, 0, 0}, 0, 90, 2)})).back();
  };
  const Eigen::Isometry3d expected = last(1);
  for (const double length : {1e-300, 1e-170, 1e170, 1e300}) {
    EXPECT_LE((last(length).matrix() - expected.matrix()).cwiseAbs().maxCoeff(), 1e-14) << length;
  }
}

TEST(PoseGrid, EndsAreExact) {
  const PoseGrid::Axis axis = move(Eigen::Vector3d::UnitZ(), 0.1, 0.7, 50);
  EXPECT_EQ(PoseGrid::value_of(axis, 0), 0.1);
  EXPECT_EQ(PoseGrid::value_of(axis, 49), 0.7);
  for (std::uint64_t i = 1; i < 49; ++i) {
    EXPECT_NEAR(PoseGrid::value_of(axis, i), 0.1 + 0.6 * static_cast<double>(i) / 49, 2e-16);
  }
  EXPECT_EQ(PoseGrid::value_of(move(Eigen::Vector3d::UnitZ(), 3, 5, 1), 0), 3);
  // From here a step to the end would round.
  EXPECT_NE(1e9 + (0.1 - 1e9), 0.1);
  EXPECT_EQ(PoseGrid::value_of(move(Eigen::Vector3d::UnitZ(), 1e9, 0.1, 3), 2), 0.1);
}

TEST(PoseGrid, TurnsByDegreesAboutTheLine) {
  const Eigen::Vector3d direction(1, 2, -2), about(5, -3, 40);
  const PoseGrid grid({turn(direction, about, -360, 360, 97)});
  const std::vector<Eigen::Isometry3d> poses = all_of(grid);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double degrees = -360 + 7.5 * static_cast<double>(i);
    const Eigen::Affine3d known =
        Eigen::Translation3d(about) *
        Eigen::AngleAxisd(degrees * M_PI / 180, direction / 3).toRotationMatrix() *
        Eigen::Translation3d(-about);
    EXPECT_LT((poses[i].matrix() - known.matrix()).cwiseAbs().maxCoeff(), 1e-13) << degrees;
  }
}

// The first axis moves what the later ones have moved.
TEST(PoseGrid, TheFirstAxisActsLast) {
  const PoseGrid grid({turn(Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(), 90, 90, 1),
                       move({0, 3, 0}, 2, 2, 1)});
  const Eigen::Isometry3d pose = all_of(grid).front();
  const Eigen::Vector3d place = pose * Eigen::Vector3d(1, 0, 0);
  EXPECT_LT((place - Eigen::Vector3d(-2, 1, 0)).cwiseAbs().maxCoeff(), 1e-15) << place;
}

TEST(PoseGrid, APoseDependsOnItsNumberAlone) {
  const PoseGrid grid(
      {move(Eigen::Vector3d::UnitX(), 0, 1, 1000003), turn({1, 1, 0}, {1, 0, 0}, 0, 20, 1000)});
  ASSERT_EQ(grid.count(), 1000003000U);
  std::vector<Eigen::Isometry3d> together(7);
  grid.read(999'999'990, together);
  for (std::size_t i = together.size(); i-- > 0;) {
    Eigen::Isometry3d alone;
    grid.read(999'999'990 + i, {&alone, 1});
    EXPECT_EQ(alone.matrix(), together[i].matrix());
  }
}

TEST(PoseGrid, IdentityHasEachNumber) {
  const std::vector<PoseGrid::Axis> axes = {move({1, 0, 0}, 0, 1, 3),
                                            turn({0, 1, 0}, {1, 2, 3}, 0, 1, 2)};
  const std::string known = PoseGrid(axes).identity();
  const auto with = [&](auto change) {
    std::vector<PoseGrid::Axis> other = axes;
    change(other);
    return PoseGrid(other).identity();
  };
  EXPECT_EQ(with([](auto&) {}), known);
  EXPECT_NE(with([](auto& o) { o[0].from = std::nextafter(0.0, 1.0); }), known);
  EXPECT_NE(with([](auto& o) { o[0].to = std::nextafter(1.0, 2.0); }), known);
  EXPECT_NE(with([](auto& o) { o[1].about.z() = std::nextafter(3.0, 4.0); }), known);
  EXPECT_NE(with([](auto& o) { o[1].turns = false; }), known);
  EXPECT_NE(with([](auto& o) { o[0].direction = {0, 0, 1}; }), known);
  EXPECT_NE(with([](auto& o) { o[0].count = 4; }), known);
  EXPECT_NE(with([](auto& o) { std::swap(o[0], o[1]); }), known);
}

TEST(PoseGrid, GivesTheValuesOfItsNamedAxes) {
  PoseGrid::Axis opening = move(Eigen::Vector3d::UnitZ(), -1, 1, 5),
                 side = move(Eigen::Vector3d::UnitX(), 0, 3, 4);
  opening.name = "opening";
  side.name = "side";
  const PoseGrid grid({opening, turn(Eigen::Vector3d::UnitZ(), {0, 0, 0}, 0, 90, 3), side});
  EXPECT_EQ(grid.value_names(), (std::vector<std::string>{"opening", "side"}));
  for (std::uint64_t i = 0; i < grid.count(); ++i) {
    std::array<double, 2> values = {};
    grid.values(i, values);
    EXPECT_EQ(values[0], PoseGrid::value_of(opening, i / 12)) << i;
    EXPECT_EQ(values[1], PoseGrid::value_of(side, i % 4)) << i;
  }
  side.name = "other";
  EXPECT_NE(PoseGrid({opening, side}).identity(),
            PoseGrid({opening, move({1, 0, 0}, 0, 3, 4)}).identity());
}

}  // namespace
}  // namespace ist::test
