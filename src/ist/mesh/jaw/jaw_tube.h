#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "ist/mesh/triangle_mesh.h"

namespace ist {

/// Where the two ends of a tube are sewn up: the sewing starts at the edge that leads to this
/// vertex of the ring and goes both ways from there.
struct TubeSeams {
  std::size_t first, last;
};

/// A closed surface of genus 0 from a stack of rings: quads between neighbours, cut along the
/// shorter diagonal, and both ends sewn up across without new vertices. n vertices give 2n - 4
/// triangles. Coordinates are rounded to float, so that a binary STL holds them without loss.
///
/// @param vertices ring after ring; seen along the stack, each ring turns clockwise
/// @param ring_size vertices a ring, at least 3; divides vertices.size()
TriangleMesh sew_tube(std::span<const Eigen::Vector3d> vertices, std::size_t ring_size,
                      TubeSeams seams);

}  // namespace ist
