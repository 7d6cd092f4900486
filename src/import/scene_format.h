#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>

#include "import/placed_polygons.h"

struct aiScene;

namespace ist::import {

/// Returns the ending that assimp knows for the file's format, or 3mf. The content tells the
/// format, else the file's name. Throws a Refusal for a format that is not read here.
[[nodiscard]] std::string scene_format(const Input& input);

/// Returns the inverse of the turn that assimp gives to a scene's root, if the format does not
/// define that turn; else no turn.
[[nodiscard]] Eigen::Affine3d root_turn(std::string_view format);

/// A unit of a file as a LengthUnit and a factor. A centimetre is 10 mm, a foot 12 inches.
struct StatedUnit {
  LengthUnit unit = LengthUnit::kUnknown;
  double factor = 1;  ///< from the file's unit to `unit`

  friend bool operator==(const StatedUnit&, const StatedUnit&) = default;
};
/// Returns an unknown unit for another name.
[[nodiscard]] StatedUnit unit_of_name(std::string_view name);
/// Returns the unit of an FBX or another scene whose XML states none.
[[nodiscard]] StatedUnit unit_of_scene(std::string_view format, const aiScene& scene);

}  // namespace ist::import
