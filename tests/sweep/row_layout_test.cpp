// The columns of rows, and the numbers in them.

#include "sweep/row_layout.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "ist/base/pose.h"
#include "support/random.h"

namespace ist::test {
namespace {

using Names = std::vector<std::string>;

Names names_of(const RowLayout& layout) {
  Names names;
  for (const Column& column : layout.columns) names.push_back(column.name);
  return names;
}

// The columns of all rows, with `answers` after them.
Names all(const Names& answers, const Names& values = {}) {
  Names names = {"index"};
  names.insert(names.end(), values.begin(), values.end());
  for (const char* name : {"x", "y", "z", "qx", "qy", "qz", "qw", "status", "complete"}) {
    names.emplace_back(name);
  }
  names.insert(names.end(), answers.begin(), answers.end());
  return names;
}

TEST(RowLayout, HasTheColumnsOfTheQuestions) {
  EXPECT_EQ(names_of(layout_of({.intersects = true})), all({"intersects", "sphere_tests"}));
  EXPECT_EQ(names_of(layout_of({.leaf_pairs = true})), all({"sphere_tests", "leaf_pairs"}));
  EXPECT_EQ(names_of(layout_of({.distance = true, .penetration = true})),
            all({"not_closed", "self_intersecting", "capped", "sphere_tests", "distance_lower",
                 "distance_upper", "depth_lower", "depth_upper"}));
  EXPECT_EQ(names_of(layout_of({.contacts = true})),
            all({"sphere_tests", "leaf_pairs", "area", "force_x", "force_y", "force_z", "torque_x",
                 "torque_y", "torque_z"}));
}

TEST(RowLayout, HasTheValuesOfNamedAxes) {
  const Names values = {"opening", "side"};
  const RowQuestions questions{.intersects = true};
  const RowLayout layout = layout_of(questions, values);
  EXPECT_EQ(names_of(layout), all({"intersects", "sphere_tests"}, values));
  EXPECT_EQ(layout.bytes, 100U);
  std::vector<std::byte> row(layout.bytes);
  const std::array<double, 2> numbers = {2.5, -1};
  write_row(questions, {3, numbers, Eigen::Isometry3d::Identity()}, RowNumbers(), row);
  std::array<double, 2> found = {};
  std::memcpy(found.data(), row.data() + 8, sizeof(found));
  EXPECT_EQ(found, numbers);
}

// The pose columns of a row without questions: x, y, z, qx, qy, qz, qw.
std::array<double, 7> pose_columns(const Eigen::Isometry3d& pose) {
  std::vector<std::byte> row(layout_of({}).bytes);
  write_row({}, {.pose = pose}, RowNumbers(), row);
  std::array<double, 7> found = {};
  std::memcpy(found.data(), row.data() + 8, sizeof(found));
  return found;
}

// The rotation of a unit quaternion, by the textbook formula.
Eigen::Matrix3d rotation_of(const std::array<double, 7>& columns) {
  return Eigen::Quaterniond(columns[6], columns[3], columns[4], columns[5]).toRotationMatrix();
}

TEST(RowLayout, TheQuaternionIsTheRotation) {
  Random random(3);
  // Each number is the largest one in turn, 0 in turn, and nearly 0.
  std::vector<Eigen::Quaterniond> turns;
  for (int i = 0; i < 4; ++i) {
    for (const double rest : {0.0, 1e-9, 0.3, -0.9}) {
      Eigen::Vector4d q = Eigen::Vector4d::Constant(rest);
      q[i] = 1;
      turns.emplace_back(q);
      q[i] = -1;
      turns.emplace_back(q);
      q[(i + 1) % 4] = 0;
      turns.emplace_back(q);
    }
  }
  for (int i = 0; i < 1000; ++i) {
    turns.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                       random.uniform(-1, 1));
  }
  for (const Eigen::Quaterniond& turn : turns) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = turn.normalized().toRotationMatrix();
    pose.translation() = Eigen::Vector3d(1, -2, 3.5);
    const std::array<double, 7> found = pose_columns(pose);
    EXPECT_EQ(found[0], 1);
    EXPECT_EQ(found[1], -2);
    EXPECT_EQ(found[2], 3.5);
    double square = 0;
    for (std::size_t i = 3; i < 7; ++i) square += found[i] * found[i];
    EXPECT_NEAR(square, 1, 1e-14);
    EXPECT_GE(found[6], 0);
    EXPECT_LE((rotation_of(found) - pose.linear()).cwiseAbs().maxCoeff(), 3e-15);
  }
}

TEST(RowLayout, ThePoseIsTheNearestRigidMotion) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose(0, 1) = 1e-4;  // a shear
  const std::array<double, 7> found = pose_columns(pose);
  const Eigen::Isometry3d rigid = *project_to_rigid(pose);
  EXPECT_LE((rotation_of(found) - rigid.linear()).cwiseAbs().maxCoeff(), 1e-15);
  pose.matrix() *= 2;
  for (const double number : pose_columns(pose)) EXPECT_TRUE(std::isnan(number));
}

TEST(RowLayout, IsPacked) {
  const RowLayout layout = layout_of({true, true, true, true, true});
  std::size_t at = 0;
  for (const Column& column : layout.columns) {
    EXPECT_EQ(column.offset, at) << column.name;
    at += bytes_of(column.type);
  }
  EXPECT_EQ(layout.bytes, at);
}

TEST(RowLayout, HoldsEachNumberInItsColumn) {
  const RowQuestions questions{true, true, true, true, true};
  RowNumbers numbers;
  numbers.intersects = 3;
  numbers.complete = true;
  numbers.not_closed = 2;
  numbers.self_intersecting = 3;
  numbers.capped = true;
  numbers.leaf_pairs = 11;
  numbers.sphere_tests = 12;
  numbers.distance_lower = 0.25;
  numbers.distance_upper = 0.5;
  numbers.depth_lower = 0.75;
  numbers.area = 13;
  numbers.force = {1, 2, 3};
  numbers.torque = {4, 5, -0.0};
  const RowLayout layout = layout_of(questions);
  std::vector<std::byte> row(layout.bytes);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // a quarter turn about z
  pose.translation() = Eigen::Vector3d(7, 8, 9);
  write_row(questions, {.index = std::uint64_t{1} << 40, .pose = pose}, numbers, row);
  const double half = std::sqrt(0.5);
  const std::map<std::string, double> known = {{"index", 1099511627776.0},
                                               {"x", 7},
                                               {"y", 8},
                                               {"z", 9},
                                               {"qx", 0},
                                               {"qy", 0},
                                               {"qz", half},
                                               {"qw", half},
                                               {"status", 0},
                                               {"complete", 1},
                                               {"intersects", 3},
                                               {"not_closed", 2},
                                               {"self_intersecting", 3},
                                               {"capped", 1},
                                               {"sphere_tests", 12},
                                               {"leaf_pairs", 11},
                                               {"distance_lower", .25},
                                               {"distance_upper", .5},
                                               {"depth_lower", .75},
                                               {"area", 13},
                                               {"force_x", 1},
                                               {"force_y", 2},
                                               {"force_z", 3},
                                               {"torque_x", 4},
                                               {"torque_y", 5},
                                               {"torque_z", -0.0}};
  const auto value = [&]<typename T>(const Column& column, T number) {
    std::memcpy(&number, row.data() + column.offset, sizeof(number));
    return static_cast<double>(number);
  };
  for (const Column& column : layout.columns) {
    const double found = column.type == ColumnType::kInt32    ? value(column, std::int32_t{})
                         : column.type == ColumnType::kUint64 ? value(column, std::uint64_t{})
                                                              : value(column, double{});
    if (column.name == "depth_upper") {
      EXPECT_TRUE(std::isnan(found));
      continue;
    }
    ASSERT_TRUE(known.contains(column.name)) << column.name;
    EXPECT_DOUBLE_EQ(found, known.at(column.name)) << column.name;
    EXPECT_EQ(std::signbit(found), std::signbit(known.at(column.name))) << column.name;
  }
}

TEST(RowLayout, AnInvalidPoseHasItsStatus) {
  RowNumbers numbers;
  numbers.pose_is_valid = false;
  const RowQuestions questions{.intersects = true};
  std::vector<std::byte> row(layout_of(questions).bytes);
  write_row(questions, {.index = 5, .pose = Eigen::Isometry3d::Identity()}, numbers, row);
  std::int32_t status = 0;
  std::memcpy(&status, row.data() + 8 + 7 * sizeof(double), sizeof(status));
  EXPECT_EQ(status, 120);  // IST_POSE_INVALID
}

}  // namespace
}  // namespace ist::test
