#pragma once

#include <filesystem>
#include <vector>

#include "cli/occlusion/labels/tooth_numbers.h"
#include "ist/mesh/mesh.h"

namespace ist::cli {

/// The tooth of each triangle of a mesh, by its number; 0: none.
using ToothLabels = std::vector<int>;

/// Reads labels by the file's ending. Triangles are in the mesh file's order. Where labels are of
/// vertices, a triangle is of the tooth that two of its corners name, else of none.
///
/// - `.ply`: the property of faces, else of vertices, whose name holds `label` or `tooth`. It may
///   be the mesh's own file.
/// - `.obj`: groups, or objects, whose names are the number, or end in it after a `_`: `g
/// tooth_16`. Names without digits,
///   such as `gum`, are of no tooth.
/// - else: a whole number a line, for each triangle or vertex. Vertices are in the mesh's order,
///   which read_mesh() makes by their first use. Lines may be blank at the end.
///
/// Throws kFileUnreadable; the errors of read_mesh() for a PLY or OBJ that is no mesh; and
/// kInputInvalid, naming the place, for a number outside the system or no number, for labels of
/// another count, for a PLY or OBJ without labels, and for a text's labels of vertices by which
/// most triangles lie between teeth, since those are of another order.
[[nodiscard]] ToothLabels read_labels(const std::filesystem::path& file, const TriangleMesh& mesh,
                                      ToothNumbers numbers);

}  // namespace ist::cli
