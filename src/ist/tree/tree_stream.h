#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "ist/base/error.h"
#include "ist/base/input_file.h"
#include "ist/base/output_file.h"

struct XXH3_state_s;

namespace ist {

/// The first bytes of a tree file.
inline constexpr std::array<unsigned char, 8> kTreeFileMagic = {0x89, 'I',  'S',  'T',
                                                                0x0D, 0x0A, 0x1A, 0x0A};

/// XXH3-64 of all that is added.
class Checksum {
 public:
  Checksum();
  void add(const void* data, std::size_t bytes);
  [[nodiscard]] std::uint64_t value() const;

 private:
  struct Free {
    void operator()(XXH3_state_s* state) const;
  };
  std::unique_ptr<XXH3_state_s, Free> state_;
};

/// Writes a tree file's preamble and what follows it, as it lies in memory. Throws kFileUnwritable.
class TreeWriter {
 public:
  explicit TreeWriter(const std::filesystem::path& file);

  template <typename T>
  void value(const T& value) {
    array(std::span<const T>(&value, 1));
  }
  template <typename T>
  void array(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes(values.data(), values.size_bytes());
  }
  template <typename T>
  void array(const std::vector<T>& values) {
    array(std::span<const T>(values));
  }

  /// The file is there from now on. Returns its bytes.
  std::uint64_t commit();

 private:
  void bytes(const void* data, std::size_t count);

  OutputFile file_;
  Checksum checksum_;
  std::uint64_t bytes_ = 0;
};

/// Reads a tree file straight into the arrays that the tree will own. A count is believed only as
/// far as the file is long; what the arrays hold is believed only after verify_checksum(). Throws
/// kFileUnreadable, kNotATree, kTreeVersion, kTreeTruncated, kTreeCorrupt.
class TreeReader {
 public:
  explicit TreeReader(const std::filesystem::path& file);

  template <typename T>
  T value() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    bytes(&value, sizeof(value));
    return value;
  }
  template <typename T>
  std::vector<T> array(std::uint64_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count > left_ / sizeof(T)) truncated();
    std::vector<T> values(count);
    bytes(values.data(), count * sizeof(T));
    return values;
  }

  void verify_checksum() const;
  void require(bool holds, const char* otherwise) const {
    if (!holds) corrupt(otherwise);
  }

 private:
  void bytes(void* data, std::uint64_t count);
  [[noreturn]] void truncated() const;
  [[noreturn]] void corrupt(const char* what) const;
  [[noreturn]] void fail(ErrorCode code, const std::string& what) const;

  InputFile file_;
  Checksum checksum_;
  std::uint64_t expected_ = 0, left_;
};

}  // namespace ist
