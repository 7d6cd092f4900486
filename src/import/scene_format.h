#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>

#include "import/placed_polygons.h"

struct aiScene;

namespace ist::import {

/// Returns the extension by which assimp knows a file's format: the content tells it, else the
/// file's name. Throws a Refusal for STL, PLY, OBJ, OFF and 3MF, which assimp is not asked for.
[[nodiscard]] std::string scene_format(const Input& input);

/// Returns the turn that assimp gives to a scene's root, turned back, if the format does not
/// define it.
[[nodiscard]] Eigen::Affine3d root_turn(std::string_view format);

/// Refuses what assimp 5.2 misreads in silence: faces of an X3D that run clockwise, and turns in a
/// constellation of an AMF.
void check_scene(std::string_view format, const Input& input);

/// Sets the unit that the format or the file states.
void tell_unit(std::string_view format, const Input& input, const aiScene& scene,
               PlacedPolygons& placed);

/// A name of a unit, or a length in centimetres, as one of ours and the factor to it: a centimetre
/// is 10 mm, a foot 12 inches.
struct StatedUnit {
  LengthUnit unit = LengthUnit::kUnknown;
  double factor = 1;
};
[[nodiscard]] StatedUnit unit_of_name(std::string_view name);
[[nodiscard]] StatedUnit unit_of_centimetres(double centimetres);

}  // namespace ist::import
