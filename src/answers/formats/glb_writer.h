#pragma once

#include <filesystem>
#include <span>

#include "answers/formats/poly_data.h"
#include "ist/base/files.h"

namespace ist::answers {

/// Writes glTF 2.0 as one binary file (.glb): a root node, which turns z-up into glTF's y-up and
/// mesh units into metres, and under it a node of its name for each body, with a mesh of its own.
/// A vertex has a POSITION, a NORMAL if there are normals (without them viewers draw flat
/// polygons), and a COLOR_0 if there are colours. Colours of PolyData are sRGB, as screens and
/// pictures have them. COLOR_0 is linear, as glTF requires, with 16 bits each, so that viewers show
/// the colours of the legend. Quads become two triangles each; points without polygons are drawn as
/// points; a body without points is a node alone. Arrays are left out.
///
/// @param metres_per_unit of mesh units, positive: 0.001 for millimetres
///
/// Cost: linear; memory, as much as the file. Precondition: is_consistent() of each body. Errors:
/// kFileUnwritable, also for a file over 4 GiB, which the format cannot hold; kMeshNotFinite for a
/// point beyond float.
void write_glb(std::span<const NamedPolyData> bodies, double metres_per_unit, OutputFile& file);
/// The same, and completes the file.
void write_glb(std::span<const NamedPolyData> bodies, double metres_per_unit,
               const std::filesystem::path& file);

}  // namespace ist::answers
