#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ist/base/error.h"
#include "ist/mesh/format/frame_tags.h"
#include "ist/mesh/format/mesh_builder.h"
#include "ist/mesh/format/text_reader.h"
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

/// Numbers of a VTK file, and their place in it.
struct VtkArray {
  std::string place;            ///< such as "POINTS", for errors
  std::vector<double> numbers;  ///< integers beyond 2^53 are rounded
  std::string_view text = {};   ///< from the first number on; empty if they are bytes
};

/// A VTK file, for errors.
struct VtkFile {
  std::string_view content, name;

  /// Throws an error that names the line at `at`, a place in the content.
  [[noreturn]] void fail_at(const char* at, ErrorCode code, std::string_view cause) const;
  /// Throws kNotAMesh for a word at its line; kMeshTruncated if the word is the last one.
  [[noreturn]] void fail_word(std::string_view word, std::string_view cause) const;
  [[nodiscard]] bool is_last(std::string_view word) const;
  /// Throws an error that names the line of a number, or the array if its numbers are bytes.
  [[noreturn]] void fail(const VtkArray& array, std::size_t index, ErrorCode code,
                         std::string_view cause) const;
};

/// Throws the error of a dataset other than PolyData, by its type.
[[noreturn]] void fail_vtk_dataset(std::string_view type, std::string_view file);

/// Removes the next word from a text, and returns it; empty at the end.
[[nodiscard]] std::string_view next_word(std::string_view& text);

/// Removes at most `most` numbers from a text, a part of the file's content. Throws kNotAMesh for
/// another word.
[[nodiscard]] VtkArray numbers_of_text(std::string place, std::string_view& text,
                                       const NumberType& type, const VtkFile& file,
                                       std::size_t most = std::numeric_limits<std::size_t>::max());

/// Cells of one kind: vertices, lines, polygons or strips.
struct VtkCells {
  struct Cell {
    std::size_t begin, corners;  ///< in the array
  };
  VtkArray corners;
  std::vector<Cell> cells;
};

/// Returns the cells of an array of corners: `ends` holds the end of each. The first `first` of
/// them are 0 and end no cell. Throws kNotAMesh if the ends decrease or leave corners over.
[[nodiscard]] VtkCells cells_by_ends(VtkArray corners, const VtkArray& ends, std::size_t first,
                                     const VtkFile& file);

/// A part of PolyData with points of its own.
struct VtkPiece {
  VtkArray points;
  std::uint64_t other_cells = 0;  ///< vertices and lines, before the others in the order of cells
  VtkCells polygons, strips;
};

/// Collects the surface of a file's pieces.
class VtkSurface {
 public:
  /// `labels` takes the faces, or is null.
  VtkSurface(const VtkFile& file, VtkLabels* labels) : file_(file), labels_(labels) {}

  /// Adds the polygons and strips of a piece. Each third number of its points completes a point.
  /// Errors: kMeshNotFinite, kMeshBadIndex, kNotAMesh.
  void add(const VtkPiece& piece);
  /// Returns the surface. Errors: kMeshEmpty, kMeshPointsOnly.
  [[nodiscard]] TriangleMesh finish(PatientFrame frame) const;

 private:
  [[nodiscard]] std::uint32_t corner(const VtkArray& corners, std::size_t index) const;
  void add_polygon(const VtkArray& corners, const VtkCells::Cell& cell);
  void add_strip(const VtkArray& corners, const VtkCells::Cell& cell);
  void add_face(std::span<const std::uint32_t> corners);

  const VtkFile& file_;
  VtkLabels* labels_;
  IndexedFaces surface_;
  std::size_t first_ = 0;   // the piece's first point
  std::uint64_t cell_ = 0;  // the next cell, counted through all pieces
  std::vector<std::uint32_t> polygon_;
};

}  // namespace ist
