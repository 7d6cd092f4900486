#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ist::cli {

/// Returns a text as HTML shows it, and XML too: with references for markup and quotes, and U+FFFD
/// for control characters and for bytes that are no UTF-8, which names of files may hold.
[[nodiscard]] std::string escaped(std::string_view text);

/// Returns bytes in base64, with padding (RFC 4648).
[[nodiscard]] std::string base64_of(std::string_view bytes);

/// A table of HTML: its head, its rows, and what it is about. Cells are HTML already.
class HtmlTable {
 public:
  /// `id` is unique in the document. The caption may be empty, where a heading says it.
  HtmlTable(std::string_view id, std::string_view caption, const std::vector<std::string>& head);

  /// The first cell is the row's head. Throws std::logic_error unless the head of the table has as
  /// many cells.
  void add(const std::vector<std::string>& cells);
  [[nodiscard]] bool empty() const { return empty_; }
  /// Returns the whole table, in a frame that scrolls where the page is narrow.
  [[nodiscard]] std::string html() const;

 private:
  std::string html_;
  std::size_t columns_;
  bool empty_ = true;
};

}  // namespace ist::cli
