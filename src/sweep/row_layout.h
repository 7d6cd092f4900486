#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ist/measure/pose_rows.h"
#include "ist/measure/row_numbers.h"

namespace ist {

enum class ColumnType : std::uint8_t { kUint64, kInt32, kFloat64 };

/// Bytes of a value, which is little-endian in every file.
[[nodiscard]] constexpr std::size_t bytes_of(ColumnType type) noexcept {
  return type == ColumnType::kInt32 ? 4 : 8;
}

/// A column of a table of rows. A value stands `offset` bytes after its row's first.
struct Column {
  std::string name;
  ColumnType type;
  std::size_t offset;
};

/// The columns of a table. Its rows are packed: no byte lies between two values.
struct RowLayout {
  std::vector<Column> columns;
  std::size_t bytes = 0;  ///< of a row

  void add(std::string name, ColumnType type) {
    columns.push_back({std::move(name), type, bytes});
    bytes += bytes_of(type);
  }
};

/// The version of the columns. Folders of rows of another version are refused.
inline constexpr std::uint64_t kRowLayoutVersion = 2;

/// A pose as a row holds it.
struct RowPose {
  std::uint64_t index = 0;
  std::span<const double> values = {};  ///< of the named axes of a grid
  const Eigen::Isometry3d& pose;
};

/// Returns the columns of a row: `index`; one for each name in `values`; the pose as `x`, `y`, `z`
/// and the unit quaternion `qx`, `qy`, `qz`, `qw`; `status`, `complete`; then the
/// answers to each question.
[[nodiscard]] RowLayout layout_of(const RowQuestions& questions,
                                  std::span<const std::string> values = {});

/// Writes a row of that layout. The pose is the nearest rigid motion, and `qw` is not negative. If
/// the pose is not a rigid motion, its columns are NaN.
void write_row(const RowQuestions& questions, const RowPose& pose, const RowNumbers& numbers,
               std::span<std::byte> row);

}  // namespace ist
