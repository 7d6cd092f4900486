#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "answers/occlusion/labels/tooth_labels.h"

namespace ist::answers {

/// Returns the content of a file, without a byte order mark. Throws kFileUnreadable.
[[nodiscard]] std::string text_of(const std::filesystem::path& file);

/// Returns the numbers of a text, one a line.
[[nodiscard]] std::vector<int> labels_of_lines(const std::filesystem::path& file,
                                               ToothNumbers numbers);

/// Returns the labels of the triangles of a PLY, by a property, in the file's order.
[[nodiscard]] ToothLabels labels_of_ply(const std::filesystem::path& file, ToothNumbers numbers);

/// Returns the labels of the triangles of an OBJ, by its names, in the file's order.
[[nodiscard]] ToothLabels labels_of_obj(const std::filesystem::path& file, ToothNumbers numbers);

/// Returns the labels of the triangles of a .vtk or .vtp, by an array of its cells or points, in
/// the file's order.
[[nodiscard]] ToothLabels labels_of_vtk(const LabelSource& source, ToothNumbers numbers);

/// Returns the labels of a mesh's triangles, by the places of those that a labelled mesh holds, of
/// which `labels` are. Refuses triangles that are not in it, and places with two labels.
[[nodiscard]] ToothLabels labels_in_place(const std::filesystem::path& file,
                                          const ToothLabels& labels, const TriangleMesh& mesh,
                                          double factor);

/// Returns the tooth that two of three corners name, else 0.
[[nodiscard]] inline int tooth_of_corners(int a, int b, int c) {
  return a == b || a == c ? a : b == c ? b : 0;
}

/// Throws kInputInvalid for labels that do not fit.
[[noreturn]] void refuse_labels(const std::filesystem::path& file, const std::string& detail);

}  // namespace ist::answers
