#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/commands/reports.h"
#include "cli/terminal.h"
#include "ist/tree/sphere_tree.h"

namespace ist::cli {

void print_json(const VoxelAdvice& advice) {
  for (std::size_t i = 0; i < advice.measured.size(); ++i) {
    const SizeMeasure& size = advice.measured[i];
    print_json({{"voxel_size", size.voxel_size},
                {"error", size.error},
                {"resolution", size.resolution},
                {"microseconds_slowest", size.slowest_query},
                {"hertz", 1e6 / size.slowest_query},
                {"build_milliseconds", size.build_milliseconds},
                {"memory", size.bytes},
                {"recommended", advice.recommended == i}});
  }
}

void print_table(const VoxelAdvice& advice) {
  fmt::print("{:>12} {:>10} {:>14} {:>14} {:>10} {:>10} {:>10}\n", "voxel size", "error",
             "certain bound", "slowest, µs", "Hz", "build ms", "MB");
  for (std::size_t i = 0; i < advice.measured.size(); ++i) {
    const SizeMeasure& size = advice.measured[i];
    fmt::print("{} {:>10g} {:>10.4g} {:>14.4g} {:>14.1f} {:>10.0f} {:>10.0f} {:>10.1f}\n",
               advice.recommended == i ? '*' : ' ', size.voxel_size, size.error, size.resolution,
               size.slowest_query, 1e6 / size.slowest_query, size.build_milliseconds,
               1e-6 * static_cast<double>(size.bytes));
  }
}

void print_build_commands(double voxel_size, const std::filesystem::path& fixed,
                          const std::filesystem::path& moving, std::uint64_t max_memory) {
  const auto tree_of = [](const std::filesystem::path& mesh) {
    return std::filesystem::path(mesh.filename()).replace_extension(".ist").string();
  };
  const bool same = tree_of(fixed) == tree_of(moving);
  fmt::print("\n* recommended:\n");
  for (const auto& [mesh, name] :
       {std::pair(fixed, "fixed.ist"), std::pair(moving, "moving.ist")}) {
    const std::string tree = same ? name : tree_of(mesh);
    fmt::print("  {} build {} -o {} --voxel-size {:g}{}\n", command_word(), quoted(mesh.string()),
               quoted(tree), voxel_size,
               max_memory == BuildOptions{}.max_memory
                   ? std::string()
                   : fmt::format(" --max-memory {}", max_memory));
  }
}

std::string why_none(const VoxelAdvice& advice, const AdviceGoal& goal) {
  if (advice.measured.empty()) {
    return "no voxel size fits the allowed memory: raise --max-memory";
  }
  if (goal.of == AdviceGoal::Of::kSlowestQuery) {
    const SizeMeasure& coarsest = advice.measured.front();
    return fmt::format(
        "no voxel size keeps {:g} µs, which is 80 % of the budget: even voxels of {:g} take {:.1f} "
        "µs: raise --budget-us, or let queries end at a deadline",
        goal.limit, coarsest.voxel_size, coarsest.slowest_query);
  }
  const SizeMeasure& finest = advice.measured.back();
  return fmt::format(
      "no voxel size keeps an error of {:g}, which is 80 % of --error: voxels of {:g} have an "
      "error of {:.4g}, and {}: raise --error, or use triangles, which have none",
      goal.limit, finest.voxel_size, finest.error,
      advice.too_fine ? fmt::format("{:g} needs more memory than --max-memory allows, or is too "
                                    "fine for a lattice",
                                    *advice.too_fine)
                      : std::string("finer voxels are not tried"));
}

}  // namespace ist::cli
