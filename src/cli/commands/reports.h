#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "advise/voxel_advice.h"
#include "cli/recordings/tooth_forces.h"
#include "ist/haptics/servo_loop.h"
#include "ist/scene.h"

namespace ist::cli {

/// Prints the built and the skipped parts of a scene with reasons, one a line.
void print_notes(const std::vector<BuildNote>& notes, bool json);

/// Prints the results of a run: latencies, deadlines, and the time of each effect. `teeth` may be
/// null.
void print_report(const ServoReport& report, const Scene& scene, const Simulation& simulation,
                  const ToothForces* teeth, bool json);

/// Prints the measured sizes, one JSON object a line.
void print_json(const VoxelAdvice& advice);

/// Prints the measured sizes as a table.
void print_table(const VoxelAdvice& advice);

/// Prints the shell commands that build both trees into the current folder, named after their
/// meshes if these names differ.
void print_build_commands(double voxel_size, const std::filesystem::path& fixed,
                          const std::filesystem::path& moving, std::uint64_t max_memory);

/// Returns the reason why no size is recommended, and a remedy.
[[nodiscard]] std::string why_none(const VoxelAdvice& advice, const AdviceGoal& goal);

}  // namespace ist::cli
