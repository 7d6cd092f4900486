#pragma once

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

/// Returns the columns of the answers to these questions: `index`, `status`, `complete`, then those
/// of each question.
[[nodiscard]] RowLayout layout_of(const RowQuestions& questions);

/// Writes a row of that layout.
void write_row(const RowQuestions& questions, std::uint64_t index, const RowNumbers& numbers,
               std::span<std::byte> row);

}  // namespace ist
