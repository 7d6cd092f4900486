#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/occlusion/labels/tooth_labels.h"

namespace ist::cli {

/// Returns the numbers of a text, one a line.
[[nodiscard]] std::vector<int> labels_of_lines(const std::filesystem::path& file,
                                               ToothNumbers numbers);

/// Returns the labels of the triangles of a PLY, by a property.
[[nodiscard]] ToothLabels labels_of_ply(const std::filesystem::path& file, ToothNumbers numbers);

/// Returns the labels of the triangles of an OBJ, by its groups.
[[nodiscard]] ToothLabels labels_of_obj(const std::filesystem::path& file, ToothNumbers numbers);

/// Returns the tooth that two of three corners name, else 0.
[[nodiscard]] inline int tooth_of_corners(int a, int b, int c) {
  return a == b || a == c ? a : b == c ? b : 0;
}

/// Throws kInputInvalid for labels that do not fit.
[[noreturn]] void refuse_labels(const std::filesystem::path& file, const std::string& detail);

}  // namespace ist::cli
