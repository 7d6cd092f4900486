#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "advise/closing_path.h"
#include "ist/base/progress.h"

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

struct MeasureOptions {
  int workers = 1;            ///< threads of a query, 1 or 2
  std::string target = {};    ///< instruction set; empty: IST_TARGET's, or the best
  double milliseconds = 500;  ///< of timed queries; there are five rounds at least
  std::uint64_t max_memory = std::uint64_t{4} << 30;  ///< bytes, for each tree
};

/// Builds trees of both bodies with slabs, and measures them at `poses`, at least one. `exact` has
/// the triangles. The time is the median of Query::leaf_pairs over at least five rounds, with room
/// for all leaf pairs.
///
/// The error is measured by triangles. On `path` the samples go from first contact outward, until
/// no leaf pair is possible or the surfaces meet again. Without a path the samples are `poses`. If
/// only one of two neighbours of equal rotation has leaf pairs, the way between is bisected.
///
/// Returns nothing if a tree cannot be built (can_build_tree). Cost: both builds, the time of
/// queries, and 0.3 ms for each of some 100 to 400 samples. Throws kTargetMissing; std::bad_alloc.
[[nodiscard]] std::optional<SizeMeasure> measure_size(Query& exact,
                                                      const std::vector<Eigen::Isometry3d>& poses,
                                                      const std::optional<ClosingPath>& path,
                                                      double voxel_size,
                                                      const MeasureOptions& options,
                                                      Progress& progress);

/// The goal of advice.
struct AdviceGoal {
  enum class Of : std::uint8_t {
    kSlowestQuery,  ///< the smallest size that takes at most `limit` microseconds
    kError,         ///< the largest size with an error of at most `limit` mesh units
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

/// The fraction of a requested limit that becomes the goal: times are noisy, a loop has more to do,
/// and errors are larger on paths that were not measured.
inline constexpr double kOfGoal = 0.8;

/// Returns the coarsest voxel size to try for two bodies of these largest extents, mesh units: 1/16
/// of the larger one, or less for a small body. Returns nothing if no size suits both bodies.
[[nodiscard]] std::optional<double> coarsest_size(double fixed_extent, double moving_extent);

struct VoxelAdvice {
  std::vector<SizeMeasure> measured;       ///< coarse to fine
  std::optional<std::size_t> recommended;  ///< index into `measured`, if a size meets the goal
  std::optional<double> too_fine;          ///< the last size that could not be built
};

/// The largest number of voxel sizes that advise_voxel_size() tries.
inline constexpr int kMostSizes = 8;

/// Tries `coarsest` and four sizes below, each a quarter of the one before, until the goal begins
/// or ceases to hold. Then tries up to three sizes between both neighbours, by interpolation of the
/// logarithms. The recommended size was measured to meet the goal. It is within 15 % of the best
/// size if the value is a power law of the size. All sizes have two significant digits.
///
/// @param measure returns nothing for a size that cannot be built
[[nodiscard]] VoxelAdvice advise_voxel_size(
    const AdviceGoal& goal, double coarsest,
    const std::function<std::optional<SizeMeasure>(double voxel_size)>& measure);

}  // namespace ist
