#pragma once

#include <filesystem>
#include <string>

#include "ist/query/advice/voxel_advice.h"

namespace ist::cli {

/// Prints all sizes that were measured, a JSON object each.
void print_json(const VoxelAdvice& advice);

/// Likewise as a table, and the commands that build what is recommended.
void print_table(const VoxelAdvice& advice, const std::filesystem::path& fixed,
                 const std::filesystem::path& moving);

/// Why nothing is recommended, and what to do.
[[nodiscard]] std::string why_none(const VoxelAdvice& advice, const AdviceGoal& goal);

}  // namespace ist::cli
