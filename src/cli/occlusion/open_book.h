#pragma once

#include <Eigen/Geometry>

#include "cli/occlusion/bite.h"

namespace ist::cli {

/// How both halves of an opened bite lie to each other, as a viewer sees them.
enum class BookLayout {
  kBeside,  ///< side by side, the front of both up
  kAbove,   ///< the fixed body above the moving one, its front up and that of the moving one down
};

/// Where both bodies of a bite lie once it is opened, and how a viewer looks at it: maps and unit
/// vectors of fixed coordinates.
struct OpenedBook {
  Eigen::Isometry3d fixed = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d moving = Eigen::Isometry3d::Identity();
  Eigen::Vector3d viewer = Eigen::Vector3d::UnitX();  ///< towards the eye
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();      ///< from the picture's bottom to its top
};

/// Opens a bite like a book: turns each body by a quarter about one axis, so that the sides that
/// faced each other face one viewer, and lays them apart with `gap` mesh units between. That axis
/// runs from front to back, or from side to side if they lie above each other.
[[nodiscard]] OpenedBook opened(const Bite& bite, double gap,
                                BookLayout layout = BookLayout::kBeside);

}  // namespace ist::cli
