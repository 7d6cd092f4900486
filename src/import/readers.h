#pragma once

#include <string_view>

#include "import/placed_polygons.h"

namespace ist::import {

/// Reads a file by assimp. The nodes of the scene place its meshes. Polygons stay polygons, and
/// lines and points are left out. The format or the file states the unit. assimp's coordinates and
/// transforms are floats; they are joined in double. scene_format() returns the format.
/// Throws a Refusal for a damaged file, and if assimp would lose or bend a part of the surface.
[[nodiscard]] PlacedPolygons read_scene(Input input, std::string_view format);

/// Reads a 3MF: the items of its build, with their components, also of other model parts
/// (production extension), in doubles. Modifiers and supports, also of a slicer's project, are left
/// out. Throws a Refusal for what would be lost: beams, low-resolution meshes of slices, negative
/// volumes, cutting meshes, other required extensions.
[[nodiscard]] PlacedPolygons read_3mf(const Input& input);

}  // namespace ist::import
