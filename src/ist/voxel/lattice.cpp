#include "ist/voxel/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <string_view>

#include "ist/base/platform/from_chars.h"
#include "ist/mesh/bounding_box.h"

namespace ist {

namespace {

// Parses a number in any locale of the host, unlike std::stod.
double number(std::string_view text) {
  double value = 0;
  from_chars(text, value);
  return value;
}

double extent_of(const Eigen::Vector3d& box_min, const Eigen::Vector3d& box_max) {
  return std::max({box_max[0] - box_min[0], box_max[1] - box_min[1], box_max[2] - box_min[2]});
}

double cells_of(double extent, double voxel_size) {
  return std::max(1.0, std::ceil(extent / voxel_size));
}

}  // namespace

double round_to_nice_number(double size, int digits) {
  const std::string text = fmt::format("{:.{}e}", size, digits - 1);
  const double rounded = number(text);
  if (rounded >= size) return rounded;
  std::string last_digit = text;
  std::fill(last_digit.begin(), last_digit.begin() + static_cast<std::ptrdiff_t>(text.find('e')),
            '0');
  last_digit[1] = '.';
  last_digit[text.find('e') - 1] = '1';
  return number(fmt::format("{:.{}e}", rounded + number(last_digit), digits - 1));
}

std::optional<Error> extent_flaw(const Eigen::Vector3d& box_min, const Eigen::Vector3d& box_max) {
  if (has_usable_extent({box_min, box_max})) return std::nullopt;
  return Error(ErrorCode::kMeshExtent,
               fmt::format("the largest extent is {} units, outside [1e-12, 1e15]: scale the mesh",
                           extent_of(box_min, box_max)));
}

std::optional<Error> lattice_flaw(const Eigen::Vector3d& box_min, const Eigen::Vector3d& box_max,
                                  double voxel_size) {
  if (!(voxel_size > 0) || !std::isfinite(voxel_size)) {
    return Error(ErrorCode::kVoxelSizeInvalid,
                 fmt::format("voxel size {}: give a positive number of mesh units", voxel_size));
  }
  if (std::optional<Error> flaw = extent_flaw(box_min, box_max)) return flaw;
  const double extent = extent_of(box_min, box_max);
  if (voxel_size > Lattice::kMaxRelativeSize * extent) {
    return Error(
        ErrorCode::kVoxelSizeInvalid,
        fmt::format("voxel size {} is more than {} times the largest extent of {} units: use a "
                    "smaller one",
                    voxel_size, Lattice::kMaxRelativeSize, extent));
  }
  const double cells = cells_of(extent, voxel_size);
  if (!(cells <= Lattice::kMaxCells)) {
    return Error(ErrorCode::kVoxelSizeTooSmall,
                 fmt::format("voxel size {} needs {:.0f} voxels along the largest extent of {} "
                             "units, and the limit is {}: the smallest size for this mesh is {}",
                             voxel_size, cells, extent, Lattice::kMaxCells,
                             round_to_nice_number(extent / Lattice::kMaxCells)));
  }
  return std::nullopt;
}

Lattice make_lattice(const Eigen::Vector3d& box_min, const Eigen::Vector3d& box_max,
                     double voxel_size) {
  if (const std::optional<Error> flaw = lattice_flaw(box_min, box_max, voxel_size)) throw *flaw;
  Lattice lattice;
  lattice.corner = {box_min[0], box_min[1], box_min[2]};
  lattice.voxel_size = voxel_size;
  lattice.cells = static_cast<std::uint32_t>(cells_of(extent_of(box_min, box_max), voxel_size));
  lattice.depth = static_cast<int>(std::bit_width(lattice.cells - 1));
  return lattice;
}

}  // namespace ist
