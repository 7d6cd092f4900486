#pragma once

#include <filesystem>

#include "answers/formats/poly_data.h"
#include "ist/base/files.h"

namespace ist::answers {

/// Writes VTK's XML PolyData (.vtp), as vtkXMLPolyDataReader and ParaView read it: raw appended
/// data, little-endian, lengths of 64 bits. Polygons become Polys, points without polygons Verts;
/// colours become the point array "RGB", normals the point array "Normals".
///
/// Cost: linear; 8 bytes of memory a corner beside the data. Precondition: is_consistent(data).
/// Errors: kFileUnwritable; kMeshNotFinite for a point beyond float.
void write_vtp(const PolyData& data, OutputFile& file);
/// The same, and completes the file.
void write_vtp(const PolyData& data, const std::filesystem::path& file);

}  // namespace ist::answers
