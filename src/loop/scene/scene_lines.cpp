#include "loop/scene/scene_lines.h"

#include <fmt/format.h>

#include "ist/base/throw_error.h"
#include "loop/scene/toml_document.h"

namespace ist {

detail::SceneLines::SceneLines(const TomlTable& document) {
  lines_.emplace("", document.line);
  add(document, "");
}

void detail::SceneLines::add(const TomlTable& table, const std::string& path) {
  for (const TomlEntry& entry : table.entries) {
    const std::string key = path.empty() ? entry.key : fmt::format("{}.{}", path, entry.key);
    lines_.emplace(key, entry.value.line);
    if (const auto* inner = std::get_if<TomlTable>(&entry.value.content)) add(*inner, key);
    const auto* items = std::get_if<std::vector<TomlValue>>(&entry.value.content);
    if (items == nullptr) continue;
    // As TableReader names them.
    for (std::size_t i = 0; i < items->size(); ++i) {
      const auto* inner = std::get_if<TomlTable>(&(*items)[i].content);
      if (inner == nullptr) continue;
      const std::string each = path_of_body(key, i, items->size());
      lines_.insert_or_assign(each, (*items)[i].line);
      add(*inner, each);
    }
  }
}

std::size_t detail::SceneLines::line_of(std::string_view key) const {
  auto line = lines_.find(key);
  while (line == lines_.end()) {
    const std::size_t dot = key.rfind('.');
    key = dot == std::string_view::npos ? std::string_view() : key.substr(0, dot);
    line = lines_.find(key);
  }
  return line->second;
}

std::string path_of_body(std::string_view key, std::size_t index, std::size_t count) {
  return count == 1 ? std::string(key) : fmt::format("{}.{}", key, index + 1);
}

void fail_at(const Scene& scene, std::string_view key, std::string_view text) {
  if (!scene.lines) {
    throw_error(ErrorCode::kInputInvalid, "the scene's {}: {}", key, text);
  }
  throw_error(ErrorCode::kInputInvalid, "{}:{}: {}", scene.file.string(), scene.lines->line_of(key),
              text);
}

}  // namespace ist
