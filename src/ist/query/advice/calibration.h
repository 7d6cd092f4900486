#pragma once

#include <Eigen/Geometry>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ist/base/progress.h"
#include "ist/query/advice/closing_path.h"
#include "ist/query/advice/exact_bodies.h"
#include "ist/query/advice/voxel_advice.h"

namespace ist {

struct CalibrationOptions {
  int workers = 1;                                    ///< as CollisionOptions have them
  std::string target;                                 ///< likewise
  std::uint64_t max_memory = std::uint64_t{4} << 30;  ///< bytes, for each tree
  /// How often the poses are gone round to be timed, and for how long at most, but 5 times.
  std::size_t rounds = 300;
  std::chrono::milliseconds time{1000};
};

/// Measures voxel sizes on two bodies: builds both, with slabs, asks where they touch at some poses
/// and compares that with their triangles.
class Calibration {
 public:
  /// How many poses of a path are asked.
  static constexpr std::size_t kPoses = 12;

  /// At the poses of a closing; errors on the ways beside it too. `bodies` must outlive it.
  Calibration(ExactBodies& bodies, const ClosingPath& path, const CalibrationOptions& options);
  /// At poses, one at least, that map moving to fixed mesh coordinates.
  Calibration(ExactBodies& bodies, std::vector<Eigen::Isometry3d> poses,
              const CalibrationOptions& options);

  /// Nothing where a tree of this size cannot be built (can_build_tree). Error: the largest
  /// closing_error, or error_at_poses. Time: of each pose the median of CollisionQuery::collide,
  /// with room for all contacts, back to back but no pose twice in a row where there are others;
  /// and of these the largest. Cost: both builds, at most `time` or 5 rounds, and that of the
  /// error. Throws kTargetMissing; std::bad_alloc.
  /// @param progress told of the stages, if not null
  [[nodiscard]] std::optional<SizeMeasure> measure(double voxel_size, Progress* progress = nullptr);

  [[nodiscard]] const std::vector<Eigen::Isometry3d>& poses() const noexcept { return poses_; }

 private:
  ExactBodies& bodies_;
  std::vector<ClosingPath> paths_;
  std::vector<Eigen::Isometry3d> poses_;
  CalibrationOptions options_;
};

}  // namespace ist
