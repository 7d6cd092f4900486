#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/cli11_fwd.h"

namespace ist::cli {

/// Returns the values of --spheres.
[[nodiscard]] std::vector<std::string> policy_names();

/// Adds an example to the end of a subcommand's help, before the common footer.
void add_example(CLI::App& command, const std::string& example);

/// Adds --max-memory, bytes, of what it says.
void add_max_memory(CLI::App& command, std::uint64_t& bytes,
                    const std::string& of = "voxels and tree");

}  // namespace ist::cli
