#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace ist::test {

/// A temporary folder of a test. The destructor removes it with its content.
class TempDir {
 public:
  TempDir();
  ~TempDir();
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Writes a file of that name and returns its path.
  std::filesystem::path write(std::string_view name, std::string_view bytes) const;
  /// How many entries it holds.
  [[nodiscard]] std::size_t entries() const;

 private:
  std::filesystem::path path_;
};

/// The content of a file.
[[nodiscard]] std::string file_content(const std::filesystem::path& file);

/// A regular file in memory, for tests that write and read it thousands of times.
class MemoryFile {
 public:
  MemoryFile();
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// Returns the path by which this process opens the file.
  [[nodiscard]] std::filesystem::path path() const;
  /// Replaces its content.
  void write(std::string_view bytes) const;

 private:
  int descriptor_;
};

}  // namespace ist::test
