#include "cli/header_line.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/answers/json_text.h"
#include "cli/commit.h"
#include "cli/source_file.h"

namespace ist::cli {
namespace {

using nlohmann::ordered_json;

NamedSources read(const NamedFiles& files) {
  NamedSources sources;
  for (const auto& [name, file] : files) sources.emplace_back(name, source_of(file));
  return sources;
}

}  // namespace

ordered_json header_line(const std::string& subcommand, const NamedSources& files) {
  ordered_json line{{"ist", IST_VERSION}, {"commit", IST_COMMIT}, {"subcommand", subcommand}};
  for (const auto& [name, source] : files) {
    line[name] = {{"file", source.name}, {"hash", nullptr}};
    if (source.hash != 0) line[name]["hash"] = fmt::format("{:016x}", source.hash);
  }
  return line;
}

ordered_json header_line(const std::string& subcommand, const NamedSources& files,
                         const Bodies& bodies, const std::optional<TakenUnit>& unit) {
  const auto or_null = [](const std::optional<double>& size) {
    return size ? ordered_json(*size) : ordered_json(nullptr);
  };
  ordered_json line = header_line(subcommand, files);
  line["unit"] = unit ? ordered_json(unit->name) : json_of(bodies.unit());
  if (unit) line["unit_assumed"] = unit->assumed;
  line["frame"] = json_of(bodies.frame());
  line["voxel_size"] = {or_null(bodies.fixed_voxel_size), or_null(bodies.moving_voxel_size)};
  return line;
}

void print_header(const std::string& subcommand, const NamedFiles& files) {
  print_json(header_line(subcommand, read(files)));
}

void print_header(const std::string& subcommand, const NamedFiles& files, const Bodies& bodies,
                  const std::optional<TakenUnit>& unit) {
  print_json(header_line(subcommand, read(files), bodies, unit));
}

}  // namespace ist::cli
