#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

namespace ist::cli {

/// A pose of a user.
struct GivenPose {
  Eigen::Isometry3d pose;
  double rotation_error = 0;  ///< of the given matrix (rotation_error)
};

/// Reads a pose: 16 numbers, row by row, that map moving to fixed coordinates, or a transform of
/// ITK as text. A transform of ITK maps fixed to moving points, so it is inverted. Its types are
/// AffineTransform, MatrixOffsetTransformBase, Rigid3DTransform, VersorRigid3DTransform,
/// Euler3DTransform and TranslationTransform, in three dimensions.
///
/// The returned pose is rigid. Throws kInputInvalid for another content, and kPoseInvalid if
/// project_to_rigid() refuses the matrix.
[[nodiscard]] GivenPose read_matrix(const std::filesystem::path& file);

/// Reads the poses of a JSON file: an array of objects with `pose`, 16 numbers, column by column.
/// Ignores other keys. Throws kFileUnreadable, and kInputInvalid or kPoseInvalid with the file and
/// the place.
[[nodiscard]] std::vector<Eigen::Isometry3d> read_poses(const std::filesystem::path& file);

}  // namespace ist::cli
