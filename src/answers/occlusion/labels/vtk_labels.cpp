#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "answers/occlusion/labels/label_files.h"
#include "ist/base/printable.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/format/vtk_surface.h"

namespace ist::answers {
namespace {

using Array = VtkLabels::Array;

// Whether a name says that an array labels teeth.
bool names_labels(std::string_view name) {
  constexpr std::string_view kNames[] = {"label",       "tooth",       "universal_id",
                                         "universalid", "predictedid", "predicted_id"};
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return std::any_of(std::begin(kNames), std::end(kNames),
                     [&](std::string_view known) { return lower.find(known) != lower.npos; });
}

std::string list_of(const std::vector<Array>& arrays) {
  std::string list;
  for (const Array& array : arrays) {
    list += fmt::format("{}'{}' of {}", list.empty() ? "" : ", ", printable(array.name),
                        array.of_cells ? "cells" : "points");
  }
  return list.empty() ? "none" : list;
}

// The named array, of cells before points. Without a name, the only one of whole numbers, if it is
// called a label.
const Array& label_array(const std::vector<Array>& arrays, const LabelSource& source) {
  for (const bool of_cells : {true, false}) {
    for (const Array& array : arrays) {
      const bool is_named = !source.array.empty() && array.name == source.array;
      if (is_named && array.of_cells == of_cells) return array;
    }
  }
  const auto is_integer = [](const Array& array) { return array.is_integer; };
  const auto integer = std::find_if(arrays.begin(), arrays.end(), is_integer);
  const bool is_clear = source.array.empty() &&
                        std::count_if(arrays.begin(), arrays.end(), is_integer) == 1 &&
                        names_labels(integer->name);
  if (is_clear) return *integer;
  const std::string name = source.file.filename().string();
  refuse_labels(source.file,
                source.array.empty()
                    ? fmt::format("no array is clearly the label: name one, such as {}:Label; its "
                                  "arrays of one number are {}",
                                  name, list_of(arrays))
                    : fmt::format("no array is called '{}': its arrays of one number are {}",
                                  printable(source.array), list_of(arrays)));
}

// 3D Slicer's dental tools number teeth universally, and the gum 33.
bool is_gum(int label, ToothNumbers system) {
  return system == ToothNumbers::kUniversal && label == 33;
}

std::vector<int> tooth_numbers(const Array& array, const std::filesystem::path& file,
                               ToothNumbers system) {
  std::vector<int> numbers;
  numbers.reserve(array.numbers.size());
  const auto place = [&] {
    return fmt::format("{}: {} {} of '{}'", file.string(), array.of_cells ? "cell" : "point",
                       numbers.size(), printable(array.name));
  };
  for (const double number : array.numbers) {
    if (!(std::abs(number) < 1e9) || number != std::floor(number)) {
      throw_error(ErrorCode::kInputInvalid, "{} is {}: write whole numbers", place(), number);
    }
    const auto label = static_cast<int>(number);
    const int tooth = is_gum(label, system) ? 0 : label;
    if (!is_tooth_number(tooth, system)) refuse_tooth_number(tooth, system, place());
    numbers.push_back(tooth);
  }
  return numbers;
}

}  // namespace

ToothLabels labels_of_vtk(const LabelSource& source, ToothNumbers system) {
  const std::string content = text_of(source.file);
  const VtkLabels labels = read_vtk_labels(content, source.file.string());
  const Array& array = label_array(labels.arrays, source);
  const std::vector<int> numbers = tooth_numbers(array, source.file, system);
  ToothLabels of_triangles;
  for (const VtkLabels::Face& face : labels.faces) {
    if (array.of_cells) {
      of_triangles.insert(of_triangles.end(), face.corners - 2, numbers[face.cell]);
    } else if (face.corners == 3) {
      const auto& [a, b, c] = face.points;
      of_triangles.push_back(tooth_of_corners(numbers[a], numbers[b], numbers[c]));
    } else {
      refuse_labels(source.file, fmt::format("cell {} has {} corners, and labels of points need "
                                             "three: triangulate the mesh, or label its cells",
                                             face.cell, face.corners));
    }
  }
  return of_triangles;
}

}  // namespace ist::answers
