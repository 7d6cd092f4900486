#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace ist {

/// A regular file, read from front to back. Every function throws kFileUnreadable, naming the file
/// and the cause.
class InputFile {
 public:
  explicit InputFile(std::filesystem::path file);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Bytes in the file when it was opened.
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

  /// Reads up to `bytes`; fewer only at the end of the file. Returns the number read.
  std::size_t read(void* data, std::size_t bytes);

  /// What is left of the file, as it is now: it may have grown or shrunk since it was opened.
  [[nodiscard]] std::string read_rest();

 private:
  [[noreturn]] void fail(const char* cause) const;

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace ist
