#pragma once

#include "ist/base/api.h"
#include "ist/mesh/triangle_mesh.h"

namespace ist {

/// Plain shapes, made from nothing: closed, of genus 0, facing outward, in mesh units. Only + - * /
/// and square roots are used, so that each is the same bits on every machine.

/// A box of 12 triangles between two opposite corners. Precondition: min < max on every axis.
[[nodiscard]] IST_API TriangleMesh make_box(const Eigen::Vector3d& min, const Eigen::Vector3d& max);

/// An icosahedron whose triangles are cut in four `level` times, its vertices on the sphere round
/// the origin: 20 * 4^level triangles, whose edges are at most 1.33 * radius / 2^level long.
/// Precondition: level from 0 to 12.
[[nodiscard]] IST_API TriangleMesh make_icosphere(int level, double radius);

/// A cylinder round the z axis, from z = 0 up, of 4 * `quarter` sides, the corners on the circle:
/// 16 * `quarter` triangles. Precondition: quarter from 1 to 2^24.
[[nodiscard]] IST_API TriangleMesh make_cylinder(int quarter, double radius, double height);

}  // namespace ist
