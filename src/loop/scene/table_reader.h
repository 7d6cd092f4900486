#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "loop/scene/toml_document.h"

namespace ist {

/// A closed range of numbers and their unit. NaN is in no range.
struct NumberRange {
  double least, most;
  std::string_view unit;

  [[nodiscard]] bool holds(double value) const { return value >= least && value <= most; }
  /// "from 1 to 2 mm"
  [[nodiscard]] std::string text() const;
  /// "1 to 2", or "from 1 on" if the range has no end
  [[nodiscard]] std::string values() const;
};

/// Reads the values of one table by key. A value of another type or out of range throws
/// kInputInvalid with file, line and remedy. The reader notes each key that it is asked for in
/// TomlTable::known, so that refuse_unknown() finds unknown keys.
class TableReader {
 public:
  /// Both arguments must outlive the reader.
  TableReader(const std::filesystem::path& file, TomlTable& table) : file_(file), table_(table) {}

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// The table's name for messages: "[effects.contact]", or "the file" for the outermost one.
  [[nodiscard]] std::string name() const;
  /// The keys from the outermost table, joined by dots, such as "fixed" or "fixed.2".
  [[nodiscard]] const std::string& path() const { return path_; }

  [[nodiscard]] bool has(std::string_view key);
  /// Whether the value of a key is a text. The key need not be there.
  [[nodiscard]] bool is_text(std::string_view key) const;
  /// A number. Without `otherwise` the key is required.
  [[nodiscard]] double number(std::string_view key, const NumberRange& range);
  [[nodiscard]] double number(std::string_view key, const NumberRange& range, double otherwise);
  [[nodiscard]] Eigen::Vector3d vector(std::string_view key, const NumberRange& range);
  [[nodiscard]] Eigen::Vector3d vector(std::string_view key, const NumberRange& range,
                                       const Eigen::Vector3d& otherwise);
  /// The rotation of a quaternion [w, x, y, z] of any length but 0; the identity if the key is
  /// missing.
  [[nodiscard]] Eigen::Matrix3d rotation(std::string_view key);
  [[nodiscard]] std::uint64_t whole_number(std::string_view key, const NumberRange& range,
                                           std::uint64_t otherwise);
  /// A whole number that is required. A float such as 1e3 is one if it has no fraction.
  [[nodiscard]] std::uint64_t whole_number(std::string_view key, const NumberRange& range);
  [[nodiscard]] bool flag(std::string_view key, bool otherwise);
  /// A text. `what` describes it in messages.
  [[nodiscard]] std::string text(std::string_view key, std::string_view what);
  /// An array of at least one text.
  [[nodiscard]] std::vector<std::string> texts(std::string_view key, std::string_view what);
  /// The value of a name by `find`, which returns an optional. `names` lists the known names.
  template <typename Find>
  [[nodiscard]] auto choice(std::string_view key, const Find& find, std::string_view names) {
    const auto found = find(text(key, names));
    if (!found) fail_value(key, names);
    return *found;
  }

  [[nodiscard]] TableReader table(std::string_view key);
  /// An array of at least one table.
  [[nodiscard]] std::vector<TableReader> tables(std::string_view key);
  /// A table, or an array of at least one.
  [[nodiscard]] std::vector<TableReader> table_or_tables(std::string_view key);

  /// Throws for a wrong value, at its line, or at the table's if the key is missing.
  [[noreturn]] void fail(std::string_view key, std::string_view wrong,
                         std::string_view remedy) const;
  /// Returns the place of a key for messages: "job.toml:5: 'file' in [fixed]".
  [[nodiscard]] std::string place(std::string_view key) const;
  /// Throws if the table has a key that a scene of an earlier version had. `now` completes the
  /// sentence that begins with the key. The key stays unknown.
  void refuse_old(std::string_view key, std::string_view now, std::string_view remedy) const;
  /// Tells all keys that the table may have, before they are read: fail_missing() then names an
  /// unknown one. The texts must outlive the reader.
  void may_have(std::vector<std::string_view> keys) { keys_ = std::move(keys); }
  /// Throws for a missing key, for a key that looks like a misspelling of it, or for one that
  /// may_have() does not name.
  [[noreturn]] void fail_missing(std::string_view key, std::string_view what) const;
  /// Throws for a key that was not asked for, if it looks like a missing one.
  void refuse_misspelt() const;
  /// Throws if the table, or a table in it, has a key that was not asked for.
  void refuse_unknown() const;

 private:
  TableReader(const std::filesystem::path& file, TomlTable& table, std::string path)
      : file_(file), table_(table), path_(std::move(path)) {}

  [[nodiscard]] TomlEntry* entry(std::string_view key) const;
  [[nodiscard]] KnownKey* known(std::string_view key) const;
  [[nodiscard]] TomlValue* find(std::string_view key);
  // Notes what may stand there.
  void note(std::string_view key, std::string values, std::string_view unit = {},
            std::string otherwise = {});
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
  std::string path_;                    // keys from the outermost table, joined by dots
  std::vector<std::string_view> keys_;  // all of the table, if may_have() told them
};

}  // namespace ist
