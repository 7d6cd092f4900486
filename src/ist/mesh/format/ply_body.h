#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string_view>
#include <utility>

#include "ist/base/printable.h"
#include "ist/mesh/format/ply_header.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {

/// Reads the values after a text header: one line for each vertex or face.
class PlyText {
 public:
  explicit PlyText(TextReader reader) : reader_(reader) {}

  void begin(const PlyElement& element, std::uint64_t index) {
    if (!reader_.next_line())
      reader_.fail(ErrorCode::kMeshTruncated,
                   fmt::format("the file ends after {} of the {} elements '{}' that its header "
                               "counts; copy or export it again",
                               index, element.count, printable(element.name)));
  }
  void end() {
    if (!reader_.word().empty())
      reader_.fail(ErrorCode::kNotAMesh,
                   "the line has more values than the header declares; export the mesh again");
  }
  void finish() {
    if (reader_.next_line())
      reader_.fail(ErrorCode::kNotAMesh,
                   "the file has more elements than the header counts; export the mesh again");
  }
  double coordinate(const PlyType* type) {
    return reader_.coordinate(reader_.word(), type->precision);
  }
  std::int64_t integer(const PlyType*) { return reader_.integer(reader_.word()); }
  void skip(const PlyType*) {
    if (reader_.word().empty()) reader_.fail_malformed("a value is missing; export the mesh again");
  }
  [[noreturn]] void fail(ErrorCode code, std::string_view cause) const {
    reader_.fail(code, cause);
  }

 private:
  TextReader reader_;
};

/// Reads the values after a binary header.
class PlyBytes {
 public:
  PlyBytes(std::string_view content, std::size_t offset, bool big_endian, std::string_view file)
      : content_(content), offset_(offset), big_endian_(big_endian), file_(file) {}

  void begin(const PlyElement& element, std::uint64_t index) {
    element_ = &element;
    index_ = index;
  }
  void end() {}
  void finish() const {
    if (content_.find_first_not_of(std::string_view(" \t\r\n\0", 5), offset_) !=
        std::string_view::npos)
      fail_mesh(ErrorCode::kNotAMesh, file_, fmt::format("byte {}", offset_),
                "bytes follow the elements that the header counts; export the mesh again");
  }
  double coordinate(const PlyType* type) {
    const double value = number(type);
    if (!is_coordinate(value))
      fail(ErrorCode::kMeshNotFinite,
           "a coordinate is not finite, or beyond a float's range; repair the mesh where it was "
           "made");
    return value;
  }
  std::int64_t integer(const PlyType* type) { return static_cast<std::int64_t>(number(type)); }
  void skip(const PlyType* type) { static_cast<void>(take(type->size)); }
  [[noreturn]] void fail(ErrorCode code, std::string_view cause) const {
    fail_mesh(code, file_, fmt::format("{} {}", printable(element_->name), index_), cause);
  }

 private:
  std::string_view take(std::size_t size) {
    if (content_.size() - offset_ < size)
      fail(ErrorCode::kMeshTruncated, fmt::format("the file ends within this element, one of {} "
                                                  "that its header counts; copy or export it again",
                                                  element_->count));
    return content_.substr(std::exchange(offset_, offset_ + size), size);
  }

  double number(const PlyType* type) {
    return number_in(take(type->size).data(), *type, big_endian_);
  }

  std::string_view content_;
  std::size_t offset_;
  bool big_endian_;
  std::string_view file_;
  const PlyElement* element_ = nullptr;
  std::uint64_t index_ = 0;
};

/// Returns read(body), with the reader of the values that follow a header. `reader` stands on the
/// header's last line, as read_ply_header() leaves it; `file` is named in errors.
template <class Read>
auto with_ply_body(const TextReader& reader, const PlyHeader& header, std::string_view content,
                   std::string_view file, Read read) {
  if (header.encoding == PlyEncoding::kText) return read(PlyText(reader));
  std::size_t begin = reader.next_line_offset();
  // If the header's other lines end with \r alone, a \n after its last line is the first byte.
  if (content.find('\n') + 1 == begin && content.substr(0, begin).ends_with("\r\n")) --begin;
  return read(PlyBytes(content, begin, header.encoding == PlyEncoding::kBigEndian, file));
}

}  // namespace ist
