#include "ist/scene/scene_lines.h"

#include <fmt/format.h>

#include "ist/base/error.h"
#include "ist/scene/toml_document.h"

namespace ist {

SceneLines::SceneLines(const std::filesystem::path& file, const TomlTable& document) : file_(file) {
  lines_.emplace("", document.line);
  add(document, "");
}

void SceneLines::add(const TomlTable& table, const std::string& path) {
  for (const TomlEntry& entry : table.entries) {
    const std::string key = path.empty() ? entry.key : fmt::format("{}.{}", path, entry.key);
    lines_.emplace(key, entry.value.line);
    if (const auto* inner = std::get_if<TomlTable>(&entry.value.content)) add(*inner, key);
  }
}

void SceneLines::fail(std::string_view key, std::string_view text) const {
  if (lines_.empty()) {
    throw Error(ErrorCode::kInputInvalid, fmt::format("the scene's {}: {}", key, text));
  }
  auto line = lines_.find(key);
  for (std::string_view table = key; line == lines_.end(); line = lines_.find(table)) {
    const std::size_t dot = table.rfind('.');
    table = dot == std::string_view::npos ? std::string_view() : table.substr(0, dot);
  }
  throw Error(ErrorCode::kInputInvalid,
              fmt::format("{}:{}: {}", file_.string(), line->second, text));
}

}  // namespace ist
