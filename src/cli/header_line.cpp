#include "cli/header_line.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <system_error>

#include "cli/commit.h"
#include "ist/base/files.h"
#include "ist/tree/tree_stream.h"

namespace ist::cli {
namespace {

using nlohmann::ordered_json;

ordered_json line_of(const std::string& subcommand, const NamedFiles& files) {
  ordered_json line{{"ist", IST_VERSION}, {"commit", IST_COMMIT}, {"subcommand", subcommand}};
  for (const auto& [name, file] : files) {
    line[name] = {{"file", file.filename().string()}, {"hash", nullptr}};
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(file, unknown)) continue;
    const std::string content = InputFile(file).read_rest();
    Checksum sum;
    sum.add(content.data(), content.size());
    line[name]["hash"] = fmt::format("{:016x}", sum.value());
  }
  return line;
}

}  // namespace

void print_header(const std::string& subcommand, const NamedFiles& files) {
  fmt::print("{}\n", line_of(subcommand, files).dump());
}

void print_header(const std::string& subcommand, const NamedFiles& files, const Bodies& bodies) {
  ordered_json line = line_of(subcommand, files);
  line["voxel_size"] = {bodies.fixed.voxel_size(), bodies.moving.voxel_size()};
  fmt::print("{}\n", line.dump());
}

}  // namespace ist::cli
