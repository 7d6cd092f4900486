#include "answers/formats/csv_writer.h"

#include "ist/base/assert.h"

namespace ist::answers {

CsvWriter::CsvWriter(const std::filesystem::path& file, const std::vector<std::string>& columns)
    : own_(std::in_place, file), file_(*own_), columns_(columns.size()) {
  for (const std::string& column : columns) add(column);
  end_row();
}

CsvWriter::CsvWriter(OutputFile& file, const std::vector<std::string>& columns, DecimalSign sign)
    : file_(file), sign_(sign), columns_(columns.size()) {
  for (const std::string& column : columns) add(column);
  end_row();
}

void CsvWriter::add(std::string_view text) {
  // Quotes tell an empty text from an unknown one.
  const char* special = sign_ == DecimalSign::kComma ? ";\"\r\n" : ",\"\r\n";
  if (!text.empty() && text.find_first_of(special) == text.npos) return add_raw(text);
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  add_raw(quoted + "\"");
}

void CsvWriter::add_raw(std::string_view text) {
  if (fields_++ > 0) rows_ += sign_ == DecimalSign::kComma ? ';' : ',';
  rows_ += text;
}

void CsvWriter::end_row() {
  IST_ASSERT(fields_ == columns_);
  fields_ = 0;
  rows_ += '\n';
  if (rows_.size() > (1 << 20)) flush();
}

void CsvWriter::commit() {
  IST_ASSERT(fields_ == 0);
  flush();
  file_.commit();
}

void CsvWriter::flush() {
  file_.write(rows_.data(), rows_.size());
  rows_.clear();
}

}  // namespace ist::answers
