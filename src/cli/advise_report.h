#pragma once

#include <filesystem>
#include <string>

#include "ist/query/advice/voxel_advice.h"

namespace ist::cli {

/// Prints all sizes that were measured, a JSON object each.
void print_json(const VoxelAdvice& advice);

/// Likewise as a table.
void print_table(const VoxelAdvice& advice);

/// The commands that build what is recommended, for a shell: into the current folder, by the
/// meshes' names where these differ.
void print_build_commands(double voxel_size, const std::filesystem::path& fixed,
                          const std::filesystem::path& moving, std::uint64_t max_memory);

/// Why nothing is recommended, and what to do.
[[nodiscard]] std::string why_none(const VoxelAdvice& advice, const AdviceGoal& goal);

}  // namespace ist::cli
