#include "answers/bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "answers/extents.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/nearest_point.h"

namespace ist::answers {

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
    throw_error(ErrorCode::kTrianglesMissing,
                "{}: the tree has no triangles: build it without --no-triangles, or name the mesh",
                *name);
  }
}

Eigen::Vector3d shared_point(const Bodies& bodies, const TrianglePair& pair,
                             const Eigen::Isometry3d& pose) {
  constexpr int kTurns = 2000;  // 0.2 ms
  const auto corners = [](const TriangleMesh& mesh, std::uint32_t triangle,
                          const Eigen::Isometry3d& place) {
    std::array<Eigen::Vector3d, 3> found;
    for (std::size_t i = 0; i < 3; ++i) {
      found[i] = place * mesh.vertices[mesh.triangles[triangle][i]];
    }
    return found;
  };
  const auto fixed = corners(*bodies.fixed.triangles(), pair.fixed, Eigen::Isometry3d::Identity());
  const auto moving = corners(*bodies.moving.triangles(), pair.moving, pose);
  // Nearest points of both in turn lead to a common point of two convex sets.
  Eigen::Vector3d point = (moving[0] + moving[1] + moving[2]) / 3;
  for (int turn = 0; turn < kTurns; ++turn) {
    point = nearest_on_triangle(moving, nearest_on_triangle(fixed, point).point).point;
  }
  return nearest_on_triangle(fixed, point).point;
}

}  // namespace ist::answers
