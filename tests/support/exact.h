#pragma once

#include <gmpxx.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "ist/mesh/mesh.h"
#include "ist/voxel/lattice.h"

namespace ist::test {

/// Geometry in exact rationals: the oracle that code in double is held against. Plain and slow, and
/// made of nothing of the library's but its plain structs.

struct ExactPoint {
  std::array<mpq_class, 3> coordinates;
  mpq_class& operator[](std::size_t axis) { return coordinates[axis]; }
  const mpq_class& operator[](std::size_t axis) const { return coordinates[axis]; }
  friend bool operator==(const ExactPoint&, const ExactPoint&) = default;
};

[[nodiscard]] ExactPoint operator+(const ExactPoint& a, const ExactPoint& b);
[[nodiscard]] ExactPoint operator-(const ExactPoint& a, const ExactPoint& b);
[[nodiscard]] ExactPoint operator*(const mpq_class& factor, const ExactPoint& a);
[[nodiscard]] mpq_class dot(const ExactPoint& a, const ExactPoint& b);
[[nodiscard]] ExactPoint cross(const ExactPoint& a, const ExactPoint& b);
[[nodiscard]] mpq_class square(const ExactPoint& a);

/// The axis, of length 1.
[[nodiscard]] ExactPoint unit(std::size_t axis);
/// The largest whole number that is at most `x`.
[[nodiscard]] mpz_class floor_of(const mpq_class& x);

/// The same number: every finite double is a rational.
[[nodiscard]] ExactPoint exact(const Eigen::Vector3d& point);

/// The corners of a convex flat piece, in turn; a point and a segment are pieces too.
using ExactPolygon = std::vector<ExactPoint>;

[[nodiscard]] ExactPolygon exact_triangle(const TriangleMesh& mesh, std::size_t triangle);
[[nodiscard]] ExactPolygon exact_triangle(const std::array<Eigen::Vector3d, 3>& corners);

/// Returns the part of `polygon` with low <= coordinate `axis` <= high. It is empty if they do not
/// touch.
[[nodiscard]] ExactPolygon clip_between(const ExactPolygon& polygon, std::size_t axis,
                                        const mpq_class& low, const mpq_class& high);

/// A closed box.
struct ExactBox {
  ExactPoint low, high;
};

/// The part of `polygon` inside the box; empty exactly if they do not meet.
[[nodiscard]] ExactPolygon clip(const ExactPolygon& polygon, const ExactBox& box);

/// The square of the distance from a point to a triangle, which may be a segment or a point.
[[nodiscard]] mpq_class distance_squared(const ExactPoint& point, const ExactPolygon& triangle);

struct ExactBall {
  ExactPoint centre;
  mpq_class radius_squared;
};

/// The smallest ball that holds the points, at least one.
[[nodiscard]] ExactBall smallest_ball(const std::vector<ExactPoint>& points);

/// The pad that is guaranteed: a thousand millionth of the grid's extent, mesh units.
[[nodiscard]] mpq_class exact_pad(const Lattice& lattice);

/// The cube of an octree node, mesh units: corner + (whole number) * voxel size.
[[nodiscard]] ExactBox node_cube(const Lattice& lattice, int level, std::uint64_t code);

/// `box` grown on all sides.
[[nodiscard]] ExactBox grown(ExactBox box, const mpq_class& by);

/// The origin of the tree's frame, the root cube's centre, mesh units.
[[nodiscard]] ExactPoint frame_origin(const Lattice& lattice);

/// Morton codes, ascending, of the lattice's cells that a convex piece meets when they are grown by
/// `grow` mesh units.
[[nodiscard]] std::vector<std::uint64_t> cells_met(const ExactPolygon& polygon,
                                                   const Lattice& lattice, const mpq_class& grow);

/// Whether two convex polygons in space share a point. Touching counts. Each may be flat to a
/// segment or a point; no corners are the empty set.
[[nodiscard]] bool polygons_meet(const ExactPolygon& a, const ExactPolygon& b);

}  // namespace ist::test
