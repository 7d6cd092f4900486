#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <type_traits>

#include "ist/base/error.h"

namespace ist {

/// Throws an Error of a mesh file: its text names the file, the place in it, the cause and the
/// remedy.
[[noreturn]] void fail_mesh(ErrorCode code, std::string_view file, std::string_view place,
                            std::string_view cause);

/// The type that a number written as text is rounded to.
enum class Precision : std::uint8_t { kFloat, kDouble };

/// Returns the number that a word spells, rounded once; nothing where it spells no number. A number
/// too small for its type is 0; one too large is infinite, and so is a NaN of any spelling.
[[nodiscard]] std::optional<double> number_of(std::string_view word, Precision precision);

/// Whether a number may be a coordinate: it is finite and within the range of a float, so that
/// products of several coordinates are finite doubles.
[[nodiscard]] bool is_coordinate(double number);

/// Reads a text by lines and words. Errors name the current line. Lines end with \n, \r or \r\n.
/// Every byte up to 0x20 is a blank. Allocates nothing. The text must outlive the reader.
class TextReader {
 public:
  /// In an OBJ a line of numbers (v, vt, vn, vp, f, l, p) goes on if a backslash ends it. A comment
  /// or a line of names does not: a backslash may end a Windows path.
  enum class LineEnd : std::uint8_t { kPlain, kObj };

  TextReader(std::string_view text, std::string_view file, LineEnd line_end = LineEnd::kPlain)
      : text_(text), file_(file), line_end_(line_end) {}

  /// Advances to the next line that holds a word; returns false if no such line is left.
  [[nodiscard]] bool next_line();
  /// Returns the next word of this line; empty at the line's end.
  [[nodiscard]] std::string_view word();
  /// Returns the next word of this line or of the lines after it; empty at the end of the text.
  [[nodiscard]] std::string_view word_of_any_line();
  /// Returns the next word of this line, up to a comment, which # begins. The # of "1.#IND", a
  /// printed NaN, begins none.
  [[nodiscard]] std::string_view word_before_comment();
  /// Returns the rest of this line, from the cursor on.
  [[nodiscard]] std::string_view rest() const {
    return text_.substr(cursor_, line_close_ - cursor_);
  }
  void skip_line() { cursor_ = line_close_; }

  /// Returns the integer that a word spells; nothing if it spells none.
  [[nodiscard]] static std::optional<std::int64_t> whole(std::string_view word);
  /// Converts a word to a coordinate, rounded once. Errors: kMeshNotFinite, kNotAMesh,
  /// kMeshTruncated.
  [[nodiscard]] double coordinate(std::string_view word, Precision precision) const;
  /// Converts a word to an integer. Errors: kNotAMesh, kMeshTruncated.
  [[nodiscard]] std::int64_t integer(std::string_view word) const;

  [[nodiscard]] std::string_view file() const { return file_; }
  [[nodiscard]] std::size_t line_number() const { return line_number_; }
  /// The offset of the next line in the text, bytes.
  [[nodiscard]] std::size_t next_line_offset() const { return next_open_; }
  [[noreturn]] void fail(ErrorCode code, std::string_view cause) const;
  /// Throws the error of malformed text: kMeshTruncated at the end of the text, else kNotAMesh.
  [[noreturn]] void fail_malformed(std::string_view cause) const;

 private:
  [[nodiscard]] bool is_blank(std::size_t at) const;
  [[nodiscard]] bool goes_on(std::size_t begin) const;

  std::string_view text_;
  std::string_view file_;
  LineEnd line_end_;
  std::size_t cursor_ = 0;      // where the search for the next word begins
  std::size_t line_close_ = 0;  // where this line ends, without its line end
  std::size_t next_open_ = 0;   // where the next line begins
  std::size_t line_number_ = 0;
  std::size_t next_line_number_ = 1;
};

/// Whether two words are equal, apart from the case of ASCII letters.
[[nodiscard]] bool same_word(std::string_view a, std::string_view b);

/// A type of numbers in a file, by its name in the file's format.
struct NumberType {
  std::string_view name;
  std::size_t size;  ///< bytes in a binary file
  bool is_integer;
  Precision precision;                ///< of a number written as text
  double (*number)(const char* raw);  ///< reads `size` bytes in the machine's byte order
};

/// Integers of 64 bits are rounded.
template <class T>
constexpr NumberType number_type(std::string_view name) {
  return {name, sizeof(T), std::is_integral_v<T>,
          std::is_same_v<T, float> ? Precision::kFloat : Precision::kDouble, [](const char* raw) {
            T value;
            std::memcpy(&value, raw, sizeof(T));
            return static_cast<double>(value);
          }};
}

/// Returns the number in `type.size` bytes. This machine is little-endian.
[[nodiscard]] inline double number_in(const char* bytes, const NumberType& type, bool big_endian) {
  if (!big_endian) return type.number(bytes);
  std::array<char, sizeof(double)> raw;
  std::reverse_copy(bytes, bytes + type.size, raw.begin());
  return type.number(raw.data());
}

}  // namespace ist
