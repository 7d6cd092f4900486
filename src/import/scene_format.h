#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>

#include "import/placed_polygons.h"

struct aiScene;

namespace ist::import {

/// Returns assimp's extension for a file's format. The content tells the format, else the file's
/// name. Throws a Refusal for STL, PLY, OBJ, OFF and 3MF.
[[nodiscard]] std::string scene_format(const Input& input);

/// Returns the inverse of the turn that assimp gives to a scene's root, if the format does not
/// define that turn; else no turn.
[[nodiscard]] Eigen::Affine3d root_turn(std::string_view format);

/// Sets the unit that the format or the file states.
void tell_unit(std::string_view format, const Input& input, const aiScene& scene,
               PlacedPolygons& placed);

/// A unit of a file as a LengthUnit and a factor. A centimetre is 10 mm, a foot 12 inches.
struct StatedUnit {
  LengthUnit unit = LengthUnit::kUnknown;
  double factor = 1;  ///< from the file's unit to `unit`

  friend bool operator==(const StatedUnit&, const StatedUnit&) = default;
};
/// Returns an unknown unit for another name.
[[nodiscard]] StatedUnit unit_of_name(std::string_view name);
/// Returns the unit of that length; an unknown one for another length.
[[nodiscard]] StatedUnit unit_of_centimetres(double centimetres);

}  // namespace ist::import
