#include "sweep/parquet_table.h"

#include <cstring>
#include <stdexcept>

#include "support/random.h"
#include "sweep/thrift_reader.h"

namespace ist::test {
namespace {

void need(bool condition, const char* what) {
  if (!condition) throw std::runtime_error(std::string("not so: ") + what);
}

Column column_of_element(const ThriftValue& element) {
  need(element.at(3).type == 5 && element.at(3).number == 0, "the column is required");
  Column column{element.at(4).text, ColumnType::kInt32, 0};
  const std::int64_t type = element.at(1).number;
  need(type == 1 || type == 2 || type == 5, "a type is INT32, INT64 or DOUBLE");
  if (type == 5) column.type = ColumnType::kFloat64;
  if (type == 2) {
    column.type = ColumnType::kUint64;
    need(element.at(6).number == 14, "an INT64 is converted to UINT_64");
    const ThriftValue& integer = element.at(10).at(10);
    need(integer.at(1).type == 3 && integer.at(1).number == 64, "of 64 bits");
    need(integer.at(2).type == 2, "and has no sign");
  } else {
    need(!element.has(6) && !element.has(10), "other types say all by themselves");
  }
  return column;
}

// Returns the values of a chunk that begins at `begin`, and moves it to the chunk's end.
std::string values_of_chunk(std::string_view file, const ThriftValue& chunk, const Column& column,
                            std::int64_t rows, std::size_t& begin) {
  const ThriftValue& metadata = chunk.at(3);
  const std::int64_t type = column.type == ColumnType::kInt32    ? 1
                            : column.type == ColumnType::kUint64 ? 2
                                                                 : 5;
  need(metadata.at(1).number == type, "the chunk has the type of its column");
  need(metadata.at(2).elements.size() == 1 && metadata.at(2).elements[0].number == 0, "PLAIN");
  need(metadata.at(3).elements.size() == 1 && metadata.at(3).elements[0].text == column.name,
       "the path is the name");
  need(metadata.at(4).number == 0, "uncompressed");
  need(metadata.at(5).number == rows, "the chunk has the rows of its group");
  need(metadata.at(9).number == static_cast<std::int64_t>(begin), "pages follow one another");

  ThriftReader reader(file.substr(begin));
  const ThriftValue page = reader.read_struct();
  const std::size_t bytes = static_cast<std::size_t>(rows) * bytes_of(column.type);
  need(page.at(1).number == 0, "a data page of version 1");
  need(page.at(2).number == static_cast<std::int64_t>(bytes), "the page has its values alone");
  need(page.at(3).number == page.at(2).number, "the page is not compressed");
  need(page.at(5).at(1).number == rows, "the page has the rows of its group");
  need(page.at(5).at(2).number == 0, "the page is PLAIN");
  need(page.at(5).has(3) && page.at(5).has(4), "the page names encodings of levels");
  const std::size_t whole = reader.position() + bytes;
  need(metadata.at(6).number == static_cast<std::int64_t>(whole), "the size of the chunk");
  need(metadata.at(7).number == metadata.at(6).number, "the compressed size of the chunk");
  begin += whole;
  return std::string(file.substr(begin - bytes, bytes));
}

}  // namespace

ParquetTable read_parquet(std::string_view file) {
  need(file.size() > 12 && file.substr(0, 4) == "PAR1", "the file begins with PAR1");
  need(file.substr(file.size() - 4) == "PAR1", "the file ends with PAR1");
  std::uint32_t length = 0;
  std::memcpy(&length, file.data() + file.size() - 8, sizeof length);
  need(length <= file.size() - 12, "the footer is in the file");
  const std::size_t footer_begin = file.size() - 8 - length;
  ThriftReader reader(file.substr(footer_begin, length));
  const ThriftValue footer = reader.read_struct();
  need(reader.position() == length, "the footer is as long as it says");
  need(footer.at(1).number == 1, "version 1");
  need(footer.at(6).text == "ist", "created by ist");

  ParquetTable table;
  const std::vector<ThriftValue>& schema = footer.at(2).elements;
  need(schema.at(0).at(5).number == static_cast<std::int64_t>(schema.size()) - 1,
       "the root counts its columns");
  for (std::size_t i = 1; i < schema.size(); ++i) {
    table.columns.push_back(column_of_element(schema[i]));
  }
  table.values.resize(table.columns.size());

  std::size_t position = 4;
  std::int64_t all_rows = 0;
  for (const ThriftValue& group : footer.at(4).elements) {
    const std::int64_t rows = group.at(3).number;
    const std::size_t begin = position;
    need(group.at(1).elements.size() == table.columns.size(), "a group has a chunk a column");
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      table.values[i] +=
          values_of_chunk(file, group.at(1).elements[i], table.columns[i], rows, position);
    }
    need(group.at(2).number == static_cast<std::int64_t>(position - begin), "the group's size");
    table.group_rows.push_back(rows);
    all_rows += rows;
  }
  need(position == footer_begin, "nothing stands between the groups and the footer");
  need(footer.at(3).number == all_rows, "the groups have all rows");
  return table;
}

std::vector<std::byte> drawn_rows(const RowLayout& layout, std::size_t rows) {
  Random random(20240611);
  std::vector<std::byte> bytes(layout.bytes * rows);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random.below(256));
  return bytes;
}

std::vector<std::string> columns_of(const RowLayout& layout, std::span<const std::byte> rows) {
  std::vector<std::string> values;
  for (const Column& column : layout.columns) {
    std::string& all = values.emplace_back();
    for (std::size_t at = column.offset; at < rows.size(); at += layout.bytes) {
      all.append(reinterpret_cast<const char*>(&rows[at]), bytes_of(column.type));
    }
  }
  return values;
}

}  // namespace ist::test
