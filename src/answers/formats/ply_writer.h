#pragma once

#include <filesystem>
#include <string>

#include "answers/formats/poly_data.h"
#include "ist/base/files.h"

namespace ist::answers {

/// Writes PLY, binary little-endian. The properties of a vertex are x, y, z; nx, ny, nz if there
/// are normals; red, green, blue (uchar) if there are colours; then the point arrays in order,
/// their names in lower case, as float, int or uchar. An array of several components becomes as
/// many properties, NAME_x, NAME_y, NAME_z, or NAME_0, NAME_1 … if they are not three. Polygons are
/// `list uchar int vertex_indices`. Points without polygons get no faces. Cell arrays are left out.
///
/// @param comment text for people, in the header; line ends in it become spaces
///
/// Cost: linear; memory, as much as the file. Precondition: is_consistent(data). Errors:
/// kFileUnwritable, also for over 2^31 - 1 points, which the indices cannot tell; kMeshNotFinite
/// for a point beyond float.
void write_ply(const PolyData& data, OutputFile& file, const std::string& comment);
/// The same, and completes the file.
void write_ply(const PolyData& data, const std::filesystem::path& file, const std::string& comment);

}  // namespace ist::answers
