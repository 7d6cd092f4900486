#pragma once

#include "import/placed_polygons.h"

namespace ist::import {

/// Reads a 3MF: the items of its build, with their components, also of other model parts
/// (production extension), in doubles. Modifiers and supports, also of a slicer's project, are left
/// out. Throws a Refusal for what would be lost: beams, low-resolution meshes of slices, negative
/// volumes, cutting meshes, other required extensions.
[[nodiscard]] PlacedPolygons read_3mf(const Input& input);

}  // namespace ist::import
