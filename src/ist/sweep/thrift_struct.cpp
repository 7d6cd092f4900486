#include "ist/sweep/thrift_struct.h"

#include <cstddef>

#include "ist/base/assert.h"

namespace ist {
namespace {

// Numbers of the protocol. Fields and elements of lists share those that are used here.
constexpr int kThriftTrue = 1, kThriftFalse = 2, kThriftI8 = 3, kThriftI32 = 5, kThriftI64 = 6;
constexpr int kThriftBinary = 8, kThriftList = 9, kThriftStruct = 12;
constexpr std::size_t kShortestLongList = 15;
constexpr std::size_t kMostInt32 = 0x7FFFFFFF;

}  // namespace

ThriftStruct& ThriftStruct::i8(int id, std::int8_t value) {
  append_field(id, kThriftI8);
  fields_ += static_cast<char>(value);
  return *this;
}

ThriftStruct& ThriftStruct::boolean(int id, bool value) {
  append_field(id, value ? kThriftTrue : kThriftFalse);
  return *this;
}

ThriftStruct& ThriftStruct::i32(int id, std::int32_t value) {
  append_field(id, kThriftI32);
  append_zigzag(value);
  return *this;
}

ThriftStruct& ThriftStruct::i64(int id, std::int64_t value) {
  append_field(id, kThriftI64);
  append_zigzag(value);
  return *this;
}

ThriftStruct& ThriftStruct::binary(int id, std::string_view value) {
  append_field(id, kThriftBinary);
  append_binary(value);
  return *this;
}

ThriftStruct& ThriftStruct::structure(int id, const ThriftStruct& value) {
  append_field(id, kThriftStruct);
  fields_ += value.bytes();
  return *this;
}

ThriftStruct& ThriftStruct::i32_list(int id, std::span<const std::int32_t> values) {
  append_list(id, kThriftI32, values.size());
  for (const std::int32_t value : values) append_zigzag(value);
  return *this;
}

ThriftStruct& ThriftStruct::binary_list(int id, std::span<const std::string_view> values) {
  append_list(id, kThriftBinary, values.size());
  for (const std::string_view value : values) append_binary(value);
  return *this;
}

ThriftStruct& ThriftStruct::struct_list(int id, std::span<const ThriftStruct> values) {
  append_list(id, kThriftStruct, values.size());
  for (const ThriftStruct& value : values) fields_ += value.bytes();
  return *this;
}

std::string ThriftStruct::bytes() const { return fields_ + '\0'; }

void ThriftStruct::append_field(int id, int type) {
  const int delta = id - last_id_;
  IST_ASSERT(delta >= 1 && delta <= 15);
  fields_ += static_cast<char>(delta << 4 | type);
  last_id_ = id;
}

// Seven bits a byte, the lowest first. The high bit says that more follow.
void ThriftStruct::append_varint(std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) fields_ += static_cast<char>(value | 0x80);
  fields_ += static_cast<char>(value);
}

// Small numbers of either sign become small: 0, -1, 1, -2 are 0, 1, 2, 3.
void ThriftStruct::append_zigzag(std::int64_t value) {
  const auto bits = static_cast<std::uint64_t>(value);
  append_varint(value < 0 ? ~(bits << 1) : bits << 1);
}

void ThriftStruct::append_binary(std::string_view value) {
  IST_ASSERT(value.size() <= kMostInt32);
  append_varint(value.size());
  fields_ += value;
}

void ThriftStruct::append_list(int id, int type, std::size_t size) {
  IST_ASSERT(size <= kMostInt32);
  append_field(id, kThriftList);
  if (size < kShortestLongList) {
    fields_ += static_cast<char>(size << 4 | static_cast<std::size_t>(type));
  } else {
    fields_ += static_cast<char>(0xF0 | type);
    append_varint(size);
  }
}

}  // namespace ist
