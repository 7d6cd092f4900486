#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ist/mesh/mesh.h"

namespace ist {

/// The numbers that VTK PolyData holds for its cells and points, and its faces.
struct VtkLabels {
  /// One number for each cell or point.
  struct Array {
    std::string name;
    bool of_cells;
    bool is_integer;
    std::vector<double> numbers;
  };
  /// A face of n corners is the next n - 2 triangles of the mesh. A strip is faces of 3 corners.
  struct Face {
    std::uint64_t cell;
    std::size_t corners;
    Triangle points;  ///< the first three
  };
  std::vector<Array> arrays;  ///< the arrays of one component
  std::vector<Face> faces;
};

/// Reads the arrays and faces of a .vtk or .vtp. read_content() reads the same mesh. Errors: as in
/// read_content(), and kNotAMesh for an array of another length than the cells or points.
[[nodiscard]] VtkLabels read_vtk_labels(std::string_view content, std::string_view file);

}  // namespace ist
