#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ist/base/files.h"

namespace ist::answers {

/// The decimal sign of a table. With a comma, semicolons part the fields, as in German or Spanish
/// Excel.
enum class DecimalSign : std::uint8_t { kPoint, kComma };

/// Writes a table as CSV: a header row, then a row at a time. Fields are quoted by RFC 4180, and
/// rows end in a line feed alone, for tools that read lines. A number has the fewest digits that
/// read back as the same number, whatever the locale; an unknown number is an empty field. The
/// file appears, complete, after commit().
///
/// Every function throws kFileUnwritable.
class CsvWriter {
 public:
  /// Opens the file and writes the header row.
  CsvWriter(const std::filesystem::path& file, const std::vector<std::string>& columns);
  /// Writes the header row into a file that outlives the writer, and that the caller completes,
  /// after flush().
  CsvWriter(OutputFile& file, const std::vector<std::string>& columns,
            DecimalSign sign = DecimalSign::kPoint);

  /// Writes a row: as many fields as columns, each a number, a text, or an optional one.
  template <typename... Fields>
  void row(const Fields&... fields) {
    (add(fields), ...);
    end_row();
  }

  /// Appends a field to the row, for rows whose columns are counted at run time.
  void add(std::string_view text);
  template <typename Number>
  requires std::integral<Number> || std::floating_point<Number>
  void add(Number number) {
    std::string text = fmt::format("{}", number);
    if (sign_ == DecimalSign::kComma) std::replace(text.begin(), text.end(), '.', ',');
    add_raw(text);
  }
  template <typename Field>
  void add(const std::optional<Field>& field) {
    field ? add(*field) : add_raw("");
  }
  /// Ends the row. Precondition: it has as many fields as there are columns.
  void end_row();

  /// Hands all rows to the file.
  void flush();
  /// Completes the file that the writer opened.
  void commit();

 private:
  void add_raw(std::string_view text);

  std::optional<OutputFile> own_;
  OutputFile& file_;
  DecimalSign sign_ = DecimalSign::kPoint;
  std::size_t columns_, fields_ = 0;  // fields_: of the row that is being written
  std::string rows_;                  // not yet written
};

}  // namespace ist::answers
