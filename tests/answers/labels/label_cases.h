#pragma once

#include <string>

#include "answers/occlusion/labels/tooth_labels.h"
#include "support/errors.h"
#include "support/temp_dir.h"

namespace ist::test {

/// Two triangles of a unit square, 0 1 2 and 2 1 3.
inline const TriangleMesh kPair = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
                                   {{0, 1, 2}, {2, 1, 3}}};

/// Returns the labels of a mesh by a file of that name and content.
[[nodiscard]] inline answers::ToothLabels labels_by(
    const char* name, const std::string& content,
    answers::ToothNumbers numbers = answers::ToothNumbers::kFdi, const TriangleMesh& mesh = kPair) {
  const TempDir dir;
  return answers::read_labels(dir.write(name, content), mesh, numbers);
}

/// Returns the text of its error, or why it is not one that names the file.
[[nodiscard]] inline std::string refusal_of(
    const char* name, const std::string& content,
    answers::ToothNumbers numbers = answers::ToothNumbers::kFdi, const TriangleMesh& mesh = kPair) {
  const auto error = error_of([&] { (void)labels_by(name, content, numbers, mesh); });
  if (!error) return "not refused";
  const std::string text = error->what();
  return text.find(name) == text.npos ? "names no file: " + text : text;
}

}  // namespace ist::test
