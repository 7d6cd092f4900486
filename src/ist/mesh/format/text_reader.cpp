#include "ist/mesh/format/text_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <system_error>

#include "ist/base/platform/from_chars.h"
#include "ist/base/printable.h"
#include "ist/base/throw_error.h"

namespace ist {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Whether the # at this place begins a comment. In "1.#IND", a printed NaN, it does not.
bool begins_comment(std::string_view text, std::size_t at) {
  return at == 0 || text[at - 1] != '.';
}

template <class Number>
std::optional<double> rounded(std::string_view word) {
  constexpr double kNotFinite = std::numeric_limits<double>::infinity();
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  const char* const end = digits.data() + digits.size();
  Number value = 0;
  const auto [stop, error] = from_chars(digits, value);
  if (error == std::errc::result_out_of_range) {
    if (stop != end) return {};
    // A number that is too small becomes zero; only one too large is an error.
    double wide = 0;
    const std::errc wide_error = from_chars(digits, wide).ec;
    const bool tiny =
        wide_error == std::errc() ? std::abs(wide) < 1 : digits.find('-', 1) != digits.npos;
    return tiny ? 0 : kNotFinite;
  }
  if (error != std::errc()) return {};
  // Older Windows runtimes print NaN as "1.#QNAN" or "-1.#IND".
  if (!std::isfinite(value) || (stop != end && *stop == '#')) return kNotFinite;
  if (stop != end) return {};
  return static_cast<double>(value);
}

}  // namespace

std::optional<double> number_of(std::string_view word, Precision precision) {
  return precision == Precision::kFloat ? rounded<float>(word) : rounded<double>(word);
}

void fail_mesh(ErrorCode code, std::string_view file, std::string_view place,
               std::string_view cause) {
  throw_error(code, "{}: {}{}{}", file, place, place.empty() ? "" : ": ", cause);
}

bool is_coordinate(double number) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return std::abs(number) <= kLargest;
}

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

// In an OBJ a backslash at the end of a line is blank.
bool TextReader::is_blank(std::size_t at) const {
  if (static_cast<unsigned char>(text_[at]) <= 0x20) return true;
  if (line_end_ != LineEnd::kObj || text_[at] != '\\') return false;
  return at + 1 == text_.size() || text_[at + 1] == '\r' || text_[at + 1] == '\n';
}

// Whether a backslash joins the next line to the statement at the cursor. The statement's last line
// so far begins at `begin`.
bool TextReader::goes_on(std::size_t begin) const {
  if (line_end_ != LineEnd::kObj || line_close_ == begin || text_[line_close_ - 1] != '\\')
    return false;
  const std::string_view line = text_.substr(begin, line_close_ - begin);
  for (std::size_t at = line.find('#'); at != line.npos; at = line.find('#', at + 1)) {
    if (begins_comment(line, at)) return false;
  }
  std::size_t open = cursor_, close = 0;
  while (open < line_close_ && is_blank(open)) ++open;
  for (close = open; close < line_close_ && !is_blank(close);) ++close;
  constexpr std::array<std::string_view, 7> kNumbers = {"v", "vt", "vn", "vp", "f", "l", "p"};
  return std::find(kNumbers.begin(), kNumbers.end(), text_.substr(open, close - open)) !=
         kNumbers.end();
}

bool TextReader::next_line() {
  while (next_open_ < text_.size()) {
    cursor_ = next_open_;
    line_number_ = next_line_number_;
    for (bool continued = true; continued;) {
      const std::size_t begin = next_open_;
      line_close_ = std::min(text_.find_first_of("\r\n", next_open_), text_.size());
      const bool pair = text_.substr(line_close_, 2) == "\r\n";
      next_open_ = std::min(line_close_ + (pair ? 2 : 1), text_.size());
      ++next_line_number_;
      continued = next_open_ < text_.size() && goes_on(begin);
    }
    while (cursor_ < line_close_ && is_blank(cursor_)) ++cursor_;
    if (cursor_ < line_close_) return true;
  }
  cursor_ = line_close_ = text_.size();
  return false;
}

std::string_view TextReader::word() {
  while (cursor_ < line_close_ && is_blank(cursor_)) ++cursor_;
  const std::size_t open = cursor_;
  while (cursor_ < line_close_ && !is_blank(cursor_)) ++cursor_;
  return text_.substr(open, cursor_ - open);
}

std::string_view TextReader::word_before_comment() {
  const std::string_view found = word();
  const std::size_t comment = found.find('#');
  if (comment == found.npos || !begins_comment(found, comment)) return found;
  skip_line();
  return found.substr(0, comment);
}

std::string_view TextReader::word_of_any_line() {
  std::string_view found = word();
  while (found.empty() && next_line()) found = word();
  return found;
}

double TextReader::coordinate(std::string_view word, Precision precision) const {
  if (word.empty()) fail_malformed("a coordinate is missing; export the mesh again");
  const std::optional<double> number = number_of(word, precision);
  if (!number)
    fail_malformed(fmt::format("'{}' is not a number; export the mesh again", printable(word)));
  if (!is_coordinate(*number))
    fail(ErrorCode::kMeshNotFinite, fmt::format("the coordinate '{}' is not finite, or beyond a "
                                                "float's range; repair the mesh where it was made",
                                                printable(word)));
  return *number;
}

std::optional<std::int64_t> TextReader::whole(std::string_view word) {
  std::int64_t value = 0;
  const auto [stop, error] = from_chars(word, value);
  if (error != std::errc() || stop != word.data() + word.size()) return {};
  return value;
}

std::int64_t TextReader::integer(std::string_view word) const {
  if (word.empty()) fail_malformed("an integer is missing; export the mesh again");
  const std::optional<std::int64_t> value = whole(word);
  if (!value)
    fail_malformed(fmt::format("'{}' is not an integer; export the mesh again", printable(word)));
  return *value;
}

void TextReader::fail(ErrorCode code, std::string_view cause) const {
  fail_mesh(code, file_, fmt::format("line {}", line_number_), cause);
}

void TextReader::fail_malformed(std::string_view cause) const {
  std::size_t rest = cursor_;
  while (rest < text_.size() && is_blank(rest)) ++rest;
  if (rest == text_.size())
    fail(ErrorCode::kMeshTruncated, fmt::format("the file ends here, but {}", cause));
  fail(ErrorCode::kNotAMesh, cause);
}

}  // namespace ist
