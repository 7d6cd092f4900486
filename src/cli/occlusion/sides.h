#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>

#include "cli/occlusion/balance.h"
#include "ist/mesh/mesh.h"

namespace ist::cli {

/// The patient's sides, as a user names them. Nothing is guessed from the shape of a mesh.
struct SideOptions {
  std::string frame;    ///< "lps" or "ras": +x is the patient's left, or right; empty: not said
  std::string left;     ///< x,y,z: the direction of the patient's left
  std::string front;    ///< x,y,z: the direction of the patient's front
  std::string midline;  ///< x,y,z: a point of the plane between left and right
};

/// Returns how shares are parted by side, and from front to back. Sides are called left and right,
/// anterior and posterior only if the user or the files name them; else by the axes, +x and -x, +y
/// and -y. Planes that are not named go through the middle of `box`, fixed coordinates, and are
/// marked as assumed.
///
/// @param of_files the frame that the bodies' files name
///
/// Throws CLI::ValidationError for words that are no directions, and for options that contradict
/// each other or the files.
[[nodiscard]] std::pair<Division, Division> divisions(const SideOptions& options,
                                                      PatientFrame of_files,
                                                      const Eigen::AlignedBox3d& box);

}  // namespace ist::cli
