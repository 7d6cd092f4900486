#pragma once

#include <filesystem>

#include "cli/poses/given_pose.h"

namespace ist::cli {

/// Reads a pose: 16 numbers, row by row, that map moving to fixed coordinates; or a transform that
/// ITK wrote as text, which maps fixed to moving points and so is inverted. Of ITK are read:
/// AffineTransform, MatrixOffsetTransformBase, Rigid3DTransform, VersorRigid3DTransform,
/// Euler3DTransform and TranslationTransform, in three dimensions.
///
/// The pose is rigid. Throws kInputInvalid for another content, and kPoseInvalid for a matrix that
/// project_to_rigid() refuses.
[[nodiscard]] GivenPose read_matrix(const std::filesystem::path& file);

}  // namespace ist::cli
