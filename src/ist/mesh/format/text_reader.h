#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "ist/base/error.h"

namespace ist {

/// Throws the error of a mesh file: its name, the place in it, then the cause and the remedy.
[[noreturn]] void fail_mesh(ErrorCode code, std::string_view file, std::string_view place,
                            std::string_view cause);

/// Walks a text by lines and words, and says where it stands when something is wrong. Lines end
/// with \n, \r or \r\n; every byte up to 0x20 is a blank. Allocates nothing; the text must outlive
/// it.
class TextReader {
 public:
  enum class LineEnd : std::uint8_t { kPlain, kContinuedByBackslash };

  TextReader(std::string_view text, std::string_view file, LineEnd line_end = LineEnd::kPlain)
      : text_(text), file_(file), line_end_(line_end) {}

  /// Leaves the rest of this line for the next line that holds a word; false when there is none.
  [[nodiscard]] bool next_line();
  /// The next word of this line; empty at its end.
  [[nodiscard]] std::string_view word();
  /// The next word of this line or of those after it; empty at the end of the text.
  [[nodiscard]] std::string_view word_of_any_line();
  void skip_line() { cursor_ = line_close_; }

  /// The value of a word, rounded once to float. Errors: kMeshNotFinite, kNotAMesh, kMeshTruncated.
  [[nodiscard]] float coordinate(std::string_view word) const;
  /// The value of a word. Errors: kNotAMesh, kMeshTruncated.
  [[nodiscard]] std::int64_t integer(std::string_view word) const;

  [[nodiscard]] std::size_t line_number() const { return line_number_; }
  /// Where the next line begins in the text.
  [[nodiscard]] std::size_t next_line_offset() const { return next_open_; }
  [[noreturn]] void fail(ErrorCode code, std::string_view cause) const;
  /// Fails where the text breaks its format: with kMeshTruncated if this is where it ends,
  /// kNotAMesh otherwise.
  [[noreturn]] void fail_malformed(std::string_view cause) const;

 private:
  [[nodiscard]] bool is_blank(char c) const;

  std::string_view text_;
  std::string_view file_;
  LineEnd line_end_;
  std::size_t cursor_ = 0;      // where the next word of this line is looked for
  std::size_t line_close_ = 0;  // where this line ends, its line end not counted
  std::size_t next_open_ = 0;   // where the next line begins
  std::size_t line_number_ = 0;
  std::size_t next_line_number_ = 1;
};

/// Whether two words are the same but for the case of ASCII letters.
[[nodiscard]] bool same_word(std::string_view a, std::string_view b);

}  // namespace ist
