#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "ist/scene.h"

namespace ist {

struct TomlTable;

namespace detail {

/// The lines of a scene's keys in its file, for errors that show only after reading.
class SceneLines {
 public:
  explicit SceneLines(const TomlTable& document);

  /// The line of a key by its path, such as "held.voxel_size"; if the key is missing, the line of
  /// the innermost table of its path that is there.
  [[nodiscard]] std::size_t line_of(std::string_view key) const;

 private:
  void add(const TomlTable& table, const std::string& path);

  std::map<std::string, std::size_t, std::less<>> lines_;
};

}  // namespace detail

/// The path of the table of body `index` (from 0) of `count` under `key`: "fixed", or "fixed.2".
[[nodiscard]] std::string path_of_body(std::string_view key, std::size_t index, std::size_t count);

/// Throws kInputInvalid for a key by its path: the scene's file, the key's line, and `text`, which
/// ends in a remedy. For a scene without a file it names the key instead.
[[noreturn]] void fail_at(const Scene& scene, std::string_view key, std::string_view text);

}  // namespace ist
