#include "cli/header_line.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/commit.h"
#include "cli/source_file.h"

namespace ist::cli {
namespace {

using nlohmann::ordered_json;

ordered_json line_of(const std::string& subcommand, const NamedFiles& files) {
  ordered_json line{{"ist", IST_VERSION}, {"commit", IST_COMMIT}, {"subcommand", subcommand}};
  for (const auto& [name, file] : files) {
    const MeshSource source = source_of(file);
    line[name] = {{"file", source.name}, {"hash", nullptr}};
    if (source.hash != 0) line[name]["hash"] = fmt::format("{:016x}", source.hash);
  }
  return line;
}

}  // namespace

void print_header(const std::string& subcommand, const NamedFiles& files) {
  fmt::print("{}\n", line_of(subcommand, files).dump());
}

void print_header(const std::string& subcommand, const NamedFiles& files, const Bodies& bodies,
                  const std::optional<TakenUnit>& unit) {
  const auto or_null = [](const std::optional<double>& size) {
    return size ? ordered_json(*size) : ordered_json(nullptr);
  };
  ordered_json line = line_of(subcommand, files);
  line["unit"] = unit ? ordered_json(unit->name) : json_of(bodies.unit());
  if (unit) line["unit_assumed"] = unit->assumed;
  line["voxel_size"] = {or_null(bodies.fixed_voxel_size), or_null(bodies.moving_voxel_size)};
  fmt::print("{}\n", line.dump());
}

}  // namespace ist::cli
