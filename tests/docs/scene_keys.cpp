// Lists the keys that the reader of scenes asks for, a line of JSON each: path, values, unit,
// default. The arguments are scenes that name all of them together.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "loop/scene/scene_parts.h"
#include "loop/scene/toml_document.h"

namespace {

void list(const ist::TomlTable& table, const std::string& path) {
  for (const ist::KnownKey& key : table.known) {
    const nlohmann::ordered_json line{{"path", path + key.name},
                                      {"values", key.values},
                                      {"unit", std::string(key.unit)},
                                      {"default", key.otherwise},
                                      {"optional", key.optional}};
    fmt::print("{}\n", line.dump());
  }
  for (const ist::TomlEntry& entry : table.entries) {
    const std::string inner = path + entry.key + ".";
    if (const auto* inside = std::get_if<ist::TomlTable>(&entry.value.content)) {
      list(*inside, inner);
    }
    if (const auto* items = std::get_if<std::vector<ist::TomlValue>>(&entry.value.content)) {
      for (const ist::TomlValue& item : *items) {
        if (const auto* each = std::get_if<ist::TomlTable>(&item.content)) list(*each, inner);
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    ist::TomlTable document = ist::read_toml(argv[i]);
    (void)ist::read_scene(argv[i], document);
    list(document, "");
  }
}
