#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/bodies.h"

namespace ist::cli {

/// A file that a command reads, by what it is to the command: `fixed`, `mesh`, `tree` and so on.
using NamedFiles = std::vector<std::pair<std::string, std::filesystem::path>>;

/// A unit that a command takes, and whether it is assumed.
struct TakenUnit {
  std::string name;
  bool assumed;
};

/// The same files, after they were read.
using NamedSources = std::vector<std::pair<std::string, MeshSource>>;

/// Returns the first line of --json: version, commit, subcommand, and of each file its base name
/// and its hash (XXH3 of 64 bits; null for what is no regular file); of bodies, their unit, or the
/// one taken, and their voxel sizes, null where they got none.
[[nodiscard]] nlohmann::ordered_json header_line(const std::string& subcommand,
                                                 const NamedSources& files);
[[nodiscard]] nlohmann::ordered_json header_line(const std::string& subcommand,
                                                 const NamedSources& files, const Bodies& bodies,
                                                 const std::optional<TakenUnit>& unit = {});

/// Prints that line. Reads the files for their hashes.
void print_header(const std::string& subcommand, const NamedFiles& files);
void print_header(const std::string& subcommand, const NamedFiles& files, const Bodies& bodies,
                  const std::optional<TakenUnit>& unit = {});

}  // namespace ist::cli
