#pragma once

#include <Eigen/Geometry>
#include <filesystem>

namespace ist::cli {

/// Reads a pose: 16 numbers, row by row, that map moving to fixed coordinates; or a transform that
/// ITK wrote as text, which maps fixed to moving points and so is inverted. Of ITK are read:
/// AffineTransform, MatrixOffsetTransformBase, Rigid3DTransform, VersorRigid3DTransform,
/// Euler3DTransform and TranslationTransform, in three dimensions.
///
/// Throws kInputInvalid for another content, kPoseInvalid for a matrix that project_to_rigid() refuses.
[[nodiscard]] Eigen::Isometry3d read_matrix(const std::filesystem::path& file);

}  // namespace ist::cli
