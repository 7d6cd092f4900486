#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>

#include "answers/occlusion/bite.h"

namespace ist::cli {

/// Contacts with higher numbers get no number in a picture: more would hide the map, and the first
/// contacts are the largest.
inline constexpr std::size_t kNumbered = 40;

/// Returns the name of the side that a direction points to; empty if it lies between.
[[nodiscard]] inline std::string side_at(const answers::Bite& bite,
                                         const Eigen::Vector3d& direction) {
  for (const answers::Division* division : {&bite.sides, &bite.fore_aft}) {
    const double along = division->direction.dot(direction);
    if (along > 0.7) return division->first;
    if (along < -0.7) return division->second;
  }
  return "";
}

}  // namespace ist::cli
