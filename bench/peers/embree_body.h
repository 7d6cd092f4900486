#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "ist/mesh/mesh.h"
#include "ist/mesh/triangles_meet.h"

namespace ist::bench {

/// A vertex, mesh units, and 1: the four numbers of a vector.
using Corner = Eigen::Array4d;
[[nodiscard]] std::vector<Corner> corners_of(const TriangleMesh& mesh);

/// A mesh as Embree collides it: a scene of one user geometry, whose boxes of float hold the
/// triangles in double. The mesh must outlive it.
class EmbreeBody {
 public:
  EmbreeBody(RTCDevice device, const TriangleMesh& mesh);
  EmbreeBody(const EmbreeBody&) = delete;
  EmbreeBody& operator=(const EmbreeBody&) = delete;
  ~EmbreeBody();

  /// Moves all vertices from `from`, and refits. They are then the very doubles that
  /// Query::triangle_pairs() moves them to.
  void move(std::span<const Corner> from, const Eigen::Isometry3d& pose);

  [[nodiscard]] RTCScene scene() const { return scene_; }
  /// Whether the box of a triangle here is apart from one there, in double.
  [[nodiscard]] bool box_apart(unsigned triangle, const EmbreeBody& other, unsigned there) const;
  [[nodiscard]] TriangleCorners corners(unsigned triangle) const;

 private:
  void round();
  static void bounds(const RTCBoundsFunctionArguments* args);

  const std::vector<Triangle>& triangles_;
  std::vector<Corner> vertices_;
  std::vector<Eigen::Array4f> rounded_;
  float margin_ = 0;
  RTCScene scene_;
  RTCGeometry geometry_;
};

}  // namespace ist::bench
