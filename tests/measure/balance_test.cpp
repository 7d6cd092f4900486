#include "ist/measure/balance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ist/measure/support_hull.h"
#include "support/effort.h"
#include "support/random.h"

namespace ist::test {
namespace {

BalanceVector random_column(Random& random) {
  BalanceVector column;
  for (double& number : column) number = random.uniform(-1, 1);
  return column;
}

// load + Σ f column
BalanceVector rest_of(const std::vector<BalanceVector>& columns, const BalanceVector& load,
                      const std::vector<BalanceForce>& forces) {
  BalanceVector rest = load;
  for (const auto& [column, force] : forces) {
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] += force * columns[column][i];
  }
  return rest;
}

TEST(Balance, LeavesNoForceThatWouldHelp) {
  Random random(1);
  for (int round = 0; round < samples(500); ++round) {
    std::vector<BalanceVector> columns(static_cast<std::size_t>(1 + round % 30));
    for (BalanceVector& column : columns) column = random_column(random);
    if (round % 3 == 0) columns.push_back(columns.front());  // one depends on another
    const BalanceVector load = random_column(random);
    const auto forces = balance(columns, load);
    const BalanceVector rest = rest_of(columns, load, forces);
    std::vector<bool> has_force(columns.size());
    for (const auto& [column, force] : forces) {
      EXPECT_GT(force, 0);
      EXPECT_FALSE(has_force[column]);
      has_force[column] = true;
    }
    // The conditions of Kuhn and Tucker: more of a column does not shorten the rest, and neither
    // does less of one that has a force.
    for (std::size_t k = 0; k < columns.size(); ++k) {
      double slope = 0;
      for (std::size_t i = 0; i < rest.size(); ++i) slope += columns[k][i] * rest[i];
      EXPECT_GT(slope, -1e-9) << round;
      if (has_force[k]) {
        EXPECT_NEAR(slope, 0, 1e-9) << round;
      }
    }
  }
}

TEST(Balance, IsExactInsideTheCone) {
  Random random(2);
  for (int round = 0; round < samples(500); ++round) {
    std::vector<BalanceVector> columns(12);
    for (BalanceVector& column : columns) column = random_column(random);
    BalanceVector load = {};
    for (const BalanceVector& column : columns) {
      const double force = random.uniform(0, 1);
      for (std::size_t i = 0; i < load.size(); ++i) load[i] -= force * column[i];
    }
    for (const double number : rest_of(columns, load, balance(columns, load))) {
      EXPECT_NEAR(number, 0, 1e-9) << round;
    }
  }
}

TEST(Balance, HasNoForcesWithoutColumns) {
  EXPECT_TRUE(balance({}, {1, 0, 0, 0, 0, 0, 0}).empty());
}

TEST(SupportHull, MarginIsTheWayToTheBorder) {
  const Eigen::Vector3d up(0, 0, 1);
  const std::vector<Eigen::Vector3d> square = {{-1, -2, 5}, {3, -2, 1}, {3, 2, 0}, {-1, 2, 0},
                                               {0, 0, 7},   {3, 0, 0},  {3, 2, 9}};
  EXPECT_DOUBLE_EQ(SupportHull(square, up).margin(), 1);
  std::vector<Eigen::Vector3d> beside = square;
  for (Eigen::Vector3d& point : beside) point += Eigen::Vector3d(4, 5, 0);
  EXPECT_DOUBLE_EQ(SupportHull(beside, up).margin(), -std::sqrt(18.0));
}

TEST(SupportHull, LinesAndPointsHaveNoInside) {
  const Eigen::Vector3d up(0, 0, 1);
  EXPECT_LE(
      SupportHull(std::vector<Eigen::Vector3d>{{-1, 0, 0}, {2, 0, 0}, {1, 0, 3}}, up).margin(), 0);
  EXPECT_DOUBLE_EQ(SupportHull(std::vector<Eigen::Vector3d>{{3, 4, 0}}, up).margin(), -5);
  EXPECT_EQ(SupportHull({}, up).margin(), -HUGE_VAL);
}

}  // namespace
}  // namespace ist::test
