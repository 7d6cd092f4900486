#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace ist::test {

/// A folder of its own for a test, removed with all that is in it.
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

}  // namespace ist::test
