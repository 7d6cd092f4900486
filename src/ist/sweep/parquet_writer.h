#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/base/files.h"
#include "ist/sweep/columns.h"
#include "ist/sweep/thrift_struct.h"

namespace ist {

/// Writes a table of rows as a Parquet file, which data frames and databases read.
///
/// Source: Apache Parquet's format, README.md and src/main/thrift/parquet.thrift. The file begins
/// and ends with "PAR1". Between them are the row groups, the footer (a Thrift struct) and the
/// footer's length. A row group has a chunk of each column, and a chunk is one data page of version
/// 1: its header, and the values as they lie in memory (encoding PLAIN), uncompressed. Each row has
/// a value in each column (REQUIRED), so a page has no levels. A kUint64 is an INT64 of the logical
/// type INTEGER(64, unsigned), a kInt32 an INT32, a kFloat64 a DOUBLE, with every bit of a NaN. The
/// file has no statistics.
///
/// Memory: the rows of a group, reserved at once, and for the footer some 60 bytes for each chunk.
/// The same rows give the same bytes, in whichever pieces they are added. Every function throws
/// kFileUnwritable, and then the file is of no use.
class ParquetWriter {
 public:
  /// Rows of a row group, unless the caller says otherwise.
  static constexpr std::size_t kRowsAGroup = 1 << 17;
  /// The most rows of a row group: a page's size in bytes is an int32.
  static constexpr std::size_t kMostRowsAGroup = 0x7FFFFFFF / 8;
  static_assert(kRowsAGroup <= kMostRowsAGroup);
  /// The most row groups of rows_a_group_of(): their descriptions fit into a footer, whose size is
  /// an int32 too.
  static constexpr std::uint64_t kMostGroups = 1 << 19;

  /// Returns the rows of each row group of a table of `rows` rows: kRowsAGroup, and more where the
  /// groups would be more than kMostGroups.
  [[nodiscard]] static constexpr std::size_t rows_a_group_of(std::uint64_t rows) noexcept {
    return std::max<std::uint64_t>(kRowsAGroup, (rows + kMostGroups - 1) / kMostGroups);
  }

  /// Writes the file's first bytes.
  ///
  /// @param file an empty file, which outlives the writer
  /// @param layout at least one column; the names are UTF-8
  /// @param rows_a_group rows of a row group, but the last; from 1 to kMostRowsAGroup
  ParquetWriter(OutputFile& file, const RowLayout& layout, std::size_t rows_a_group = kRowsAGroup);

  /// Adds packed rows, layout.bytes each; any number of them at a time.
  void add(std::span<const std::byte> rows);
  /// Writes the last group and the footer. The file is not committed: its owner does. Neither
  /// function may be called again.
  void finish();

 private:
  void keep(std::span<const std::byte> rows);
  void write_group();
  void write(const void* data, std::size_t bytes);

  OutputFile& file_;
  RowLayout layout_;
  std::size_t rows_a_group_;
  std::vector<std::vector<std::byte>> chunks_;  // the values of the group's rows, by column
  std::size_t rows_ = 0;                        // of the group
  std::int64_t all_rows_ = 0;                   // of the groups that are written
  std::int64_t written_ = 0;                    // bytes
  std::vector<ThriftStruct> groups_;            // as the footer describes them
  bool finished_ = false;
};

}  // namespace ist
