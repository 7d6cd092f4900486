#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace ist {

/// Throws kInputInvalid for a place in a text file: its name and the line (from 1), what is wrong
/// there, and what to do about it.
[[noreturn]] void fail_line(const std::filesystem::path& file, std::size_t line,
                            std::string_view wrong, std::string_view remedy);

struct TomlEntry;
struct TomlValue;

struct TomlTable {
  std::size_t line =
      1;  ///< where it is opened; of tables that are only implied, where they first are
  std::vector<TomlEntry> entries;  ///< by key
  std::vector<std::string> asked;  ///< keys that a reader knows: what else is there has no meaning
};

/// A date, a time or both, for which a scene has no use.
struct TomlDate {};

struct TomlValue {
  std::size_t line;
  std::variant<TomlDate, bool, std::int64_t, double, std::string, std::vector<TomlValue>, TomlTable>
      content;
};

struct TomlEntry {
  std::string key;
  TomlValue value;
};

/// What a TOML 1.0 file holds, with lines: UTF-8, with or without a byte order mark, lines ended by
/// \n or \r\n. At most 1 MB, 1000 bytes a line and 8 values in each other.
/// Throws kFileUnreadable, and kInputInvalid for what is no such file.
[[nodiscard]] TomlTable read_toml(const std::filesystem::path& file);

}  // namespace ist
