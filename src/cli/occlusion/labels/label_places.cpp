#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "cli/occlusion/labels/label_files.h"

namespace ist::cli {
namespace {

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

ToothLabels labels_in_place(const std::filesystem::path& file, const ToothLabels& labels,
                            const TriangleMesh& mesh, double factor) {
  TriangleMesh labelled = read_mesh(file);
  turn_into(labelled, mesh.frame);
  for (Eigen::Vector3d& vertex : labelled.vertices) vertex *= factor;
  if (labels.size() != labelled.triangles.size()) {
    refuse_labels(file, fmt::format("{} labels for {} triangles: export it again", labels.size(),
                                    labelled.triangles.size()));
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

}  // namespace ist::cli
