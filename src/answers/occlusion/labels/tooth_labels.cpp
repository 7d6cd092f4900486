#include "answers/occlusion/labels/tooth_labels.h"

#include <fmt/format.h>

#include <string_view>
#include <system_error>

#include "answers/occlusion/labels/label_files.h"
#include "ist/base/counted.h"
#include "ist/base/files.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/format/text_reader.h"

namespace ist::answers {
namespace {

constexpr const char* kFdi =
    "FDI numbers are 11 to 18 up to 41 to 48, of milk teeth 51 to 55 up to 81 to 85; 0 is no tooth";
constexpr const char* kUniversal = "universal numbers are 1 to 32; 0 is no tooth";

bool is_vtk(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  return same_word(ending, ".vtk") || same_word(ending, ".vtp");
}

// Returns labels of triangles. Refuses labels of other vertices, by which most triangles would lie
// between teeth.
ToothLabels of_triangles(const std::filesystem::path& file, const TriangleMesh& mesh,
                         const std::vector<int>& of_vertices) {
  ToothLabels labels;
  labels.reserve(mesh.triangles.size());
  std::size_t labelled = 0, between = 0;
  for (const Triangle& t : mesh.triangles) {
    const int a = of_vertices[t[0]], b = of_vertices[t[1]], c = of_vertices[t[2]];
    labels.push_back(tooth_of_corners(a, b, c));
    if (a != 0 || b != 0 || c != 0) ++labelled;
    if (a != b || b != c) ++between;
  }
  if (2 * between > labelled) {
    refuse_labels(file,
                  "most triangles with a label have corners of different teeth, so that these seem "
                  "to be the labels of other vertices, which are counted as the triangles first "
                  "use them: give a label for each triangle");
  }
  return labels;
}

}  // namespace

bool is_tooth_number(std::int64_t number, ToothNumbers system) {
  if (number == 0) return true;
  if (system == ToothNumbers::kUniversal) return number >= 1 && number <= 32;
  const std::int64_t quarter = number / 10, tooth = number % 10;
  return quarter >= 1 && quarter <= 8 && tooth >= 1 && tooth <= (quarter <= 4 ? 8 : 5);
}

void refuse_tooth_number(std::int64_t number, ToothNumbers system, const std::string& place) {
  throw_error(ErrorCode::kInputInvalid, "{} is {}: {}; see --numbering", place, number,
              system == ToothNumbers::kFdi ? kFdi : kUniversal);
}

std::string text_of(const std::filesystem::path& file) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::string content = InputFile(file).read_rest();
  if (content.starts_with(kByteOrderMark)) content.erase(0, kByteOrderMark.size());
  return content;
}

void refuse_labels(const std::filesystem::path& file, const std::string& detail) {
  throw_error(ErrorCode::kInputInvalid, "{}: {}", file.string(), detail);
}

LabelSource label_source(const std::filesystem::path& file) {
  std::error_code unknown;
  if (std::filesystem::exists(file, unknown)) return {file, ""};
  const std::string name = file.string();
  for (std::size_t colon = name.find(':'); colon != name.npos; colon = name.find(':', colon + 1)) {
    const std::filesystem::path mesh = name.substr(0, colon);
    if (is_vtk(mesh)) return {mesh, name.substr(colon + 1)};
  }
  return {file, ""};
}

ToothLabels read_labels(const std::filesystem::path& given, const TriangleMesh& mesh,
                        ToothNumbers numbers, double factor) {
  const LabelSource source = label_source(given);
  const std::filesystem::path& file = source.file;
  const std::string ending = file.extension().string();
  if (is_vtk(file)) return labels_in_place(file, labels_of_vtk(source, numbers), mesh, factor);
  if (same_word(ending, ".ply"))
    return labels_in_place(file, labels_of_ply(file, numbers), mesh, factor);
  if (same_word(ending, ".obj"))
    return labels_in_place(file, labels_of_obj(file, numbers), mesh, factor);
  std::vector<int> labels = labels_of_lines(file, numbers);
  if (labels.size() == mesh.triangles.size()) return labels;
  if (labels.size() == mesh.vertices.size()) return of_triangles(file, mesh, labels);
  refuse_labels(
      file,
      fmt::format(
          "{} for a mesh of {} and {}: write one a line for each triangle, or for each vertex",
          counted(labels.size(), "label"), counted(mesh.triangles.size(), "triangle"),
          counted(mesh.vertices.size(), "vertex", "vertices")));
}

}  // namespace ist::answers
