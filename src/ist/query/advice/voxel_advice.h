#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace ist {

/// What voxels of one size came to on a pair of bodies, measured.
struct SizeMeasure {
  double voxel_size = 0;  ///< mesh units
  /// How far apart the surfaces still were, at most, where voxels said that they touch, mesh units.
  double error = 0;
  double resolution = 0;          ///< no such error is ever larger, mesh units
  double worst_tick = 0;          ///< the slowest pose's answer, microseconds
  double build_milliseconds = 0;  ///< of both trees
  std::uint64_t bytes = 0;        ///< in memory, of both trees
};

/// Measures a size; nothing where it cannot be built: the voxels are too many.
using MeasureSize = std::function<std::optional<SizeMeasure>(double voxel_size)>;

/// What is to hold of the voxel size that is looked for.
struct AdviceGoal {
  enum class Of : std::uint8_t {
    kWorstTick,  ///< at most `limit` microseconds: the smallest size that keeps it
    kError,      ///< at most `limit` mesh units: the largest size that keeps it
  };
  Of of;
  double limit;  ///< positive

  [[nodiscard]] double value(const SizeMeasure& measure) const noexcept {
    return of == Of::kError ? measure.error : measure.worst_tick;
  }
  [[nodiscard]] bool holds(const SizeMeasure& measure) const noexcept {
    return value(measure) <= limit;
  }
};

/// The sizes that are tried, mesh units: `first` first, and none that is finer or coarser.
struct SizeRange {
  double finest, first, coarsest;
};

struct VoxelAdvice {
  std::vector<SizeMeasure> measured;       ///< from coarse to fine
  std::optional<std::size_t> recommended;  ///< of those; nothing where none holds the goal
  /// The largest size that could not be built; nothing where none was met.
  std::optional<double> too_fine;
};

/// Looks for the voxel size that a goal asks for: by factors of at most 3 until one size holds it
/// and another does not, then between them, as if value and size went by a power law. What it
/// recommends was measured to hold; and a size that is 1.15 times as fine (of kError as coarse) was
/// measured not to, or the value is within a tenth of the limit, or the range ends there, or what
/// is 1.5 times as fine cannot be built. Of curves that go up and down it finds one such place.
///
/// All sizes are of two significant digits. Cost: 4 to 8 measures where the goal is 10 to 30 times
/// as fine as the first size, 40 at most.
[[nodiscard]] VoxelAdvice advise_voxel_size(const AdviceGoal& goal, const SizeRange& range,
                                            const MeasureSize& measure);

/// A number of two significant digits: the next one up, or the next one down. Precondition:
/// positive and finite.
[[nodiscard]] double round_to_two_digits(double size, bool up);

}  // namespace ist
