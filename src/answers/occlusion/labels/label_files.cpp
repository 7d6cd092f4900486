#include "answers/occlusion/labels/label_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include "ist/base/counted.h"
#include "ist/base/printable.h"

namespace ist::answers {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

// Whether no text holds it.
bool is_control(char c) {
  return (static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7F;
}

// The corners of a triangle in one order, however it is turned, as floats, which every file holds.
using Place = std::array<std::array<float, 3>, 3>;

Place place_of(const TriangleMesh& mesh, const Triangle& triangle) {
  Place place;
  for (std::size_t i = 0; i < 3; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double x = mesh.vertices[triangle[i]][axis];
      place[i][static_cast<std::size_t>(axis)] = static_cast<float>(x) + 0.0f;  // -0 is 0
    }
  }
  std::sort(place.begin(), place.end());
  return place;
}

}  // namespace

// Blank lines are well at the end alone.
std::vector<int> labels_of_lines(const std::filesystem::path& file, ToothNumbers system) {
  const std::string content = text_of(file);
  if (std::any_of(content.begin(), content.end(), is_control)) {
    refuse_labels(file, "it is no text: write one whole number a line");
  }
  std::vector<int> numbers;
  std::size_t line = 0, blank = 0;  // counted from 1; the first blank one
  for (std::size_t at = 0; at < content.size();) {
    const std::size_t end = std::min(content.find('\n', at), content.size());
    const std::string_view text = trimmed(std::string_view(content).substr(at, end - at));
    at = end + 1;
    ++line;
    if (text.empty()) {
      if (blank == 0) blank = line;
      continue;
    }
    if (blank != 0) {
      refuse_labels(file, fmt::format("line {} is empty: write 0 for no tooth", blank));
    }
    int number = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || rest != text.data() + text.size()) {
      refuse_labels(file, fmt::format("line {} is \"{}\": write one whole number a line", line,
                                      printable(text)));
    }
    if (!is_tooth_number(number, system)) {
      refuse_tooth_number(number, system, fmt::format("{}: line {}", file.string(), line));
    }
    numbers.push_back(number);
  }
  return numbers;
}

ToothLabels labels_in_place(const std::filesystem::path& file, const ToothLabels& labels,
                            const TriangleMesh& mesh, double factor) {
  TriangleMesh labelled = read_mesh(file);
  turn_into(labelled, mesh.frame);
  for (Eigen::Vector3d& vertex : labelled.vertices) vertex *= factor;
  if (labels.size() != labelled.triangles.size()) {
    refuse_labels(file, fmt::format("{} for {}: export it again", counted(labels.size(), "label"),
                                    counted(labelled.triangles.size(), "triangle")));
  }
  std::vector<std::pair<Place, int>> known;
  known.reserve(labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    known.emplace_back(place_of(labelled, labelled.triangles[i]), labels[i]);
  }
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  const auto twice = std::adjacent_find(
      known.begin(), known.end(), [](const auto& a, const auto& b) { return a.first == b.first; });
  if (twice != known.end()) {
    refuse_labels(file, fmt::format("triangles in one place have the labels {} and {}: remove one, "
                                    "or give a text with a label for each triangle",
                                    twice->second, std::next(twice)->second));
  }
  ToothLabels found;
  found.reserve(mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) {
    const Place place = place_of(mesh, triangle);
    const auto at = std::lower_bound(known.begin(), known.end(), place,
                                     [](const auto& a, const Place& b) { return a.first < b; });
    if (at != known.end() && at->first == place) found.push_back(at->second);
  }
  if (found.size() != mesh.triangles.size()) {
    refuse_labels(file, fmt::format("{} of the {} triangles measured are not in it: label the mesh "
                                    "that is measured",
                                    mesh.triangles.size() - found.size(), mesh.triangles.size()));
  }
  return found;
}

}  // namespace ist::answers
