#include "cli/bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cli/extents.h"
#include "ist/base/error.h"

namespace ist::cli {

double Bodies::extent() const {
  return std::min(largest_extent(box_of(fixed)), largest_extent(box_of(moving)));
}

LengthUnit Bodies::unit() const {
  for (const LengthUnit unit : {fixed.source().unit, moving.source().unit}) {
    if (unit != LengthUnit::kUnknown) return unit;
  }
  return told_unit;
}

PatientFrame Bodies::frame() const {
  const PatientFrame frame = fixed.frame();
  return frame == PatientFrame::kUnknown ? moving.frame() : frame;
}

std::optional<std::string> voxel_warning(const std::string& name, double voxel_size,
                                         double extent) {
  constexpr double kVoxels = 50;
  if (!(voxel_size > extent / kVoxels)) return std::nullopt;
  return fmt::format(
      "{}: a voxel of {:.4g} is more than 1/{:.0f} of the largest extent, {:.4g}: take smaller "
      "voxels for sharper answers",
      name, voxel_size, kVoxels, extent);
}

void require_triangles(const Bodies& bodies) {
  for (const auto& [tree, name] :
       {std::pair(&bodies.fixed, &bodies.fixed_name), {&bodies.moving, &bodies.moving_name}}) {
    if (tree->triangles()) continue;
    throw Error(
        ErrorCode::kTrianglesMissing,
        fmt::format("{}: the tree has no triangles: build it without --no-triangles, or name the "
                    "mesh",
                    *name));
  }
}

}  // namespace ist::cli
