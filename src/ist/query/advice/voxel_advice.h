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
  double resolution = 0;  ///< no such error is ever larger, mesh units
  /// Of the slowest pose the median time of all leaf pairs, microseconds. Contact points and
  /// effects, which a tick of a servo loop needs besides, come on top.
  double slowest_query = 0;
  /// Leaf pairs at the pose that has most; 0 where voxels touch at none, and nothing was measured
  /// that could be slow.
  std::uint64_t most_contacts = 0;
  double build_milliseconds = 0;  ///< of both trees
  std::uint64_t bytes = 0;        ///< in memory, of both trees
};

/// Measures a size; nothing where it cannot be built: the voxels are too many.
using MeasureSize = std::function<std::optional<SizeMeasure>(double voxel_size)>;

/// What is to hold of the voxel size that is looked for.
struct AdviceGoal {
  enum class Of : std::uint8_t {
    kSlowestQuery,  ///< at most `limit` microseconds: the smallest size that keeps it
    kError,         ///< at most `limit` mesh units: the largest size that keeps it
  };
  Of of;
  double limit;  ///< positive

  [[nodiscard]] double value(const SizeMeasure& measure) const noexcept {
    return of == Of::kError ? measure.error : measure.slowest_query;
  }
  [[nodiscard]] bool holds(const SizeMeasure& measure) const noexcept {
    return value(measure) <= limit;
  }
};

/// The sizes that are tried, mesh units: `first` first, and none that is finer or coarser. The
/// coarsest is at least 1.2 times the finest, so that a size of two digits is between them.
struct SizeRange {
  double finest, first, coarsest;
};

/// For two bodies of these largest extents, mesh units: from a fiftieth of the larger one on, down
/// to what a lattice holds and up to a fifth. Nothing where one is so small that no size is for
/// both.
[[nodiscard]] std::optional<SizeRange> sizes_between(double fixed_extent, double moving_extent);

/// So much of what is asked for is made the goal: times are noisy and a loop has more to do, and
/// errors are a little larger on ways that were not measured.
inline constexpr double kOfGoal = 0.8;

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

/// The same number where it has no more than two significant digits, else the next one up or down
/// that has. Precondition: positive and finite.
[[nodiscard]] double round_to_two_digits(double size, bool up);

}  // namespace ist
