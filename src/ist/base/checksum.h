#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "ist/base/api.h"
#include "ist/base/files.h"

namespace ist {

/// Returns the XXH3-128 of a file's content, 32 hexadecimal digits. Throws kFileUnreadable. Has
/// cancellation points.
[[nodiscard]] IST_LOOP_API std::string hash_of_file(const InputFile& file);
[[nodiscard]] IST_LOOP_API std::string hash_of_file(const std::filesystem::path& file);

/// Computes the XXH3-64 of all bytes added.
class IST_LOOP_API Checksum {
 public:
  Checksum();
  ~Checksum();
  void add(const void* data, std::size_t bytes);
  [[nodiscard]] std::uint64_t value() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Computes the XXH3-128 of all bytes added, for which no two different files are known by chance.
class IST_LOOP_API ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  void add(const void* data, std::size_t bytes);
  /// Returns 32 hexadecimal digits, as the program xxhsum -H2 prints them.
  [[nodiscard]] std::string text() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ist
