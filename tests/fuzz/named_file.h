#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>

#include "support/temp_dir.h"

namespace ist::test {

/// One file in memory, by each of its names.
class NamedFile {
 public:
  explicit NamedFile(std::initializer_list<const char*> names) {
    for (const char* name : names) {
      std::filesystem::create_symlink(file_.path(), folder_.path() / name);
    }
  }
  /// Replaces its content, and returns its path by one of the names.
  [[nodiscard]] std::filesystem::path write(std::string_view name, std::string_view bytes) const {
    file_.write(bytes);
    return folder_.path() / name;
  }

 private:
  MemoryFile file_;
  TempDir folder_;
};

}  // namespace ist::test
