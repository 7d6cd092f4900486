#include "ist/mesh/format/xml_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "ist/base/printable.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

}  // namespace

XmlReader::XmlReader(std::string_view text, std::string_view file, std::string_view part)
    : text_(text), file_(file), part_(part) {
  // XML in UTF-16 begins with a byte order mark.
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    fail_mesh(ErrorCode::kNotAMesh, file, printable(part),
              "the text is UTF-16; export it as UTF-8, or export an STL");
}

XmlReader::Tag XmlReader::next() {
  attributes_.clear();
  if (closes_) {
    closes_ = false;
    open_.pop_back();
    return Tag::kClose;
  }
  while (true) {
    cursor_ = std::min(text_.find('<', cursor_), text_.size());
    if (cursor_ == text_.size()) {
      if (!open_.empty())
        fail(ErrorCode::kMeshTruncated, fmt::format("the text ends within <{}>; copy or export it "
                                                    "again",
                                                    printable(open_.back())));
      return Tag::kEnd;
    }
    ++cursor_;
    const std::string_view rest = text_.substr(cursor_);
    if (rest.starts_with("!--")) {
      static_cast<void>(until("-->"));
    } else if (rest.starts_with("![CDATA[")) {
      static_cast<void>(until("]]>"));
    } else if (rest.starts_with('?') || rest.starts_with('!')) {
      static_cast<void>(until(">"));
    } else {
      break;
    }
  }
  if (peek() == '/') {
    ++cursor_;
    name_ = word();
    skip_blanks();
    if (peek() != '>' || open_.empty() || open_.back() != name_)
      fail(ErrorCode::kNotAMesh,
           fmt::format("</{}> closes nothing; export the mesh again", printable(name_)));
    ++cursor_;
    open_.pop_back();
    return Tag::kClose;
  }
  name_ = word();
  open_.push_back(name_);
  read_attributes();
  return Tag::kOpen;
}

void XmlReader::read_attributes() {
  for (skip_blanks(); peek() != '>'; skip_blanks()) {
    if (peek() == '/') {
      ++cursor_;
      closes_ = true;
      if (peek() != '>') fail(ErrorCode::kNotAMesh, "a tag is malformed; export the mesh again");
      break;
    }
    const std::string_view name = word();
    skip_blanks();
    const bool has_value = peek() == '=';
    if (has_value) ++cursor_;
    skip_blanks();
    const char quote = peek();
    if (!has_value || (quote != '"' && quote != '\''))
      fail(ErrorCode::kNotAMesh,
           fmt::format("the attribute '{}' has no value; export the mesh again", printable(name)));
    ++cursor_;
    attributes_.emplace_back(name, until(std::string_view(&quote, 1)));
  }
  ++cursor_;
}

std::optional<std::string_view> XmlReader::attribute(std::string_view name) const {
  for (auto [known, value] : attributes_) {
    if (known != name) continue;
    value.remove_prefix(std::min(value.find_first_not_of(kBlanks), value.size()));
    return value.substr(0, value.find_last_not_of(kBlanks) + 1);
  }
  return {};
}

// Returns the text up to the next `end`, and goes behind it.
std::string_view XmlReader::until(std::string_view end) {
  const std::size_t found = text_.find(end, cursor_);
  if (found == text_.npos) {
    cursor_ = text_.size();
    static_cast<void>(peek());
  }
  const std::string_view passed = text_.substr(cursor_, found - cursor_);
  cursor_ = found + end.size();
  return passed;
}

// Returns a name, which ends at a blank or a sign of XML.
std::string_view XmlReader::word() {
  const std::size_t end = std::min(text_.find_first_of(" \t\r\n=/><\"'", cursor_), text_.size());
  const std::string_view found = text_.substr(cursor_, end - cursor_);
  cursor_ = end;
  if (found.empty()) {
    static_cast<void>(peek());
    fail(ErrorCode::kNotAMesh, "a tag is malformed; export the mesh again");
  }
  return found;
}

char XmlReader::peek() const {
  if (cursor_ == text_.size())
    fail(ErrorCode::kMeshTruncated, "the text ends within a tag; copy or export it again");
  return text_[cursor_];
}

void XmlReader::skip_blanks() {
  cursor_ = std::min(text_.find_first_not_of(kBlanks, cursor_), text_.size());
}

void XmlReader::fail(ErrorCode code, std::string_view cause) const {
  const auto lines =
      1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(cursor_), '\n');
  const std::string_view comma = part_.empty() ? "" : ", ";
  fail_mesh(code, file_, fmt::format("{}{}line {}", printable(part_), comma, lines), cause);
}

}  // namespace ist
