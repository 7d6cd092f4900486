#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ist/measure/occlusion.h"
#include "ist/mesh/mesh.h"

namespace ist::cli {

/// A system of tooth numbers: the permanent and milk teeth of ISO 3950 (FDI), or the universal
/// numbers 1 to 32. Of a file of labels 0 is what is no tooth.
enum class ToothNumbers { kFdi, kUniversal };

/// The tooth of each triangle of a mesh, by its number; 0: none.
using ToothLabels = std::vector<int>;

/// Reads labels: one whole number a line, for each triangle, or for each vertex, where a triangle
/// is of the tooth that two of its corners name, else of none. Triangles are in the file's order;
/// vertices are in the mesh's, which read_mesh() makes by their first use. Lines may be blank at
/// the end.
///
/// Throws kFileUnreadable, and kInputInvalid, naming the line, for a number outside the system or
/// no number; for another count; and for labels of vertices by which most triangles lie between
/// teeth, since those are of another order.
[[nodiscard]] ToothLabels read_labels(const std::filesystem::path& file, const TriangleMesh& mesh,
                                      ToothNumbers numbers);

/// The part of one tooth in an occlusion.
struct Tooth {
  int number = 0;
  double area = 0;  ///< in contact, mesh units²
  double share = 0, share_thinner = 0,
         share_thicker = 0;   ///< of all regions of the surface, 0 to 1
  double least_distance = 0;  ///< signed, of its vertices, mesh units; NaN beyond the reach
};

/// Returns the teeth of a surface by their numbers: all that are labelled. Precondition: a label
/// for each triangle.
[[nodiscard]] std::vector<Tooth> teeth_of(const SurfaceOcclusion& surface, const TriangleMesh& mesh,
                                          const ToothLabels& labels);

}  // namespace ist::cli
