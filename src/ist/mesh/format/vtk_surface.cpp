#include "ist/mesh/format/vtk_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "ist/base/counted.h"
#include "ist/base/printable.h"
#include "ist/mesh/format/mesh_readers.h"

namespace ist {
namespace {

bool is_vtk_blank(char c) { return static_cast<unsigned char>(c) <= 0x20; }

// For require_face_size().
struct VtkPlace {
  const VtkFile& file;
  const VtkArray& array;
  std::size_t index;

  [[noreturn]] void fail(ErrorCode code, std::string_view cause) const {
    file.fail(array, index, code, cause);
  }
};

}  // namespace

std::string_view next_word(std::string_view& text) {
  const auto begin = std::find_if_not(text.begin(), text.end(), is_vtk_blank);
  const auto end = std::find_if(begin, text.end(), is_vtk_blank);
  const auto skipped = static_cast<std::size_t>(begin - text.begin());
  const std::string_view word = text.substr(skipped, static_cast<std::size_t>(end - begin));
  text.remove_prefix(skipped + word.size());
  return word;
}

void fail_vtk_dataset(std::string_view type, std::string_view file) {
  fail_mesh(ErrorCode::kNotAMesh, file, "",
            fmt::format("the file is a VTK {}, and only PolyData is read; extract its surface (in "
                        "ParaView: Extract Surface) and save it as PolyData",
                        printable(type)));
}

void VtkFile::fail_at(const char* at, ErrorCode code, std::string_view cause) const {
  const auto line = 1 + std::count(content.data(), at, '\n');
  fail_mesh(code, name, fmt::format("line {}", line), cause);
}

bool VtkFile::is_last(std::string_view word) const {
  return std::all_of(word.data() + word.size(), content.data() + content.size(), is_vtk_blank);
}

void VtkFile::fail_word(std::string_view word, std::string_view cause) const {
  if (is_last(word))
    fail_at(word.data(), ErrorCode::kMeshTruncated,
            fmt::format("the file ends here, but {}", cause));
  fail_at(word.data(), ErrorCode::kNotAMesh, cause);
}

void VtkFile::fail(const VtkArray& array, std::size_t index, ErrorCode code,
                   std::string_view cause) const {
  if (array.text.empty()) fail_mesh(code, name, array.place, cause);
  std::string_view text = array.text;
  std::string_view word = next_word(text);
  for (std::size_t i = 0; i < index && !word.empty(); ++i) word = next_word(text);
  fail_at(word.data(), code, cause);
}

VtkArray numbers_of_text(std::string place, std::string_view& text, const NumberType& type,
                         const VtkFile& file, std::size_t most) {
  VtkArray array{std::move(place), {}, text};
  while (array.numbers.size() < most) {
    const std::string_view word = next_word(text);
    if (word.empty()) break;
    const std::optional<double> number = number_of(word, type.precision);
    if (!number)
      file.fail_word(word,
                     fmt::format("'{}' is not a number; export the mesh again", printable(word)));
    array.numbers.push_back(*number);
  }
  return array;
}

VtkCells cells_by_ends(VtkArray corners, const VtkArray& ends, std::size_t first,
                       const VtkFile& file) {
  VtkCells result{std::move(corners), {}};
  const auto most = static_cast<double>(result.corners.numbers.size());
  double begin = 0;
  for (std::size_t i = 0; i < ends.numbers.size(); ++i) {
    const double end = ends.numbers[i];
    const double least = i < first ? most + 1 : begin;
    if ((i >= first || end != 0) && !(end >= least && end <= most && end == std::floor(end)))
      file.fail(ends, i, ErrorCode::kNotAMesh,
                fmt::format("the offset {} follows {}, and there are {} corners; export the mesh "
                            "again",
                            end, begin, most));
    if (i >= first)
      result.cells.push_back(
          {static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)});
    begin = end;
  }
  if (begin != most)
    file.fail(ends, ends.numbers.size(), ErrorCode::kNotAMesh,
              fmt::format("the last offset is {}, but there are {} corners; export the mesh again",
                          begin, most));
  return result;
}

void VtkSurface::add(const VtkPiece& piece) {
  first_ = surface_.vertices();
  const std::vector<double>& points = piece.points.numbers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_coordinate(points[i]))
      file_.fail(piece.points, i, ErrorCode::kMeshNotFinite,
                 "a coordinate is not finite, or beyond a float's range; repair the mesh where it "
                 "was made");
    if (i % 3 == 2) surface_.add_vertex({points[i - 2], points[i - 1], points[i]});
  }
  cell_ += piece.other_cells;
  for (const VtkCells::Cell& cell : piece.polygons.cells) {
    add_polygon(piece.polygons.corners, cell);
    ++cell_;
  }
  for (const VtkCells::Cell& cell : piece.strips.cells) {
    add_strip(piece.strips.corners, cell);
    ++cell_;
  }
}

std::uint32_t VtkSurface::corner(const VtkArray& corners, std::size_t index) const {
  const double point = corners.numbers[index];
  const std::size_t points = surface_.vertices() - first_;
  if (!(point >= 0 && point < static_cast<double>(points) && point == std::floor(point)))
    file_.fail(corners, index, ErrorCode::kMeshBadIndex,
               fmt::format("a face names point {}, but there are {}, counted from 0; export the "
                           "mesh again",
                           point, points));
  return static_cast<std::uint32_t>(first_ + static_cast<std::size_t>(point));
}

void VtkSurface::add_polygon(const VtkArray& corners, const VtkCells::Cell& cell) {
  const auto size = static_cast<std::int64_t>(cell.corners);
  require_face_size(size, VtkPlace{file_, corners, cell.begin});
  polygon_.clear();
  for (std::size_t i = 0; i < cell.corners; ++i)
    polygon_.push_back(corner(corners, cell.begin + i));
  add_face(polygon_);
}

// Each corner after the second one makes a triangle, and every other triangle is turned. Triangles
// that have a corner twice only lead the strip elsewhere.
void VtkSurface::add_strip(const VtkArray& corners, const VtkCells::Cell& cell) {
  Triangle last{};
  for (std::size_t i = 0; i < cell.corners; ++i) {
    last = {last[1], last[2], corner(corners, cell.begin + i)};
    const auto& [a, b, c] = last;
    if (i < 2 || a == b || b == c || a == c) continue;
    add_face(i % 2 == 0 ? last : Triangle{b, a, c});
  }
}

void VtkSurface::add_face(std::span<const std::uint32_t> corners) {
  surface_.add_face(corners);
  if (labels_ == nullptr) return;
  labels_->faces.push_back({cell_, corners.size(), {corners[0], corners[1], corners[2]}});
}

TriangleMesh VtkSurface::finish(PatientFrame frame) const {
  if (surface_.faces() == 0 && surface_.vertices() == 0)
    fail_mesh(ErrorCode::kMeshEmpty, file_.name, "",
              "the PolyData has no point; export the mesh again");
  if (surface_.faces() == 0)
    fail_mesh(
        ErrorCode::kMeshPointsOnly, file_.name, "",
        fmt::format("the file has {}, but no polygon or strip; export the surface as polygons",
                    counted(surface_.vertices(), "point")));
  for (const VtkLabels::Array& array :
       labels_ ? labels_->arrays : std::vector<VtkLabels::Array>()) {
    const std::uint64_t expected = array.of_cells ? cell_ : surface_.vertices();
    if (array.numbers.size() != expected)
      fail_mesh(ErrorCode::kNotAMesh, file_.name, printable(array.name),
                fmt::format("the array holds {} for {}; export the mesh again",
                            counted(array.numbers.size(), "number"),
                            counted(expected, array.of_cells ? "cell" : "point")));
  }
  TriangleMesh mesh = surface_.weld();
  mesh.frame = frame;
  return mesh;
}

VtkLabels read_vtk_labels(std::string_view content, std::string_view file) {
  VtkLabels labels;
  const bool is_legacy = content.starts_with(kVtkBegin);
  static_cast<void>(is_legacy ? read_vtk(content, file, &labels)
                              : read_vtp(content, file, &labels));
  return labels;
}

}  // namespace ist
