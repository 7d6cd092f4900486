#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

namespace ist::cli {

/// Reads the poses of a JSON file: an array of objects with `pose`, 16 numbers, column by column;
/// other keys are ignored. Throws kFileUnreadable, and kInputInvalid or kPoseInvalid naming the
/// file and the place.
[[nodiscard]] std::vector<Eigen::Isometry3d> read_poses(const std::filesystem::path& file);

}  // namespace ist::cli
