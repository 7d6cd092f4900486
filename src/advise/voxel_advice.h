#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace ist {

/// The measurement of one voxel size on a pair of bodies.
struct SizeMeasure {
  double voxel_size = 0;  ///< mesh units
  /// The largest distance between the surfaces at a pose with leaf pairs, mesh units.
  double error = 0;
  double resolution = 0;  ///< upper bound of the error at any pose, mesh units
  /// The median time of all leaf pairs at the slowest pose, microseconds; without contact points
  /// and effects, which a servo tick needs besides.
  double slowest_query = 0;
  /// The largest number of leaf pairs at a pose; if 0, no measured query could be slow.
  std::uint64_t max_leaf_pairs = 0;
  double build_milliseconds = 0;  ///< both trees
  std::uint64_t bytes = 0;        ///< in memory, both trees
};

/// Measures a voxel size; returns nothing if its voxels are too many to build.
using MeasureSize = std::function<std::optional<SizeMeasure>(double voxel_size)>;

/// The goal of a search for a voxel size.
struct AdviceGoal {
  enum class Of : std::uint8_t {
    kSlowestQuery,  ///< the smallest size that takes at most `limit` microseconds
    kError,         ///< the largest size whose error is at most `limit` mesh units
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

/// The range of a search, mesh units: `first` is tried first, nothing finer than `finest` or
/// coarser than `coarsest`. The coarsest is at least 1.2 times the finest, so that a size of two
/// digits lies between them.
struct SizeRange {
  double finest, first, coarsest;
};

/// Returns the range for two bodies of these largest extents, mesh units: first 1/50 of the larger
/// extent, down to the finest lattice and up to 1/5. Returns nothing if one body is too small for a
/// common size.
[[nodiscard]] std::optional<SizeRange> sizes_between(double fixed_extent, double moving_extent);

/// The fraction of a requested limit that becomes the goal: times are noisy, a loop has more to do,
/// and errors are a little larger on paths that were not measured.
inline constexpr double kOfGoal = 0.8;

struct VoxelAdvice {
  std::vector<SizeMeasure> measured;       ///< coarse to fine
  std::optional<std::size_t> recommended;  ///< index into `measured`, if a size meets the goal
  /// The largest size that could not be built; nothing if all could.
  std::optional<double> too_fine;
};

/// Searches for the voxel size of a goal: by factors of at most 3 until one size meets it and
/// another does not, then between them, as if the value were a power law of the size. The
/// recommended size was measured to meet the goal; and a size 1.15 times as fine (for kError as
/// coarse) was measured to miss it, or the value is within a tenth of the limit, or the range ends
/// there, or a size 1.5 times as fine cannot be built. If the value is not monotonic, finds one
/// such size.
///
/// All sizes have two significant digits. Cost: 4 to 8 measurements if the goal is 10 to 30 times
/// as fine as the first size, at most 40.
[[nodiscard]] VoxelAdvice advise_voxel_size(const AdviceGoal& goal, const SizeRange& range,
                                            const MeasureSize& measure);

/// Rounds a number up or down to two significant digits; leaves one with no more unchanged.
/// Precondition: positive and finite.
[[nodiscard]] double round_to_two_digits(double size, bool up);

}  // namespace ist
