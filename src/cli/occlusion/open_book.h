#pragma once

#include <Eigen/Geometry>

#include "cli/occlusion/bite.h"

namespace ist::cli {

/// Where both bodies of a bite lie once it is opened: maps of fixed coordinates.
struct OpenedBook {
  Eigen::Isometry3d fixed = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d moving = Eigen::Isometry3d::Identity();
};

/// Opens a bite like a book: turns each body by a quarter about the axis from front to back, so
/// that the sides that faced each other face one viewer, and lays them side by side with `gap` mesh
/// units between their boxes.
[[nodiscard]] OpenedBook opened(const Bite& bite, double gap);

}  // namespace ist::cli
