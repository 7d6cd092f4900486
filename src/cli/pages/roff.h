#pragma once

#include <string>
#include <string_view>

namespace ist::cli {

/// The text of a manual page, in the macros of man(7).
class Roff {
 public:
  /// Begins a page of section 1: its name, the date as 2005-03-18, and the version's words.
  Roff(const std::string& name, const std::string& date, const std::string& version);

  void section(const std::string& title);
  void subsection(const std::string& title);
  /// Adds a line as it is: its parts come from bold(), italic() and plain().
  void line(const std::string& roff);
  /// Begins the entry of a list, under a line as for line().
  void entry(const std::string& roff);
  /// Begins a paragraph of this text.
  void paragraph(const std::string& text);
  /// Adds text to the paragraph or the entry: options in it are bold, and its lines are short.
  void fill(const std::string& text);
  /// Adds a line that is not filled, such as a command.
  void literal(const std::string& text);

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Each returns the words in a form that roff prints as they are, if they do not begin a line.
[[nodiscard]] std::string plain(std::string_view words);
[[nodiscard]] std::string bold(std::string_view words);
[[nodiscard]] std::string italic(std::string_view words);

}  // namespace ist::cli
