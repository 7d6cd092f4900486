#include "sweep/row_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "ist/base/assert.h"
#include "ist/base/pose.h"

namespace ist {
namespace {

constexpr std::int32_t kPoseInvalid = 120;  // the code of the C interface

using Quaternion = std::array<double, 4>;  // x, y, z, w

// Returns the unit quaternion of a rotation, with w >= 0. The largest of its four numbers is found
// first, so that no digit is lost. Source: S. W. Shepperd, Quaternion from rotation matrix, J.
// Guidance and Control 1(3), 1978.
Quaternion quaternion_of(const Eigen::Matrix3d& r) noexcept {
  const double x = r(0, 0), y = r(1, 1), z = r(2, 2);
  // Four times the square of each number.
  const Quaternion squares = {(1 + x) - (y + z), (1 + y) - (x + z), (1 + z) - (x + y),
                              (1 + x) + (y + z)};
  const auto largest =
      static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) - squares.begin());
  const double turn_x = r(2, 1) - r(1, 2), turn_y = r(0, 2) - r(2, 0), turn_z = r(1, 0) - r(0, 1);
  const double xy = r(0, 1) + r(1, 0), xz = r(0, 2) + r(2, 0), yz = r(1, 2) + r(2, 1);
  // Rows: four times the largest number times each number.
  const std::array<Quaternion, 4> products = {{{squares[0], xy, xz, turn_x},
                                               {xy, squares[1], yz, turn_y},
                                               {xz, yz, squares[2], turn_z},
                                               {turn_x, turn_y, turn_z, squares[3]}}};
  Quaternion found = products[largest];
  const double scale = (found[3] < 0 ? -0.5 : 0.5) / std::sqrt(squares[largest]);
  for (double& number : found) number *= scale;
  return found;
}

// The place and the quaternion of a pose, in the order of their columns.
std::array<double, 7> numbers_of(const Eigen::Isometry3d& pose) noexcept {
  constexpr double kNone = RowNumbers::kNone;
  const std::optional<Eigen::Isometry3d> rigid = project_to_rigid(pose);
  if (!rigid) return {kNone, kNone, kNone, kNone, kNone, kNone, kNone};
  const Quaternion turn = quaternion_of(rigid->linear());
  return {(*rigid)(0, 3), (*rigid)(1, 3), (*rigid)(2, 3), turn[0], turn[1], turn[2], turn[3]};
}

// Calls `column(name, type, value)` for each column in order. `names` belong to pose.values, or are
// empty if `column` ignores names.
template <typename Each>
void each_column(const RowQuestions& asked, std::span<const std::string> names, const RowPose& pose,
                 const RowNumbers& numbers, const Each& column) {
  const auto whole = [&](const char* name, std::uint64_t value) {
    column(name, ColumnType::kUint64, value);
  };
  const auto code = [&](const char* name, std::int32_t value) {
    column(name, ColumnType::kInt32, value);
  };
  const auto real = [&](const char* name, double value) {
    column(name, ColumnType::kFloat64, value);
  };
  const auto vector = [&](const std::array<const char*, 3>& axes, const Eigen::Vector3d& value) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      real(axes[axis], value[static_cast<Eigen::Index>(axis)]);
    }
  };
  whole("index", pose.index);
  for (std::size_t i = 0; i < pose.values.size(); ++i) {
    real(names.empty() ? "" : names[i].c_str(), pose.values[i]);
  }
  constexpr std::array kPoseNames = {"x", "y", "z", "qx", "qy", "qz", "qw"};
  const std::array<double, 7> place = numbers_of(pose.pose);
  for (std::size_t i = 0; i < place.size(); ++i) real(kPoseNames[i], place[i]);
  code("status", numbers.pose_is_valid ? 0 : kPoseInvalid);
  code("complete", numbers.complete ? 1 : 0);
  if (asked.intersects) code("intersects", numbers.intersects);
  if (asked.penetration) {
    code("not_closed", numbers.not_closed);
    code("self_intersecting", numbers.self_intersecting);
    code("capped", numbers.capped ? 1 : 0);
  }
  whole("sphere_tests", numbers.sphere_tests);
  if (asked.leaf_pairs || asked.contacts) whole("leaf_pairs", numbers.leaf_pairs);
  if (asked.distance) {
    real("distance_lower", numbers.distance_lower);
    real("distance_upper", numbers.distance_upper);
  }
  if (asked.penetration) {
    real("depth_lower", numbers.depth_lower);
    real("depth_upper", numbers.depth_upper);
  }
  if (asked.contacts) {
    real("area", numbers.area);
    vector({"force_x", "force_y", "force_z"}, numbers.force);
    vector({"torque_x", "torque_y", "torque_z"}, numbers.torque);
  }
}

}  // namespace

RowLayout layout_of(const RowQuestions& questions, std::span<const std::string> values) {
  RowLayout layout;
  const std::vector<double> none(values.size());
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  each_column(questions, values, {.values = none, .pose = identity}, RowNumbers(),
              [&](const char* name, ColumnType type, auto) { layout.add(name, type); });
  return layout;
}

void write_row(const RowQuestions& questions, const RowPose& pose, const RowNumbers& numbers,
               std::span<std::byte> row) {
  std::size_t at = 0;
  each_column(questions, {}, pose, numbers, [&](const char*, ColumnType, auto value) {
    IST_ASSERT(at + sizeof(value) <= row.size());
    std::memcpy(row.data() + at, &value, sizeof(value));
    at += sizeof(value);
  });
}

}  // namespace ist
