#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ist/base/progress.h"
#include "ist/mesh/clusters/triangle_clusters.h"
#include "ist/mesh/mesh.h"

namespace ist {

/// The pairs of triangles of one mesh that have a point in common beyond the corners and the edges
/// that they share by index. Triangles that only touch count. Triangles without area do not.
struct SelfIntersections {
  /// Of more pairs the search ends.
  static constexpr std::size_t kMost = 1 << 20;

  /// The lower triangle of each pair first, in ascending order.
  std::vector<std::array<std::uint32_t, 2>> pairs;
  bool complete = true;  ///< else there are more pairs
};

/// Finds them exactly. `clusters` hold the mesh's triangles, and their largest extent lies in
/// [1e-12, 1e15]. `progress` may end the call, as Progress says.
/// Cost: 1 µs a triangle on two cores for a mesh without any. The same result for any number of
/// threads. A cancellation point.
[[nodiscard]] SelfIntersections find_self_intersections(const TriangleMesh& mesh,
                                                        const TriangleClusters& clusters,
                                                        const Progress* progress = nullptr);

}  // namespace ist
