#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ist/scene/toml_document.h"

namespace ist {

/// What a number may be, ends included, and its unit. NaN and infinities are in no range.
struct NumberRange {
  double least, most;
  std::string_view unit;
};

/// Reads one table of a file: values by key, each of the type and in the range that is asked for.
/// Whatever else is there throws kInputInvalid with file, line and remedy. It notes what it is
/// asked for, so that refuse_unknown() finds what nobody knows.
class TableReader {
 public:
  /// Both must outlive it.
  TableReader(const std::filesystem::path& file, TomlTable& table) : file_(file), table_(table) {}

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// As it stands in the file, for texts: "[effects.contact]", "the file" for the outermost one.
  [[nodiscard]] std::string name() const;

  [[nodiscard]] bool has(std::string_view key);
  /// Without a value that stands for a missing one, the key must be there.
  [[nodiscard]] double number(std::string_view key, const NumberRange& range);
  [[nodiscard]] double number(std::string_view key, const NumberRange& range, double otherwise);
  [[nodiscard]] Eigen::Vector3d vector(std::string_view key, const NumberRange& range);
  [[nodiscard]] Eigen::Vector3d vector(std::string_view key, const NumberRange& range,
                                       const Eigen::Vector3d& otherwise);
  /// Of a quaternion [w, x, y, z] of any length but 0; no rotation where the key is missing.
  [[nodiscard]] Eigen::Matrix3d rotation(std::string_view key);
  [[nodiscard]] std::uint64_t whole_number(std::string_view key, std::uint64_t otherwise);
  [[nodiscard]] bool flag(std::string_view key, bool otherwise);
  /// @param what may stand there, for people
  [[nodiscard]] std::string text(std::string_view key, std::string_view what);
  /// What `find` knows by the name that stands there: it returns an optional.
  template <typename Find>
  [[nodiscard]] auto choice(std::string_view key, const Find& find, std::string_view names) {
    const auto found = find(text(key, names));
    if (!found) fail_value(key, names);
    return *found;
  }

  [[nodiscard]] TableReader table(std::string_view key);
  /// An array of at least one table.
  [[nodiscard]] std::vector<TableReader> tables(std::string_view key);

  /// What is wrong with a key, by the line where its value stands; without it by the table's.
  [[noreturn]] void fail(std::string_view key, std::string_view wrong,
                         std::string_view remedy) const;
  /// That a mandatory key is missing, or looks misspelt.
  [[noreturn]] void fail_missing(std::string_view key, std::string_view what) const;
  /// Refuses what nobody asked for, here and in all that is below.
  void refuse_unknown() const;

 private:
  TableReader(const std::filesystem::path& file, TomlTable& table, std::string path)
      : file_(file), table_(table), path_(std::move(path)) {}

  [[nodiscard]] TomlEntry* entry(std::string_view key) const;
  [[nodiscard]] bool is_asked(std::string_view key) const;
  [[nodiscard]] TomlValue* find(std::string_view key);
  [[nodiscard]] TomlValue& required(std::string_view key, std::string_view what);
  [[nodiscard]] double number_of(const TomlValue& value, std::string_view key,
                                 const NumberRange& range) const;
  template <std::size_t kCount>
  [[nodiscard]] std::array<double, kCount> numbers(std::string_view key, const NumberRange& range,
                                                   std::string_view what);
  [[noreturn]] void fail_value(std::string_view key, std::string_view what) const;
  [[noreturn]] void fail_unknown(const TomlEntry& entry) const;
  [[nodiscard]] std::string path_of(std::string_view key) const;

  const std::filesystem::path& file_;
  TomlTable& table_;
  std::string path_;  // its keys from the outermost table on, joined by dots
};

}  // namespace ist
