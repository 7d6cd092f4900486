#pragma once

#include "import/placed_polygons.h"

namespace ist::import {

/// Reads a file by assimp: each mesh where the nodes of its scene place it, polygons as they are.
/// Lines and points are left out. The unit is the one that the format or the file states.
/// Coordinates and transforms are floats, as assimp holds them; they are placed in double.
/// Throws a Refusal also where assimp would leave out or bend a part of the surface.
[[nodiscard]] PlacedPolygons read_scene(const Input& input);

}  // namespace ist::import
