#pragma once

#include <filesystem>
#include <string_view>

namespace ist::test {

/// A regular file in memory, for what is written and read thousands of times.
class MemoryFile {
 public:
  MemoryFile();
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// By which this process opens it.
  [[nodiscard]] std::filesystem::path path() const;
  /// Replaces its content.
  void write(std::string_view bytes) const;

 private:
  int descriptor_;
};

}  // namespace ist::test
