#pragma once

#include <filesystem>

#include "ist/base/api.h"
#include "ist/mesh/triangle_mesh.h"

namespace ist {

/// Reads STL (binary or text), PLY (binary or text) or OBJ. The content decides which; the name
/// helps only for an OBJ. Several solids or groups become one mesh, polygons become triangles, and
/// vertices in the same place become one. Vertices are floats, in the order in which the faces
/// name them first; those that no face names are left out, as are the file's normals, colours
/// and materials. The file is read once.
///
/// Cost: linear in the file, some 50 ms for 100,000 triangles; memory, some eight times the file.
/// Errors: kFileUnreadable, kNotAMesh, kMeshEmpty, kMeshPointsOnly, kMeshTruncated, kMeshBadIndex,
/// kMeshNotFinite, kMeshExtent; the text names the file and the place in it.
[[nodiscard]] IST_API TriangleMesh read_mesh(const std::filesystem::path& file);

/// Writes binary STL: little-endian, coordinates narrowed to float, normals from the winding. The
/// file appears whole or not at all: it is written under another name in the same folder, and then
/// takes the place of any file of that name.
///
/// Errors: kFileUnwritable, and kMeshNotFinite for a coordinate beyond float.
IST_API void write_stl(const TriangleMesh& mesh, const std::filesystem::path& file);

}  // namespace ist
