#pragma once

#include <Eigen/Core>

#include "answers/occlusion/bite.h"

namespace ist::cli {

/// How a picture looks at a bite: along parallel lines. Directions are of unit length, at right
/// angles to each other, in fixed coordinates.
struct BiteView {
  Eigen::Vector3d across, up;  ///< of the picture: along its lines, and from its bottom to its top
  Eigen::Vector3d towards;     ///< towards the eye: across × up
  Eigen::Vector3d middle;      ///< the point in the picture's middle
  double pixel = 1;            ///< the edge of a pixel, mesh units
};

/// The views of both bodies, each from its occlusal side, and of one scale. One is the other's
/// turned about `across`, as the halves of an opened book: so contacts that face each other lie
/// one above the other, as dentists draw the two arches.
struct BiteViews {
  BiteView fixed, moving;
};

/// Returns the views for pictures of that size, in pixels.
///
/// Looks along the direction between the bodies (bite_direction.h). `Bite::sides` runs across, its
/// first side at the end of the lines. Shows both bodies whole; or the part where they face each
/// other within the reach, up to three times as large, and all contact regions.
[[nodiscard]] BiteViews bite_views(const answers::Bite& bite, int width, int height);

}  // namespace ist::cli
