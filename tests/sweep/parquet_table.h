#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ist/sweep/columns.h"

namespace ist::test {

/// The content of a Parquet file, by the specification of the format.
struct ParquetTable {
  std::vector<Column> columns;           // offset: 0
  std::vector<std::string> values;       // of each column, one after the other
  std::vector<std::int64_t> group_rows;  // rows of each row group
};

/// Reads a file of one data page a column chunk, PLAIN, uncompressed, without levels. Throws
/// std::runtime_error where the file, or what it says of itself, is not so.
[[nodiscard]] ParquetTable read_parquet(std::string_view file);

/// Packed rows of that layout whose bytes are drawn.
[[nodiscard]] std::vector<std::byte> drawn_rows(const RowLayout& layout, std::size_t rows);

/// The values that packed rows have in each column.
[[nodiscard]] std::vector<std::string> columns_of(const RowLayout& layout,
                                                  std::span<const std::byte> rows);

}  // namespace ist::test
