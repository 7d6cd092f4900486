#include "loop/scene/table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "loop/scene/spelling.h"

namespace ist {
namespace {

// The text of a value for messages.
struct Shown {
  std::string operator()(const TomlDate&) const { return "a date or a time"; }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
  std::string operator()(double value) const { return fmt::format("{}", value); }
  std::string operator()(const std::string& value) const {
    constexpr std::size_t kMost = 80;
    const bool plain = std::none_of(value.begin(), value.end(),
                                    [](char c) { return static_cast<unsigned char>(c) < ' '; });
    return plain && value.size() <= kMost ? fmt::format("\"{}\"", value)
                                          : fmt::format("a text of {} bytes", value.size());
  }
  std::string operator()(const std::vector<TomlValue>& value) const {
    return fmt::format("an array of {}", value.size());
  }
  std::string operator()(const TomlTable&) const { return "a table"; }
};

std::optional<double> as_number(const TomlValue& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value.content)) {
    return static_cast<double>(*integer);
  }
  if (const auto* real = std::get_if<double>(&value.content)) return *real;
  return std::nullopt;
}

// The whole number of a value, as 1000 or 1e3, below 2^63.
std::optional<std::int64_t> as_whole_number(const TomlValue& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value.content)) return *integer;
  constexpr double kEnd = 0x1p63;
  const auto* real = std::get_if<double>(&value.content);
  const bool is_whole = real != nullptr && std::abs(*real) < kEnd && std::trunc(*real) == *real;
  return is_whole ? std::optional(static_cast<std::int64_t>(*real)) : std::nullopt;
}

std::string triple_in(const NumberRange& range) {
  return fmt::format("[x, y, z], {} each", range.values());
}

}  // namespace

std::string NumberRange::text() const {
  return fmt::format("from {} to {}{}{}", least, most, unit.empty() ? "" : " ", unit);
}

std::string NumberRange::values() const {
  return std::isinf(most) ? fmt::format("from {} on", least) : fmt::format("{} to {}", least, most);
}

std::string TableReader::name() const {
  return path_.empty() ? "the file" : fmt::format("[{}]", path_);
}

std::string TableReader::path_of(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

TomlEntry* TableReader::entry(std::string_view key) const {
  const auto found = std::find_if(table_.entries.begin(), table_.entries.end(),
                                  [key](const TomlEntry& each) { return each.key == key; });
  return found == table_.entries.end() ? nullptr : &*found;
}

KnownKey* TableReader::known(std::string_view key) const {
  const auto found = std::find_if(table_.known.begin(), table_.known.end(),
                                  [key](const KnownKey& each) { return each.name == key; });
  return found == table_.known.end() ? nullptr : &*found;
}

void TableReader::note(std::string_view key, std::string values, std::string_view unit,
                       std::string otherwise) {
  if (known(key) == nullptr) table_.known.push_back({std::string(key)});
  KnownKey& noted = *known(key);
  noted.values = std::move(values);
  noted.unit = unit;
  if (!otherwise.empty()) noted.otherwise = std::move(otherwise);
}

TomlValue* TableReader::find(std::string_view key) {
  if (known(key) == nullptr) table_.known.push_back({std::string(key)});
  TomlEntry* found = entry(key);
  return found == nullptr ? nullptr : &found->value;
}

TomlValue& TableReader::required(std::string_view key, std::string_view what) {
  TomlValue* value = find(key);
  if (value == nullptr) fail_missing(key, what);
  return *value;
}

bool TableReader::has(std::string_view key) {
  const bool is_there = find(key) != nullptr;
  known(key)->optional = true;
  return is_there;
}

bool TableReader::is_text(std::string_view key) const {
  const TomlEntry* found = entry(key);
  return found != nullptr && std::holds_alternative<std::string>(found->value.content);
}

std::string TableReader::place(std::string_view key) const {
  const TomlEntry* found = entry(key);
  return fmt::format("{}:{}: '{}' in {}", file_.string(),
                     found == nullptr ? table_.line : found->value.line, key, name());
}

double TableReader::number_of(const TomlValue& value, std::string_view key,
                              const NumberRange& range) const {
  const std::optional<double> number = as_number(value);
  if (!number || !range.holds(*number)) {
    fail_line(file_, value.line,
              fmt::format("'{}' in {} is {}", key, name(), std::visit(Shown(), value.content)),
              "give a number " + range.text());
  }
  return *number;
}

double TableReader::number(std::string_view key, const NumberRange& range) {
  note(key, range.values(), range.unit);
  return number_of(required(key, "a number " + range.text()), key, range);
}

double TableReader::number(std::string_view key, const NumberRange& range, double otherwise) {
  note(key, range.values(), range.unit, fmt::format("{}", otherwise));
  return has(key) ? number(key, range) : otherwise;
}

template <std::size_t kCount>
std::array<double, kCount> TableReader::numbers(std::string_view key, const NumberRange& range,
                                                std::string_view what) {
  const auto* items = std::get_if<std::vector<TomlValue>>(&required(key, what).content);
  if (items == nullptr || items->size() != kCount) fail_value(key, what);
  std::array<double, kCount> values;
  std::transform(items->begin(), items->end(), values.begin(),
                 [&](const TomlValue& item) { return number_of(item, key, range); });
  return values;
}

Eigen::Vector3d TableReader::vector(std::string_view key, const NumberRange& range) {
  note(key, triple_in(range), range.unit);
  const auto [x, y, z] = numbers<3>(key, range, "[x, y, z], three numbers " + range.text());
  return {x, y, z};
}

Eigen::Vector3d TableReader::vector(std::string_view key, const NumberRange& range,
                                    const Eigen::Vector3d& otherwise) {
  note(key, triple_in(range), range.unit,
       fmt::format("[{}, {}, {}]", otherwise.x(), otherwise.y(), otherwise.z()));
  return has(key) ? vector(key, range) : otherwise;
}

Eigen::Matrix3d TableReader::rotation(std::string_view key) {
  constexpr std::string_view kWhat = "[w, x, y, z], a quaternion: [1, 0, 0, 0] is no turn";
  constexpr NumberRange kRange{-1e3, 1e3, ""};
  note(key, fmt::format("[w, x, y, z], {} each", kRange.values()), {}, "no turn");
  if (!has(key)) return Eigen::Matrix3d::Identity();
  std::array<double, 4> given = numbers<4>(key, kRange, kWhat);
  double largest = 0;
  for (const double part : given) largest = std::max(largest, std::abs(part));
  if (largest == 0) fail_value(key, kWhat);
  // The quaternion may have any length but 0. A power of two scales it: no square underflows.
  int exponent = 0;
  std::frexp(largest, &exponent);
  for (double& part : given) part = std::ldexp(part, -exponent);
  const auto [w, x, y, z] = given;
  const double s = 2 / (w * w + x * x + y * y + z * z);
  Eigen::Matrix3d turn;
  turn << 1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),  //
      s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x),      //
      s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y);
  return turn;
}

std::uint64_t TableReader::whole_number(std::string_view key, const NumberRange& range,
                                        std::uint64_t otherwise) {
  note(key, "a whole number, " + range.values(), range.unit, fmt::format("{}", otherwise));
  return has(key) ? whole_number(key, range) : otherwise;
}

std::uint64_t TableReader::whole_number(std::string_view key, const NumberRange& range) {
  const std::string what = "a whole number, " + range.values();
  note(key, what, range.unit);
  const std::optional<std::int64_t> integer = as_whole_number(required(key, what));
  if (!integer || !range.holds(static_cast<double>(*integer))) fail_value(key, what);
  return static_cast<std::uint64_t>(*integer);
}

bool TableReader::flag(std::string_view key, bool otherwise) {
  note(key, "true or false", {}, otherwise ? "true" : "false");
  if (!has(key)) return otherwise;
  const auto* truth = std::get_if<bool>(&find(key)->content);
  if (truth == nullptr) fail_value(key, "true or false");
  return *truth;
}

std::string TableReader::text(std::string_view key, std::string_view what) {
  note(key, std::string(what));
  const auto* text = std::get_if<std::string>(&required(key, what).content);
  // The system would end a name at a byte of 0.
  if (text == nullptr || text->find('\0') != std::string::npos) fail_value(key, what);
  return *text;
}

std::vector<std::string> TableReader::texts(std::string_view key, std::string_view what) {
  note(key, std::string(what));
  const auto* items = std::get_if<std::vector<TomlValue>>(&required(key, what).content);
  if (items == nullptr || items->empty()) fail_value(key, what);
  std::vector<std::string> texts;
  for (const TomlValue& item : *items) {
    const auto* text = std::get_if<std::string>(&item.content);
    if (text == nullptr) fail_value(key, what);
    texts.push_back(*text);
  }
  return texts;
}

TableReader TableReader::table(std::string_view key) {
  const std::string what = fmt::format("a table, [{}]", path_of(key));
  note(key, "a table");
  auto* table = std::get_if<TomlTable>(&required(key, what).content);
  if (table == nullptr) fail_value(key, what);
  return {file_, *table, path_of(key)};
}

std::vector<TableReader> TableReader::tables(std::string_view key) {
  constexpr std::string_view kWhat = "an array of tables, such as [ { … }, { … } ]";
  note(key, "an array of tables");
  auto* items = std::get_if<std::vector<TomlValue>>(&required(key, kWhat).content);
  if (items == nullptr || items->empty()) fail_value(key, kWhat);
  std::vector<TableReader> readers;
  for (TomlValue& item : *items) {
    auto* table = std::get_if<TomlTable>(&item.content);
    if (table == nullptr) fail_value(key, kWhat);
    readers.push_back({file_, *table, fmt::format("{}.{}", path_of(key), readers.size() + 1)});
  }
  return readers;
}

std::vector<TableReader> TableReader::table_or_tables(std::string_view key) {
  const TomlEntry* found = entry(key);
  if (found == nullptr || !std::holds_alternative<std::vector<TomlValue>>(found->value.content)) {
    return {table(key)};
  }
  std::vector<TableReader> readers = tables(key);
  note(key, "a table");
  if (readers.size() == 1) readers.front().path_ = path_of(key);
  return readers;
}

void TableReader::fail(std::string_view key, std::string_view wrong,
                       std::string_view remedy) const {
  const TomlEntry* found = entry(key);
  fail_line(file_, found == nullptr ? table_.line : found->value.line, wrong, remedy);
}

void TableReader::fail_value(std::string_view key, std::string_view what) const {
  fail(key,
       fmt::format("'{}' in {} is {}", key, name(), std::visit(Shown(), entry(key)->value.content)),
       fmt::format("give {}", what));
}

void TableReader::refuse_old(std::string_view key, std::string_view now,
                             std::string_view remedy) const {
  if (entry(key) == nullptr) return;
  fail(key, fmt::format("'{}' in {} {}", key, name(), now), remedy);
}

void TableReader::refuse_misspelt() const {
  for (const TomlEntry& each : table_.entries) {
    if (known(each.key) != nullptr) continue;
    for (const KnownKey& key_known : table_.known) {
      if (entry(key_known.name) == nullptr && looks_like(each.key, key_known.name)) {
        fail_unknown(each);
      }
    }
  }
}

void TableReader::fail_missing(std::string_view key, std::string_view what) const {
  refuse_misspelt();
  for (const TomlEntry& each : table_.entries) {
    if (keys_.empty() || std::find(keys_.begin(), keys_.end(), each.key) != keys_.end()) continue;
    fail_line(file_, each.value.line,
              fmt::format("'{}' in {} is unknown, and there is no '{}'", each.key, name(), key),
              fmt::format("give '{}', {}", key, what));
  }
  fail(key, fmt::format("{} has no '{}'", name(), key), fmt::format("give {}", what));
}

void TableReader::fail_unknown(const TomlEntry& entry) const {
  std::vector<std::string> names;
  for (const KnownKey& each : table_.known) names.push_back(each.name);
  const auto nearest =
      std::min_element(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
        return edits(entry.key, a) < edits(entry.key, b);
      });
  std::string remedy;
  if (nearest != names.end() && looks_like(entry.key, *nearest)) {
    remedy = fmt::format("did you mean '{}'?", *nearest);
  } else {
    remedy = fmt::format("take it out; known here are {}", fmt::join(names, ", "));
  }
  fail_line(file_, entry.value.line, fmt::format("'{}' in {} is unknown", entry.key, name()),
            remedy);
}

void TableReader::refuse_unknown() const {
  const auto descend = [this](TomlValue& value, const std::string& path) {
    if (auto* table = std::get_if<TomlTable>(&value.content)) {
      TableReader(file_, *table, path).refuse_unknown();
    }
  };
  refuse_misspelt();
  for (TomlEntry& each : table_.entries) {
    if (known(each.key) == nullptr) fail_unknown(each);
    descend(each.value, path_of(each.key));
    if (auto* items = std::get_if<std::vector<TomlValue>>(&each.value.content)) {
      for (std::size_t i = 0; i < items->size(); ++i) {
        descend((*items)[i], fmt::format("{}.{}", path_of(each.key), i + 1));
      }
    }
  }
}

}  // namespace ist
