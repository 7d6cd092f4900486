#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "ist/base/error.h"

namespace ist {

/// Reads the tags of an XML document one after the other. References such as &amp; stay as they
/// are. Nesting takes memory, and no stack. The text must outlive the reader.
class XmlReader {
 public:
  enum class Tag : std::uint8_t { kOpen, kClose, kEnd };

  using Attribute = std::pair<std::string_view, std::string_view>;

  /// Errors name the file, and the line of `part`, which the text is; empty for the whole file.
  /// Throws kNotAMesh for a text in UTF-16.
  XmlReader(std::string_view text, std::string_view file, std::string_view part);

  /// Advances to the next tag; kEnd behind the last one. An element without content, <a/>, opens
  /// and closes. Errors: kNotAMesh, kMeshTruncated.
  [[nodiscard]] Tag next();
  /// The element's name, its prefix included.
  [[nodiscard]] std::string_view name() const { return name_; }
  /// Returns an attribute of a tag that opens, without blanks at its ends.
  [[nodiscard]] std::optional<std::string_view> attribute(std::string_view name) const;

  /// The names and values of a tag that opens, as the text spells them.
  [[nodiscard]] const std::vector<Attribute>& attributes() const { return attributes_; }

  /// Returns the text behind the tag: up to the next tag, or up to the end.
  [[nodiscard]] std::string_view content() const { return rest().substr(0, rest().find('<')); }
  [[nodiscard]] std::string_view rest() const { return text_.substr(cursor_); }

  [[noreturn]] void fail(ErrorCode code, std::string_view cause) const;

 private:
  [[nodiscard]] std::string_view until(std::string_view end);
  [[nodiscard]] std::string_view word();
  [[nodiscard]] char peek() const;
  void skip_blanks();
  void read_attributes();

  std::string_view text_, file_, part_;
  std::size_t cursor_ = 0;
  std::string_view name_;
  bool closes_ = false;  // the tag that opened was <a/>
  std::vector<std::string_view> open_;
  std::vector<Attribute> attributes_;
};

}  // namespace ist
