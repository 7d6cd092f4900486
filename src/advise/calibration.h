#pragma once

#include <Eigen/Geometry>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "advise/closing_path.h"
#include "advise/exact_bodies.h"
#include "advise/voxel_advice.h"
#include "ist/base/progress.h"
#include "ist/query/query.h"

namespace ist {

/// Returns the error of voxels on a closing path: the largest distance between the surfaces, by
/// their triangles, at poses with leaf pairs; at most QueryResult::resolution and mostly far less.
/// Samples from first contact outward in steps of 1/16 of a voxel (or 1/64 of the way from first
/// contact, if more) until the surfaces are too far apart for any leaf pair, or intersect again;
/// then bisects for the last leaf pair. Cost: some 70 to 400 times 0.3 ms.
/// @param voxel_size the smaller one of `query`, mesh units
[[nodiscard]] double closing_error(ExactBodies& bodies, Query& query, double voxel_size,
                                   const ClosingPath& path);

/// Returns the error of voxels at these poses; between neighbours of equal rotation of which only
/// one has leaf pairs, bisects the straight way for their beginning. Ignores the way between poses
/// of different rotations, which is unknown. Returns 0 if no pose has leaf pairs and surfaces
/// apart. Cost: 0.3 ms a pose.
[[nodiscard]] double error_at_poses(ExactBodies& bodies, Query& query,
                                    std::span<const Eigen::Isometry3d> poses);

struct CalibrationOptions {
  int workers = 1;     ///< threads of a query, 1 or 2
  std::string target;  ///< instruction set; empty: IST_TARGET's, or the best
  std::uint64_t max_memory = std::uint64_t{4} << 30;  ///< bytes, for each tree
  /// The most timed rounds over all poses, and the longest time for them; at least 5 rounds run.
  std::size_t rounds = 300;
  std::chrono::milliseconds time{1000};
  /// The clock, read before and after each query; another one in tests.
  std::chrono::steady_clock::time_point (*now)() noexcept = &std::chrono::steady_clock::now;
};

/// Measures voxel sizes on two bodies: builds both with slabs, times queries for all leaf pairs and
/// compares them with the distance of the triangles.
class Calibration {
 public:
  /// Times the poses of a closing path; measures errors on it and on paths_beside. `bodies` must
  /// outlive the calibration.
  Calibration(ExactBodies& bodies, const ClosingPath& path, const CalibrationOptions& options);
  /// Times the given poses, at least one, which map moving to fixed mesh coordinates.
  Calibration(ExactBodies& bodies, std::vector<Eigen::Isometry3d> poses,
              const CalibrationOptions& options);

  /// Builds both trees and measures them; returns nothing if one cannot be built (can_build_tree).
  /// The error is the largest closing_error, or error_at_poses. The time is the median of
  /// Query::leaf_pairs at the slowest pose, with room for all leaf pairs, back to back over the
  /// poses in turn. Cost: both builds, at most `time` or 5 rounds, and the error. Throws
  /// kTargetMissing; std::bad_alloc.
  /// @param progress shows the stages, if not null
  [[nodiscard]] std::optional<SizeMeasure> measure(double voxel_size, Progress* progress = nullptr);

  [[nodiscard]] const std::vector<Eigen::Isometry3d>& poses() const noexcept { return poses_; }

 private:
  ExactBodies& bodies_;
  std::vector<ClosingPath> paths_;
  std::vector<Eigen::Isometry3d> poses_;
  CalibrationOptions options_;
};

}  // namespace ist
