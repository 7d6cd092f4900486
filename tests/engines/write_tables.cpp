// Writes tables as Parquet into a folder, and beside each its packed rows, NAME.rows. tables.json
// says which columns, rows and row groups each has: for parquet_test.mjs.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ist/base/files.h"
#include "ist/sweep/parquet_writer.h"
#include "sweep/parquet_table.h"

namespace {

using ist::ColumnType;
using ist::RowLayout;
using Json = nlohmann::ordered_json;
using Rows = std::vector<std::byte>;

constexpr std::size_t kRowsAPiece = 777;

RowLayout layout_of(std::size_t columns) {
  constexpr std::array kTypes{ColumnType::kUint64, ColumnType::kInt32, ColumnType::kFloat64};
  RowLayout layout;
  for (std::size_t i = 0; i < columns; ++i) {
    layout.add("column " + std::to_string(i), kTypes[i % kTypes.size()]);
  }
  return layout;
}

template <typename T>
void append_value(Rows& rows, T value) {
  const auto bytes = std::as_bytes(std::span(&value, 1));
  rows.insert(rows.end(), bytes.begin(), bytes.end());
}

// The numbers that a reader may change: those at the borders of their types, and NaNs of any bits.
Rows border_rows() {
  using Real = std::numeric_limits<double>;
  using Whole = std::numeric_limits<std::int32_t>;
  using Count = std::numeric_limits<std::uint64_t>;
  constexpr std::uint64_t kHalf = std::uint64_t{1} << 63;
  const std::array doubles{0.0,
                           -0.0,
                           Real::infinity(),
                           -Real::infinity(),
                           Real::quiet_NaN(),
                           -Real::quiet_NaN(),
                           std::bit_cast<double>(std::uint64_t{0x7FF8000000000123}),
                           Real::max(),
                           Real::lowest(),
                           Real::min(),
                           Real::denorm_min(),
                           -Real::denorm_min(),
                           0.1};
  const std::array<std::int32_t, 5> wholes{Whole::min(), -1, 0, 1, Whole::max()};
  const std::array<std::uint64_t, 6> counts{0, 1, kHalf - 1, kHalf, kHalf + 1, Count::max()};
  Rows rows;
  for (std::size_t i = 0; i < doubles.size(); ++i) {
    append_value(rows, counts[i % counts.size()]);
    append_value(rows, wholes[i % wholes.size()]);
    append_value(rows, doubles[i]);
  }
  return rows;
}

class Tables {
 public:
  explicit Tables(std::filesystem::path folder) : folder_(std::move(folder)) {}

  void write(const std::string& name, const RowLayout& layout, const Rows& rows,
             std::size_t rows_a_group = ist::ParquetWriter::kRowsAGroup) {
    ist::OutputFile parquet(folder_ / (name + ".parquet"));
    ist::ParquetWriter writer(parquet, layout, rows_a_group);
    for (std::span<const std::byte> rest = rows; !rest.empty();) {
      const std::size_t piece = std::min(rest.size(), kRowsAPiece * layout.bytes);
      writer.add(rest.first(piece));
      rest = rest.subspan(piece);
    }
    writer.finish();
    parquet.commit();
    ist::OutputFile raw(folder_ / (name + ".rows"));
    raw.write(rows.data(), rows.size());
    raw.commit();

    constexpr std::array kNames{"uint64", "int32", "float64"};
    const std::size_t count = rows.size() / layout.bytes;
    Json& table = tables_[name];
    table["rows"] = count;
    table["groups"] = (count + rows_a_group - 1) / rows_a_group;
    table["row_bytes"] = layout.bytes;
    for (const ist::Column& column : layout.columns) {
      table["columns"].push_back({{"name", column.name},
                                  {"type", kNames[static_cast<std::size_t>(column.type)]},
                                  {"offset", column.offset}});
    }
  }

  void finish() const { std::ofstream(folder_ / "tables.json") << tables_; }

 private:
  std::filesystem::path folder_;
  Json tables_;
};

void write_all(const std::filesystem::path& folder) {
  Tables tables(folder);
  const RowLayout three = layout_of(3), wide = layout_of(40);
  tables.write("borders", three, border_rows());
  tables.write("no_rows", wide, {});
  tables.write("one_row", three, ist::test::drawn_rows(three, 1));
  tables.write("two_groups", three, ist::test::drawn_rows(three, 2000), 1000);
  tables.write("many_groups", wide, ist::test::drawn_rows(wide, 5001), 100);
  tables.write("long", three, ist::test::drawn_rows(three, 300'000));
  RowLayout named;
  named.add("a.b", ColumnType::kFloat64);
  named.add("Tiefe in \xC2\xB5m", ColumnType::kInt32);
  tables.write("names", named, ist::test::drawn_rows(named, 3));
  tables.finish();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: write_tables FOLDER\n");
    return 2;
  }
  write_all(argv[1]);
}
