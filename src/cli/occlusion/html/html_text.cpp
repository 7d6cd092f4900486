#include "cli/occlusion/html/html_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace ist::cli {
namespace {

// The length of the UTF-8 sequence that a text begins with; 0 where it begins with none (RFC 3629).
std::size_t sequence_length(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  // Longer than it need be, half of a pair of UTF-16, or beyond the last character.
  const bool wrong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) > 0x9F) ||
                     (first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) > 0x8F);
  return wrong ? 0 : length;
}

std::string row_of(const std::vector<std::string>& cells, bool head) {
  std::string row = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (head) {
      row += "<th scope=\"col\">" + cells[i] + "</th>";
    } else if (i == 0) {
      row += "<th scope=\"row\">" + cells[i] + "</th>";
    } else {
      row += "<td>" + cells[i] + "</td>";
    }
  }
  return row + "</tr>\n";
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
    const char c = character[0];
    // Beside C0 and DEL, C1 has no place in HTML, nor have the last two characters in XML.
    const bool control = (c >= 0 && c < 0x20) || c == 0x7F ||
                         (length == 2 && c == '\xC2' && character[1] < '\xA0') ||
                         character == "\uFFFE" || character == "\uFFFF";
    if (length == 0 || control) {
      out += "\uFFFD";
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\'') {
      out += "&#39;";
    } else {
      out += character;
    }
    text.remove_prefix(character.size());
  }
  return out;
}

std::string base64_of(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t here = std::min<std::size_t>(bytes.size() - i, 3);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (k < here ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= here ? kDigits[bits >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return out;
}

HtmlTable::HtmlTable(std::string_view id, std::string_view caption,
                     const std::vector<std::string>& head)
    : html_(fmt::format("<div class=\"wide\"><table id=\"{}\">\n{}<thead>\n{}</thead>\n<tbody>\n",
                        id, caption.empty() ? "" : fmt::format("<caption>{}</caption>\n", caption),
                        row_of(head, true))),
      columns_(head.size()) {}

void HtmlTable::add(const std::vector<std::string>& cells) {
  if (cells.size() != columns_) {
    throw std::logic_error(
        fmt::format("a row of {} cells in a table of {} columns", cells.size(), columns_));
  }
  html_ += row_of(cells, false);
  empty_ = false;
}

std::string HtmlTable::html() const { return html_ + "</tbody>\n</table></div>\n"; }

}  // namespace ist::cli
