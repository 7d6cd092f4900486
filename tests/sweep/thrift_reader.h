#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace ist::test {

/// A value that was read in Thrift's compact protocol. Its type says which member holds it.
struct ThriftValue {
  int type = 0;
  std::int64_t number = 0;            // bool (1, 2), i8 (3), i32 (5), i64 (6)
  std::string text;                   // binary (8)
  std::vector<ThriftValue> elements;  // of a list (9), or the values of a struct (12)
  std::vector<int> ids;               // of the values of a struct

  [[nodiscard]] bool has(int id) const { return find(id) != nullptr; }
  /// The field of a struct, which must be there.
  [[nodiscard]] const ThriftValue& at(int id) const {
    const ThriftValue* found = find(id);
    if (found == nullptr) throw std::runtime_error("no field " + std::to_string(id));
    return *found;
  }
  [[nodiscard]] const ThriftValue* find(int id) const {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] == id) return &elements[i];
    }
    return nullptr;
  }
};

/// Reads structs from the front of `bytes`, by the protocol's specification alone. Throws
/// std::runtime_error, or std::out_of_range where they end early.
class ThriftReader {
 public:
  explicit ThriftReader(std::string_view bytes) : bytes_(bytes) {}

  /// How many bytes were read.
  [[nodiscard]] std::size_t position() const { return position_; }

  ThriftValue read_struct() {
    ThriftValue value;
    value.type = 12;
    int id = 0;
    while (const unsigned header = byte()) {
      id = header >> 4 != 0 ? id + static_cast<int>(header >> 4) : static_cast<int>(zigzag());
      value.ids.push_back(id);
      value.elements.push_back(read(static_cast<int>(header & 15)));
    }
    return value;
  }

 private:
  unsigned byte() { return static_cast<unsigned char>(bytes_.at(position_++)); }

  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 70; shift += 7) {
      const unsigned next = byte();
      value |= static_cast<std::uint64_t>(next & 127) << shift;
      if (next < 128) return value;
    }
    throw std::runtime_error("a varint of over ten bytes");
  }

  std::int64_t zigzag() {
    const std::uint64_t folded = varint();
    return static_cast<std::int64_t>(folded % 2 == 0 ? folded / 2 : ~(folded / 2));
  }

  ThriftValue read(int type) {
    ThriftValue value;
    value.type = type;
    if (type == 1 || type == 2) {
      value.number = type == 1;
    } else if (type == 3) {
      value.number = static_cast<std::int8_t>(byte());
    } else if (type == 5 || type == 6) {
      value.number = zigzag();
    } else if (type == 8) {
      const std::size_t size = varint();
      value.text = bytes_.substr(position_, size);
      if (value.text.size() != size) throw std::runtime_error("a binary that ends early");
      position_ += size;
    } else if (type == 9) {
      const unsigned header = byte();
      const std::uint64_t size = header >> 4 == 15 ? varint() : header >> 4;
      for (std::uint64_t i = 0; i < size; ++i) {
        value.elements.push_back(read(static_cast<int>(header & 15)));
      }
    } else if (type == 12) {
      value = read_struct();
    } else {
      throw std::runtime_error("type " + std::to_string(type));
    }
    return value;
  }

  std::string_view bytes_;
  std::size_t position_ = 0;
};

}  // namespace ist::test
