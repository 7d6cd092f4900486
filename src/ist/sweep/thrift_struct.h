#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace ist {

/// A struct in Thrift's compact protocol, as far as the headers of Parquet need it.
///
/// Source: Apache Thrift, doc/specs/thrift-compact-protocol.md. A field is a byte, whose high four
/// bits say how far its id lies above the last field's, and whose low four bits are its type, then
/// its value. The byte 0 ends the struct. A union is a struct of one field.
///
/// Each function appends a field. Precondition: its id is 1 to 15 above the last field's, or above
/// 0 for the first field. Each returns the struct, for the next field.
class ThriftStruct {
 public:
  /// Appends an i8: the byte.
  ThriftStruct& i8(int id, std::int8_t value);
  /// Appends a bool, which its type says already.
  ThriftStruct& boolean(int id, bool value);
  /// Appends an i32, or an enum: a varint, zigzag.
  ThriftStruct& i32(int id, std::int32_t value);
  /// Appends an i64: a varint, zigzag.
  ThriftStruct& i64(int id, std::int64_t value);
  /// Appends a binary, or a string, which is UTF-8: its length and its bytes.
  ThriftStruct& binary(int id, std::string_view value);
  /// Appends a struct, or a union.
  ThriftStruct& structure(int id, const ThriftStruct& value);
  /// Appends a list of i32, or of enums.
  ThriftStruct& i32_list(int id, std::span<const std::int32_t> values);
  /// Appends a list of binaries, or of strings.
  ThriftStruct& binary_list(int id, std::span<const std::string_view> values);
  /// Appends a list of structs.
  ThriftStruct& struct_list(int id, std::span<const ThriftStruct> values);

  /// Returns the struct as it is written: its fields and the byte that ends it.
  [[nodiscard]] std::string bytes() const;

 private:
  void append_field(int id, int type);
  void append_varint(std::uint64_t value);
  void append_zigzag(std::int64_t value);
  void append_binary(std::string_view value);
  void append_list(int id, int type, std::size_t size);

  std::string fields_;
  int last_id_ = 0;
};

}  // namespace ist
