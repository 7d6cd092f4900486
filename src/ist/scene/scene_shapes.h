#pragma once

#include "ist/base/api.h"
#include "ist/mesh/triangle_mesh.h"
#include "ist/scene/scene.h"

namespace ist {

/// The mesh of a built-in shape, closed and facing outward, the same bits on every machine. Its
/// units are the scene's. Spheres (20,480 triangles) and cylinders (1,024) lie within their
/// surface, no farther from it than 3e-4 of their radius.
[[nodiscard]] IST_API TriangleMesh make_shape(const BuiltInShape& shape);

}  // namespace ist
