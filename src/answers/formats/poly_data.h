#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "ist/mesh/mesh.h"

namespace ist::answers {

/// Numbers of a kind that every viewer reads.
using Numbers =
    std::variant<std::vector<float>, std::vector<std::int32_t>, std::vector<std::uint8_t>>;

/// A named array over the points or the cells of a PolyData.
struct DataArray {
  std::string name;            ///< letters, digits and underscores
  Numbers numbers;             ///< the components of the first point or cell, then of the next
  std::size_t components = 1;  ///< at least 1
};

/// A named text about the whole, such as its unit: in VTP field data, in PLY a comment, in GLB an
/// extra of the asset.
struct NamedText {
  std::string name;  ///< letters, digits and underscores
  std::string text;
};

using Colour = std::array<std::uint8_t, 3>;  ///< red, green, blue

/// A surface or a set of points, with numbers on it: the content of the files that viewers open.
/// (VTK's word. Its cells are the polygons, or the points if there are no polygons.)
struct PolyData {
  std::vector<Eigen::Vector3d> points;  ///< mesh units; finite as floats, which the files hold
  std::size_t corners = 3;              ///< of every polygon: 3 or 4
  /// The corners of the first polygon, counter-clockwise as seen from outside, then of the next:
  /// indices of points. Empty if each point is a cell.
  std::vector<std::uint32_t> polygons;
  std::vector<DataArray> point_arrays, cell_arrays;
  std::vector<NamedText> texts;
  /// The frame of the points. VTP and PLY name it SPACE, like 3D Slicer.
  PatientFrame frame = PatientFrame::kUnknown;
  std::vector<Colour> colours;           ///< one a point, or empty
  std::vector<Eigen::Vector3f> normals;  ///< one a point, of length 1; or empty

  [[nodiscard]] std::size_t polygon_count() const { return polygons.size() / corners; }
  [[nodiscard]] std::size_t cell_count() const {
    return polygons.empty() ? points.size() : polygon_count();
  }
};

/// A body of a scene.
struct NamedPolyData {
  std::string name;
  PolyData data;
};

/// Returns the vertices and triangles of a mesh, without arrays.
[[nodiscard]] PolyData poly_data(const TriangleMesh& mesh);

/// Returns all bodies as one, in order, with a point array and a cell array "Body" (uint8) that
/// come last and hold a body's place among the bodies, from 0. Preconditions: at most 256 bodies;
/// all have polygons of as many corners, or none has polygons; arrays, colours and normals are on
/// all or on none, arrays in one order and of one kind. Cost: a copy.
[[nodiscard]] PolyData joined(std::span<const NamedPolyData> bodies);

/// Returns a normal for each point: the mean of its polygons' normals, weighted by their areas; (0,
/// 0, 1) for a point of no polygon with an area. For a surface that viewers should draw as smooth.
[[nodiscard]] std::vector<Eigen::Vector3f> vertex_normals(const PolyData& data);

/// Returns the points rounded to float, x, y and z of the first, then of the next. Throws
/// kMeshNotFinite, naming the file to be written and the point, for one that is beyond float.
[[nodiscard]] std::vector<float> float_points(const PolyData& data,
                                              const std::filesystem::path& file);

/// Whether the arrays, colours and normals have as many entries as points or cells, and polygons
/// refer to points: the precondition of all writers. Cost: linear.
[[nodiscard]] bool is_consistent(const PolyData& data);

}  // namespace ist::answers
