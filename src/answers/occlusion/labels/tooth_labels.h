#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ist/mesh/mesh.h"

namespace ist::answers {

/// A system of tooth numbers: the permanent and milk teeth of ISO 3950 (FDI), or the universal
/// numbers 1 to 32.
enum class ToothNumbers { kFdi, kUniversal };

/// Returns whether a number belongs to the system, or is 0: no tooth.
[[nodiscard]] bool is_tooth_number(std::int64_t number, ToothNumbers system);

/// Throws kInputInvalid for a number of another system, at a place.
[[noreturn]] void refuse_tooth_number(std::int64_t number, ToothNumbers system,
                                      const std::string& place);

/// The tooth of each triangle of a mesh, by its number; 0: none.
using ToothLabels = std::vector<int>;

/// A file of labels, and the array in it that labels: scan.vtp:Label.
struct LabelSource {
  std::filesystem::path file;
  std::string array;  ///< of a .vtk or .vtp; may be empty
};

/// Splits a file and its array. A file that exists keeps its name, whatever colons it holds.
[[nodiscard]] LabelSource label_source(const std::filesystem::path& file);

/// Reads labels by the file's ending. If vertices have labels, a triangle belongs to the tooth that
/// two of its corners name, or else to none.
///
/// - `.ply`: the property of faces, else of vertices, whose name holds `label` or `tooth`.
/// - `.obj`: groups whose names are the number alone, or after `tooth`, `t`, `fdi` or `universal`
///   in any case, with `_`, `-` or nothing between. A number that goes on, such as `16.001`, is
///   refused; other names are of no tooth. Objects count if no group is a tooth.
/// - `.vtk`, `.vtp`: the array that `file.vtp:ARRAY` names, a whole number for each cell, or for
///   each point. Without a name, the only array of whole numbers counts, if it is called a label.
/// - else: a whole number a line, for each triangle or vertex in the mesh's order, which of
///   vertices is their first use by triangles. Lines may be blank at the end.
///
/// A PLY, OBJ or VTK file holds the mesh too, or more: its triangles are found by their corners'
/// positions as floats, in any order. Cost: as of read_mesh(), and O(n log n).
///
/// Throws kFileUnreadable; the errors of read_mesh() for such a file that is no mesh; and
/// kInputInvalid, naming the place, for a number outside the system or no number, for a mesh
/// without labels or without some triangle of the mesh or with two labels for one place, for a text
/// of another count, and for one of vertices by which most of the labelled triangles lie between
/// teeth, since those are of another order.
/// @param factor of the mesh's lengths since it was read. A labelled mesh is multiplied by it too,
///               and turned into the mesh's frame
[[nodiscard]] ToothLabels read_labels(const std::filesystem::path& file, const TriangleMesh& mesh,
                                      ToothNumbers numbers, double factor = 1);

}  // namespace ist::answers
