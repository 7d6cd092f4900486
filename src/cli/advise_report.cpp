#include "cli/advise_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace ist::cli {

void print_json(const VoxelAdvice& advice) {
  for (std::size_t i = 0; i < advice.measured.size(); ++i) {
    const SizeMeasure& size = advice.measured[i];
    const nlohmann::ordered_json line{
        {"voxel_size", size.voxel_size},  {"error", size.error},
        {"resolution", size.resolution},  {"microseconds_worst", size.worst_tick},
        {"hertz", 1e6 / size.worst_tick}, {"build_milliseconds", size.build_milliseconds},
        {"memory", size.bytes},           {"recommended", advice.recommended == i}};
    fmt::print("{}\n", line.dump());
  }
}

void print_table(const VoxelAdvice& advice, const std::filesystem::path& fixed,
                 const std::filesystem::path& moving) {
  fmt::print("{:>12} {:>10} {:>14} {:>14} {:>10} {:>10} {:>10}\n", "voxel size", "error",
             "certain bound", "worst tick µs", "Hz", "build ms", "MB");
  for (std::size_t i = 0; i < advice.measured.size(); ++i) {
    const SizeMeasure& size = advice.measured[i];
    fmt::print("{} {:>10g} {:>10.4g} {:>14.4g} {:>14.1f} {:>10.0f} {:>10.0f} {:>10.1f}\n",
               advice.recommended == i ? '*' : ' ', size.voxel_size, size.error, size.resolution,
               size.worst_tick, 1e6 / size.worst_tick, size.build_milliseconds,
               1e-6 * static_cast<double>(size.bytes));
  }
  if (!advice.recommended) return;
  fmt::print("\n* recommended:\n");
  for (const std::filesystem::path& file : {fixed, moving}) {
    fmt::print("  ist build {} -o {} --voxel-size {:g}\n", file.string(),
               std::filesystem::path(file).replace_extension(".ist").filename().string(),
               advice.measured[*advice.recommended].voxel_size);
  }
}

std::string why_none(const VoxelAdvice& advice, const AdviceGoal& goal) {
  if (advice.measured.empty()) {
    return "no voxel size fits the memory that is allowed: raise --max-memory";
  }
  if (goal.of == AdviceGoal::Of::kWorstTick) {
    const SizeMeasure& coarsest = advice.measured.front();
    return fmt::format(
        "no voxel size keeps {:g} µs, which is the budget without its reserve: even one of {:g} "
        "takes {:.1f} µs: raise --budget-us, or let queries end at a deadline",
        goal.limit, coarsest.voxel_size, coarsest.worst_tick);
  }
  const SizeMeasure& finest = advice.measured.back();
  return fmt::format(
      "no voxel size keeps an error of {:g}: voxels of {:g} have one of {:.4g}, and {}: raise "
      "--error, or ask triangles (--exact)",
      goal.limit, finest.voxel_size, finest.error,
      advice.too_fine ? fmt::format("{:g} needs more memory than --max-memory allows, or is too "
                                    "fine for a lattice",
                                    *advice.too_fine)
                      : std::string("finer ones are not possible"));
}

}  // namespace ist::cli
