#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace ist::cli {

/// Reads a file line by line. The file may be a pipe, whose writer may be slow: a request to stop
/// ends the waiting. Every function throws kFileUnreadable with the file and the cause.
class LineReader {
 public:
  /// Opens the file. A pipe needs no writer yet.
  explicit LineReader(std::filesystem::path file);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// The size of the file when it was opened, bytes; 0 of a pipe.
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }

  /// Returns the next line without its end, or nothing at the end of the file. Returns nothing
  /// within 0.1 s after `stop` is set, if the line is not there yet.
  [[nodiscard]] std::optional<std::string> next(const std::atomic<bool>& stop);

 private:
  [[nodiscard]] bool read_more(const std::atomic<bool>& stop);
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::string text_;       // read, and in part returned
  std::size_t begin_ = 0;  // of the next line in it
};

}  // namespace ist::cli
