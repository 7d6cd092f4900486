#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "ist/base/api.h"
#include "ist/base/checksum.h"
#include "ist/base/error.h"
#include "ist/base/files.h"

namespace ist {

/// Writes a tree file, to a disk or to memory: its preamble, then values and arrays in their memory
/// layout. Throws kFileUnwritable.
class TreeWriter {
 public:
  explicit TreeWriter(const std::filesystem::path& file);
  /// @param memory takes the file; must outlive the writer
  explicit TreeWriter(std::vector<std::byte>& memory);

  template <typename T>
  void value(const T& value) {
    array(std::span(&value, 1));
  }
  template <std::ranges::contiguous_range Values>
  void array(const Values& values) {
    using T = std::ranges::range_value_t<Values>;
    static_assert(std::is_trivially_copyable_v<T>);
    bytes(std::ranges::data(values), std::ranges::size(values) * sizeof(T));
  }

  /// Completes the file, on a disk under its own name. Returns its size, bytes.
  std::uint64_t commit();

 private:
  void bytes(const void* data, std::size_t count);
  void store(const void* data, std::size_t count);

  std::optional<OutputFile> file_;  // empty: in memory
  std::vector<std::byte>* memory_ = nullptr;
  Checksum checksum_;
  std::uint64_t bytes_ = 0;
};

/// Reads a tree file, from a disk or from memory, straight into the arrays of the tree. Each count
/// is checked against the bytes left in the file; the arrays' content may be trusted only after
/// verify_checksum(). Throws kFileUnreadable, kNotATree, kTreeVersion, kTreeTruncated,
/// kTreeCorrupt.
class IST_LOOP_API TreeReader {
 public:
  explicit TreeReader(const std::filesystem::path& file);
  /// @param memory the whole file; must outlive the reader
  /// @param name   names the memory in errors
  TreeReader(std::span<const std::byte> memory, std::string name);

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
    require_room(count, sizeof(T));
    std::vector<T> values(count);
    bytes(values.data(), count * sizeof(T));
    return values;
  }
  /// Returns points, each of three doubles.
  std::vector<Eigen::Vector3d> points(std::uint64_t count) {
    require_room(count, sizeof(Eigen::Vector3d));
    std::vector<Eigen::Vector3d> points(count);
    bytes(points.data(), count * sizeof(Eigen::Vector3d));
    return points;
  }

  void verify_checksum() const;
  void require(bool holds, const char* otherwise) const {
    if (!holds) corrupt(otherwise);
  }

 private:
  void read_preamble();
  std::size_t take(void* data, std::size_t count);
  void bytes(void* data, std::uint64_t count);
  void require_room(std::uint64_t count, std::size_t bytes) const {
    if (count > left_ / bytes) truncated();
  }
  [[noreturn]] void truncated() const;
  [[noreturn]] void corrupt(const char* what) const;
  [[noreturn]] void fail(ErrorCode code, const std::string& what) const;

  std::optional<InputFile> file_;  // empty: from memory
  std::span<const std::byte> memory_;
  std::string name_;
  Checksum checksum_;
  std::uint64_t expected_ = 0, size_, left_;
};

}  // namespace ist
