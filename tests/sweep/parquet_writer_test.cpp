#include "ist/sweep/parquet_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "ist/base/files.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/largest_allocation.h"
#include "support/random.h"
#include "support/skip.h"
#include "support/temp_dir.h"
#include "sweep/hex.h"
#include "sweep/parquet_table.h"

namespace ist::test {
namespace {

using Rows = std::vector<std::byte>;

template <typename T>
void append_value(Rows& rows, T value) {
  const auto bytes = std::as_bytes(std::span(&value, 1));
  rows.insert(rows.end(), bytes.begin(), bytes.end());
}

RowLayout three_types() {
  RowLayout layout;
  layout.add("n", ColumnType::kUint64);
  layout.add("k", ColumnType::kInt32);
  layout.add("x", ColumnType::kFloat64);
  return layout;
}

// The file of these rows, added in pieces of `piece` rows, or at once.
std::string parquet_of(const RowLayout& layout, std::span<const std::byte> rows,
                       std::size_t rows_a_group, std::size_t piece = 0) {
  const TempDir dir;
  OutputFile file(dir.path() / "rows.parquet");
  ParquetWriter writer(file, layout, rows_a_group);
  const std::size_t bytes =
      piece == 0 ? std::max<std::size_t>(rows.size(), 1) : piece * layout.bytes;
  for (std::size_t at = 0; at < rows.size(); at += bytes) {
    writer.add(rows.subspan(at, std::min(bytes, rows.size() - at)));
  }
  writer.finish();
  file.commit();
  return file_content(file.target());
}

void expect_same_table(const std::string& file, const RowLayout& layout,
                       std::span<const std::byte> rows, std::vector<std::int64_t> group_rows) {
  const ParquetTable table = read_parquet(file);
  ASSERT_EQ(table.columns.size(), layout.columns.size());
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    EXPECT_EQ(table.columns[i].name, layout.columns[i].name);
    EXPECT_EQ(table.columns[i].type, layout.columns[i].type);
  }
  EXPECT_EQ(table.group_rows, group_rows);
  EXPECT_TRUE(table.values == columns_of(layout, rows));
}

// Worked out by hand from parquet.thrift and the specification of the compact protocol.
TEST(ParquetWriter, HasTheBytesOfTheFormat) {
  Rows rows;
  append_value(rows, std::uint64_t{1});
  append_value(rows, std::int32_t{-2});
  append_value(rows, 1.5);
  append_value(rows, std::numeric_limits<std::uint64_t>::max());
  append_value(rows, std::numeric_limits<std::int32_t>::min());
  append_value(rows, -0.0);
  const std::string expected =
      "50 41 52 31 "  // PAR1
      // At 4, the page of n: a data page of 16 bytes, twice said, with 2 values, PLAIN, RLE, RLE.
      "15 00 15 20 15 20 2C 15 04 15 00 15 06 15 06 00 00 "
      "01 00 00 00 00 00 00 00 FF FF FF FF FF FF FF FF "
      // At 37, the page of k: 8 bytes.
      "15 00 15 10 15 10 2C 15 04 15 00 15 06 15 06 00 00 "
      "FE FF FF FF 00 00 00 80 "
      // At 62, the page of x: 16 bytes.
      "15 00 15 20 15 20 2C 15 04 15 00 15 06 15 06 00 00 "
      "00 00 00 00 00 00 F8 3F 00 00 00 00 00 00 00 80 "
      // At 95, the footer: version 1, then a schema of four elements. The root has three children.
      "15 02 19 4C "
      "48 06 73 63 68 65 6D 61 15 06 00 "
      // n: INT64, required, named, UINT_64, and INTEGER(64, unsigned).
      "15 04 25 00 18 01 6E 25 1C 4C AC 13 40 12 00 00 00 "
      // k: INT32; x: DOUBLE.
      "15 02 25 00 18 01 6B 00 "
      "15 0A 25 00 18 01 78 00 "
      // Two rows, and one row group of three chunks.
      "16 04 19 1C 19 3C "
      // Of n: offset 0; INT64, PLAIN, path n, uncompressed, 2 values, 33 bytes twice, page at 4.
      "26 00 1C 15 04 19 15 00 19 18 01 6E 15 00 16 04 16 42 16 42 26 08 00 00 "
      // Of k: 25 bytes at 37. Of x: 33 bytes at 62.
      "26 00 1C 15 02 19 15 00 19 18 01 6B 15 00 16 04 16 32 16 32 26 4A 00 00 "
      "26 00 1C 15 0A 19 15 00 19 18 01 78 15 00 16 04 16 42 16 42 26 7C 00 00 "
      // The group: 91 bytes, 2 rows. Created by ist.
      "16 B6 01 16 04 00 28 03 69 73 74 00 "
      // The footer's 138 bytes, and PAR1.
      "8A 00 00 00 50 41 52 31";
  EXPECT_EQ(hex(parquet_of(three_types(), rows, 1000)), expected);
}

TEST(ParquetWriter, WithoutRowsHasTheSchemaAndNoGroup) {
  RowLayout layout;
  layout.add("k", ColumnType::kInt32);
  // Version 1, the root and k, 0 rows, a list of 0 structs, created by ist; 33 bytes.
  EXPECT_EQ(hex(parquet_of(layout, {}, 1000)),
            "50 41 52 31 15 02 19 2C 48 06 73 63 68 65 6D 61 15 02 00 15 02 25 00 18 01 6B 00 "
            "16 00 19 0C 28 03 69 73 74 00 21 00 00 00 50 41 52 31");
}

TEST(ParquetWriter, GroupsEndWhereTheyAreFull) {
  const RowLayout layout = three_types();
  const std::vector<std::pair<std::size_t, std::vector<std::int64_t>>> cases{
      {1, {1}},         {99, {99}},        {100, {100}},         {101, {100, 1}},
      {199, {100, 99}}, {200, {100, 100}}, {201, {100, 100, 1}}, {350, {100, 100, 100, 50}},
  };
  for (const auto& [count, groups] : cases) {
    const Rows rows = drawn_rows(layout, count);
    expect_same_table(parquet_of(layout, rows, 100), layout, rows, groups);
  }
}

TEST(ParquetWriter, PiecesOfAnySizeGiveTheSameBytes) {
  const RowLayout layout = three_types();
  const Rows rows = drawn_rows(layout, 100);
  const std::string whole = parquet_of(layout, rows, 7);
  expect_same_table(whole, layout, rows, {7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 2});
  for (const std::size_t piece : {1u, 2u, 3u, 6u, 7u, 8u, 13u, 14u, 15u, 50u, 99u}) {
    EXPECT_TRUE(parquet_of(layout, rows, 7, piece) == whole) << piece;
  }
  Random random(1);
  for (int i = 0; i < samples(20); ++i) {
    const TempDir dir;
    OutputFile file(dir.path() / "rows.parquet");
    ParquetWriter writer(file, layout, 7);
    for (std::span<const std::byte> rest = rows; !rest.empty();) {
      const std::size_t count = std::min<std::size_t>(random.below(20), rest.size() / layout.bytes);
      writer.add(rest.first(count * layout.bytes));
      rest = rest.subspan(count * layout.bytes);
    }
    writer.finish();
    file.commit();
    EXPECT_TRUE(file_content(file.target()) == whole);
  }
}

TEST(ParquetWriter, HasManyColumnsOfAnyName) {
  RowLayout layout;
  for (int i = 0; i < 40; ++i) {
    layout.add("column " + std::to_string(i), static_cast<ColumnType>(i % 3));
  }
  layout.add("a.b", ColumnType::kInt32);
  layout.add("Tiefe in µm", ColumnType::kFloat64);
  layout.add(std::string(300, 'n'), ColumnType::kUint64);
  const Rows rows = drawn_rows(layout, 50);
  expect_same_table(parquet_of(layout, rows, 30), layout, rows, {30, 20});
}

TEST(ParquetWriter, AGroupHas131072RowsByItself) {
  RowLayout layout;
  layout.add("k", ColumnType::kInt32);
  const Rows rows = drawn_rows(layout, 131073);
  const TempDir dir;
  OutputFile file(dir.path() / "rows.parquet");
  ParquetWriter writer(file, layout);
  writer.add(rows);
  writer.finish();
  file.commit();
  expect_same_table(file_content(file.target()), layout, rows, {131072, 1});
}

// Its size is an int32, and a chunk takes some 60 bytes of it.
TEST(ParquetWriter, TheFooterOfAnyTableHasRoom) {
  constexpr std::uint64_t kMostRows = 1'000'000'000'000, kColumns = 40, kChunk = 80;
  for (const std::uint64_t rows : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1} << 36,
                                   (std::uint64_t{1} << 36) + 1, kMostRows}) {
    const std::uint64_t group = ParquetWriter::rows_a_group_of(rows);
    EXPECT_EQ(group == ParquetWriter::kRowsAGroup, rows <= std::uint64_t{1} << 36) << rows;
    EXPECT_LE(group, ParquetWriter::kMostRowsAGroup) << rows;
    EXPECT_LT((rows + group - 1) / group * kColumns * kChunk, std::uint64_t{1} << 31) << rows;
  }
}

TEST(ParquetWriter, KeepsAGroupInMemoryAndNoMore) {
  const RowLayout layout = three_types();
  const Rows rows = drawn_rows(layout, 7000);
  const std::size_t group = 10000 * layout.bytes;
  const TempDir dir;
  OutputFile file(dir.path() / "rows.parquet");
  const std::size_t peak = peak_allocation([&] {
    ParquetWriter writer(file, layout, 10000);
    for (int i = 0; i < 20; ++i) writer.add(rows);
    writer.finish();
  });
  EXPECT_GE(peak, group);
  EXPECT_LE(peak, group + group / 10);
}

TEST(ParquetWriter, LeavesTheFileToItsOwner) {
  const RowLayout layout = three_types();
  const TempDir dir;
  {
    OutputFile file(dir.path() / "rows.parquet");
    ParquetWriter writer(file, layout);
    writer.add(drawn_rows(layout, 3));
    writer.finish();
    EXPECT_FALSE(std::filesystem::exists(file.target()));
  }
  EXPECT_EQ(dir.entries(), 0u);
}

TEST(ParquetWriter, SaysThatTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) IST_SKIP("/dev/full is not there");
  OutputFile file("/dev/full");
  EXPECT_EQ(error_name([&] { ParquetWriter(file, three_types()); }), "file-unwritable");
}

}  // namespace
}  // namespace ist::test
