#include "ist/sweep/parquet_writer.h"

#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

#include "ist/base/assert.h"

namespace ist {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the file is little-endian, and values are written as they lie in memory");

// Numbers of the format's enums.
enum class ParquetType : std::int32_t { kInt32 = 1, kInt64 = 2, kDouble = 5 };
constexpr std::int32_t kUint64Converted = 14;
constexpr std::int32_t kRequired = 0;
constexpr std::int32_t kPlainEncoding = 0, kRunLengthEncoding = 3;
constexpr std::int32_t kDataPage = 0;
constexpr std::int32_t kUncompressed = 0;
constexpr std::int32_t kFormatVersion = 1;

constexpr std::string_view kParquetMagic = "PAR1";
constexpr std::size_t kMostFooterBytes = 0x7FFFFFFF;

std::int32_t parquet_type(ColumnType type) {
  if (type == ColumnType::kInt32) return static_cast<std::int32_t>(ParquetType::kInt32);
  if (type == ColumnType::kUint64) return static_cast<std::int32_t>(ParquetType::kInt64);
  return static_cast<std::int32_t>(ParquetType::kDouble);
}

// A SchemaElement.
ThriftStruct schema_column(const Column& column) {
  ThriftStruct element;
  element.i32(1, parquet_type(column.type)).i32(3, kRequired).binary(4, column.name);
  if (column.type == ColumnType::kUint64) {
    // Older readers know the converted type, newer ones the logical type INTEGER(64, unsigned).
    const ThriftStruct integer = ThriftStruct().i8(1, 64).boolean(2, false);
    element.i32(6, kUint64Converted).structure(10, ThriftStruct().structure(10, integer));
  }
  return element;
}

// The root, and its columns.
std::vector<ThriftStruct> schema_of(const RowLayout& layout) {
  std::vector<ThriftStruct> schema;
  schema.push_back(
      ThriftStruct().binary(4, "schema").i32(5, static_cast<std::int32_t>(layout.columns.size())));
  for (const Column& column : layout.columns) schema.push_back(schema_column(column));
  return schema;
}

// A PageHeader. It must name encodings of the levels, which this page does not have.
std::string page_header(std::size_t rows, std::size_t bytes) {
  const auto count = static_cast<std::int32_t>(rows);
  const auto size = static_cast<std::int32_t>(bytes);
  const ThriftStruct values = ThriftStruct()
                                  .i32(1, count)
                                  .i32(2, kPlainEncoding)
                                  .i32(3, kRunLengthEncoding)
                                  .i32(4, kRunLengthEncoding);
  return ThriftStruct().i32(1, kDataPage).i32(2, size).i32(3, size).structure(5, values).bytes();
}

// A ColumnChunk. Its own offset is deprecated, and 0; that of its page counts.
ThriftStruct column_chunk(const Column& column, std::size_t rows, std::int64_t bytes,
                          std::int64_t page_offset) {
  const std::array path{std::string_view(column.name)};
  const ThriftStruct metadata = ThriftStruct()
                                    .i32(1, parquet_type(column.type))
                                    .i32_list(2, std::array{kPlainEncoding})
                                    .binary_list(3, path)
                                    .i32(4, kUncompressed)
                                    .i64(5, static_cast<std::int64_t>(rows))
                                    .i64(6, bytes)
                                    .i64(7, bytes)
                                    .i64(9, page_offset);
  return ThriftStruct().i64(2, 0).structure(3, metadata);
}

// Appends the value that each row of `stride` bytes has at `offset`.
template <std::size_t kBytes>
void append_values(std::span<const std::byte> rows, std::size_t stride, std::size_t offset,
                   std::vector<std::byte>& chunk) {
  const std::size_t before = chunk.size(), count = rows.size() / stride;
  chunk.resize(before + count * kBytes);
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(&chunk[before + i * kBytes], &rows[i * stride + offset], kBytes);
  }
}

}  // namespace

ParquetWriter::ParquetWriter(OutputFile& file, const RowLayout& layout, std::size_t rows_a_group)
    : file_(file), layout_(layout), rows_a_group_(rows_a_group), chunks_(layout.columns.size()) {
  IST_ASSERT(!layout.columns.empty());
  IST_ASSERT(rows_a_group >= 1 && rows_a_group <= kMostRowsAGroup);
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    chunks_[i].reserve(rows_a_group * bytes_of(layout.columns[i].type));
  }
  write(kParquetMagic.data(), kParquetMagic.size());
}

void ParquetWriter::add(std::span<const std::byte> rows) {
  IST_ASSERT(!finished_ && rows.size() % layout_.bytes == 0);
  while (!rows.empty()) {
    const std::size_t bytes = std::min(rows.size(), (rows_a_group_ - rows_) * layout_.bytes);
    keep(rows.first(bytes));
    rows = rows.subspan(bytes);
    if (rows_ == rows_a_group_) write_group();
  }
}

void ParquetWriter::finish() {
  IST_ASSERT(!finished_);
  finished_ = true;
  if (rows_ > 0) write_group();
  const std::string footer = ThriftStruct()
                                 .i32(1, kFormatVersion)
                                 .struct_list(2, schema_of(layout_))
                                 .i64(3, all_rows_)
                                 .struct_list(4, groups_)
                                 .binary(6, "ist")
                                 .bytes();
  IST_ASSERT(footer.size() <= kMostFooterBytes);
  write(footer.data(), footer.size());
  const auto length = static_cast<std::uint32_t>(footer.size());
  write(&length, sizeof length);
  write(kParquetMagic.data(), kParquetMagic.size());
}

void ParquetWriter::keep(std::span<const std::byte> rows) {
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    const Column& column = layout_.columns[i];
    if (bytes_of(column.type) == 4) {
      append_values<4>(rows, layout_.bytes, column.offset, chunks_[i]);
    } else {
      append_values<8>(rows, layout_.bytes, column.offset, chunks_[i]);
    }
  }
  rows_ += rows.size() / layout_.bytes;
}

void ParquetWriter::write_group() {
  std::vector<ThriftStruct> columns;
  const std::int64_t begin = written_;
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    const std::int64_t page = written_;
    const std::string header = page_header(rows_, chunks_[i].size());
    write(header.data(), header.size());
    write(chunks_[i].data(), chunks_[i].size());
    columns.push_back(column_chunk(layout_.columns[i], rows_, written_ - page, page));
    chunks_[i].clear();
  }
  const auto rows = static_cast<std::int64_t>(rows_);
  // Its size counts the headers of the pages, as the sizes of the chunks do.
  groups_.push_back(ThriftStruct().struct_list(1, columns).i64(2, written_ - begin).i64(3, rows));
  all_rows_ += rows;
  rows_ = 0;
}

void ParquetWriter::write(const void* data, std::size_t bytes) {
  file_.write(data, bytes);
  written_ += static_cast<std::int64_t>(bytes);
}

}  // namespace ist
