#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace ist {

struct TomlTable;

/// Where in its file each key of a scene stands, for what turns out to be wrong when all is read.
/// Of a scene that no file says, it knows nothing.
class SceneLines {
 public:
  SceneLines() = default;
  SceneLines(const std::filesystem::path& file, const TomlTable& document);

  /// Throws kInputInvalid for a key by its path, "held.voxel_size": the file and the line where it
  /// stands, or, where it does not, the table that it would stand in, and `text`, which ends in a
  /// remedy.
  [[noreturn]] void fail(std::string_view key, std::string_view text) const;

 private:
  void add(const TomlTable& table, const std::string& path);

  std::filesystem::path file_;
  std::map<std::string, std::size_t, std::less<>> lines_;
};

}  // namespace ist
