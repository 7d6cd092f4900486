#include "cli/occlusion/labels/tooth_labels.h"

#include <fmt/format.h>

#include "cli/occlusion/labels/label_files.h"
#include "ist/base/error.h"
#include "ist/mesh/format/text_reader.h"

namespace ist::cli {
namespace {

// Labels that belong to other vertices are taken for noise: then most triangles would lie between
// teeth.
ToothLabels of_triangles(const std::filesystem::path& file, const TriangleMesh& mesh,
                         const std::vector<int>& of_vertices) {
  ToothLabels labels;
  labels.reserve(mesh.triangles.size());
  std::size_t between = 0;
  for (const Triangle& t : mesh.triangles) {
    const int a = of_vertices[t[0]], b = of_vertices[t[1]], c = of_vertices[t[2]];
    labels.push_back(tooth_of_corners(a, b, c));
    if (a != b || b != c) ++between;
  }
  if (2 * between > mesh.triangles.size()) {
    refuse_labels(file,
                  "most triangles have corners of different teeth, so that these seem to be the "
                  "labels of other vertices, which are counted as the triangles first use them: "
                  "give a label for each triangle");
  }
  return labels;
}

}  // namespace

void refuse_labels(const std::filesystem::path& file, const std::string& detail) {
  throw Error(ErrorCode::kInputInvalid, fmt::format("{}: {}", file.string(), detail));
}

ToothLabels read_labels(const std::filesystem::path& file, const TriangleMesh& mesh,
                        ToothNumbers numbers) {
  const std::string ending = file.extension().string();
  const bool is_ply = same_word(ending, ".ply"), is_obj = same_word(ending, ".obj");
  const auto refuse_count = [&](std::size_t count, const char* remedy) {
    refuse_labels(file, fmt::format("{} labels for a mesh of {} triangles and {} vertices: {}",
                                    count, mesh.triangles.size(), mesh.vertices.size(), remedy));
  };
  std::vector<int> labels = is_ply   ? labels_of_ply(file, numbers)
                            : is_obj ? labels_of_obj(file, numbers)
                                     : labels_of_lines(file, numbers);
  if (labels.size() == mesh.triangles.size()) return labels;
  if (is_ply || is_obj) refuse_count(labels.size(), "label the mesh that is measured");
  if (labels.size() == mesh.vertices.size()) return of_triangles(file, mesh, labels);
  refuse_count(labels.size(), "write one a line for each triangle, or for each vertex");
  return {};
}

}  // namespace ist::cli
