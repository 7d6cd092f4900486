#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/cli11_fwd.h"

namespace ist::cli {

/// Returns the values of --spheres.
[[nodiscard]] std::vector<std::string> policy_names();

/// Accepts one of `words` in any case, and spells it as they do. For Option::transform().
[[nodiscard]] CLI::Validator one_of(const std::vector<std::string>& words);

/// Accepts the name of a unit in any case. For Option::transform().
[[nodiscard]] CLI::Validator unit_name();

/// Adds an example to the end of a subcommand's help, before the common footer.
void add_example(CLI::App& command, const std::string& example);

/// Adds --max-memory, bytes, of what it says.
void add_max_memory(CLI::App& command, std::uint64_t& bytes,
                    const std::string& of = "voxels and tree");

}  // namespace ist::cli
