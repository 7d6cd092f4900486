#pragma once

#include <string_view>

#include "import/placed_polygons.h"

namespace ist::import {

/// Reads a file by assimp. The nodes of the scene place its meshes. Polygons stay polygons, and
/// lines and points are left out. The format or the file states the unit. assimp's coordinates and
/// transforms are floats; they are joined in double. scene_format() returns the format.
/// Throws a Refusal for a damaged file, and if assimp would lose or bend a part of the surface.
[[nodiscard]] PlacedPolygons read_scene(Input input, std::string_view format);

}  // namespace ist::import
