#include "sweep/row_layout.h"

#include <array>
#include <cstring>

#include "ist/base/assert.h"

namespace ist {
namespace {

constexpr std::int32_t kPoseInvalid = 120;  // the code of the C interface

// Calls `column(name, type, value)` for each column in order.
template <typename Each>
void each_column(const RowQuestions& asked, std::uint64_t index, const RowNumbers& numbers,
                 const Each& column) {
  const auto whole = [&](const char* name, std::uint64_t value) {
    column(name, ColumnType::kUint64, value);
  };
  const auto code = [&](const char* name, std::int32_t value) {
    column(name, ColumnType::kInt32, value);
  };
  const auto real = [&](const char* name, double value) {
    column(name, ColumnType::kFloat64, value);
  };
  const auto vector = [&](const std::array<const char*, 3>& names, const Eigen::Vector3d& value) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      real(names[axis], value[static_cast<Eigen::Index>(axis)]);
    }
  };
  whole("index", index);
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

RowLayout layout_of(const RowQuestions& questions) {
  RowLayout layout;
  each_column(questions, 0, RowNumbers(),
              [&](const char* name, ColumnType type, auto) { layout.add(name, type); });
  return layout;
}

void write_row(const RowQuestions& questions, std::uint64_t index, const RowNumbers& numbers,
               std::span<std::byte> row) {
  std::size_t at = 0;
  each_column(questions, index, numbers, [&](const char*, ColumnType, auto value) {
    IST_ASSERT(at + sizeof(value) <= row.size());
    std::memcpy(row.data() + at, &value, sizeof(value));
    at += sizeof(value);
  });
}

}  // namespace ist
