// The columns of rows, and the numbers in them.

#include "sweep/row_layout.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace ist::test {
namespace {

std::vector<std::string> names_of(const RowLayout& layout) {
  std::vector<std::string> names;
  for (const Column& column : layout.columns) names.push_back(column.name);
  return names;
}

using Names = std::vector<std::string>;

TEST(RowLayout, HasTheColumnsOfTheQuestions) {
  EXPECT_EQ(names_of(layout_of({.intersects = true})),
            (Names{"index", "status", "complete", "intersects", "sphere_tests"}));
  EXPECT_EQ(names_of(layout_of({.leaf_pairs = true})),
            (Names{"index", "status", "complete", "sphere_tests", "leaf_pairs"}));
  EXPECT_EQ(
      names_of(layout_of({.distance = true, .penetration = true})),
      (Names{"index", "status", "complete", "not_closed", "self_intersecting", "capped",
             "sphere_tests", "distance_lower", "distance_upper", "depth_lower", "depth_upper"}));
  EXPECT_EQ(names_of(layout_of({.contacts = true})),
            (Names{"index", "status", "complete", "sphere_tests", "leaf_pairs", "area", "force_x",
                   "force_y", "force_z", "torque_x", "torque_y", "torque_z"}));
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
  write_row(questions, std::uint64_t{1} << 40, numbers, row);
  const std::map<std::string, double> known = {{"index", 1099511627776.0},
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
    EXPECT_EQ(found, known.at(column.name)) << column.name;
    EXPECT_EQ(std::signbit(found), std::signbit(known.at(column.name))) << column.name;
  }
}

TEST(RowLayout, AnInvalidPoseHasItsStatus) {
  RowNumbers numbers;
  numbers.pose_is_valid = false;
  const RowQuestions questions{.intersects = true};
  std::vector<std::byte> row(layout_of(questions).bytes);
  write_row(questions, 5, numbers, row);
  std::int32_t status = 0;
  std::memcpy(&status, row.data() + 8, sizeof(status));
  EXPECT_EQ(status, 120);  // IST_POSE_INVALID
}

}  // namespace
}  // namespace ist::test
