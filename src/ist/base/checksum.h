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

/// Computes the XXH3 of all bytes added. Both widths have one state.
class IST_LOOP_API Checksum {
 public:
  Checksum();
  ~Checksum();
  void add(const void* data, std::size_t bytes);
  /// Returns the XXH3-64.
  [[nodiscard]] std::uint64_t value() const;
  /// Returns the XXH3-128, for which no two different files are known by chance: 32 hexadecimal
  /// digits, as the program xxhsum -H2 prints them.
  [[nodiscard]] std::string text() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ist
