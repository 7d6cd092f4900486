#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace ist {

/// A key that a reader of scenes knows. The reader fills it in as it reads, so that the reference
/// of all keys (docs/scene-reference.md) is made of what is read.
struct KnownKey {
  std::string name;
  std::string values = {};     ///< for people: "1 to 2", `"a" or "b"`, "true or false"
  std::string_view unit = {};  ///< of numbers
  std::string otherwise = {};  ///< the default, if the reader has one
  bool optional = false;       ///< the key may be missing
};

/// Throws kInputInvalid with a file, a line (from 1), a cause and a remedy.
[[noreturn]] void fail_line(const std::filesystem::path& file, std::size_t line,
                            std::string_view wrong, std::string_view remedy);

struct TomlEntry;
struct TomlValue;

struct TomlTable {
  std::size_t line = 1;            ///< of its header; of an implied table, of its first key
  std::vector<TomlEntry> entries;  ///< by key
  std::vector<KnownKey> known;     ///< the keys that a reader asked for
};

/// A date, a time or both; no key of a scene has one.
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

/// Reads the text of a TOML file of at most 1 MB. Throws kFileUnreadable; kInputInvalid for more.
[[nodiscard]] std::string read_toml_text(const std::filesystem::path& file);

/// Parses the text of a file, as read_toml() does.
[[nodiscard]] TomlTable parse_toml(const std::filesystem::path& file, std::string_view text);

/// Reads a TOML 1.0 file: UTF-8, with or without a byte order mark, lines ended by \n or \r\n. At
/// most 1 MB, 1000 bytes a line and 8 nested values. Throws kFileUnreadable; kInputInvalid for any
/// other content.
[[nodiscard]] TomlTable read_toml(const std::filesystem::path& file);

}  // namespace ist
