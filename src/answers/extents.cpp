#include "answers/extents.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

namespace ist::answers {
namespace {

// Writes several numbers with the same decimals.
struct Spelling {
  // `largest` gets `digits` significant digits, or all digits of a whole number. Very large and
  // very small numbers get an exponent.
  Spelling(double largest, int digits) {
    const std::string text = fmt::format("{:.{}e}", largest, digits - 1);
    const int exponent = std::stoi(text.substr(text.find('e') + 1));
    fixed = exponent >= -4 && exponent <= 9;
    decimals = fixed ? std::max(digits - 1 - exponent, 0) : digits - 1;
  }
  [[nodiscard]] std::string operator()(double length) const {
    return fixed ? fmt::format("{:.{}f}", length, decimals)
                 : fmt::format("{:.{}e}", length, decimals);
  }

  bool fixed;
  int decimals;
};

}  // namespace

Eigen::AlignedBox3d box_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) box.extend(mesh.vertices[vertex]);
  }
  return box;
}

Eigen::AlignedBox3d box_of(const SphereTree& tree) {
  if (tree.triangles() != nullptr) return box_of(*tree.triangles());
  Eigen::AlignedBox3d centres;
  for (const Eigen::Vector3d& centre : tree.leaf_centres()) centres.extend(centre);
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * tree.voxel_size());
  return {centres.min() - half, centres.max() + half};
}

double largest_extent(const Eigen::AlignedBox3d& box) { return box.sizes().maxCoeff(); }

double rounded_voxel_size(double extent) {
  return std::stod(fmt::format("{:.3g}", extent / kVoxelsOfExtent));
}

std::string number_text(double number) { return Spelling(number, 4)(number); }

std::string sides_text(const Eigen::Vector3d& sides, int digits) {
  const Spelling spelled(sides.maxCoeff(), digits);
  return fmt::format("{} x {} x {}", spelled(sides[0]), spelled(sides[1]), spelled(sides[2]));
}

std::string box_text(const Eigen::AlignedBox3d& box) {
  const Spelling spelled(largest_extent(box), 4);
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    text += fmt::format("{}[{}, {}]", axis == 0 ? "" : " ", spelled(box.min()[axis]),
                        spelled(box.max()[axis]));
  }
  return text;
}

std::string size_text(const Eigen::Vector3d& sides, LengthUnit unit) {
  constexpr std::pair<double, const char*> kScales[] = {
      {1, "m"}, {1e-2, "cm"}, {1e-3, "mm"}, {1e-6, "µm"}};
  const Eigen::Vector3d metres = sides * metres_per_unit(unit);
  const auto scale =
      std::find_if(std::begin(kScales), std::prev(std::end(kScales)),
                   [&](const auto& each) { return metres.maxCoeff() >= each.first; });
  return fmt::format("{} {}", sides_text(metres / scale->first, 3), scale->second);
}

}  // namespace ist::answers
