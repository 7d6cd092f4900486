#pragma once

#include <array>

#include "ist/tree/clusters/triangle_clusters.h"
#include "simd/exact/cluster_step.h"

namespace ist {

inline constexpr std::size_t kBeamWidth = 6;

/// Triangles that are near each other, for the first bound of a distance: by going down both trees
/// with the kBeamWidth pairs of nodes that score best at each level, and then by first corners.
class NearestBeam {
 public:
  NearestBeam(const TriangleClusters& fixed, const TriangleClusters& moving,
              const ClusterKernels& kernels, const ClusterPose& pose) noexcept;

  [[nodiscard]] const TriangleIds* begin() const noexcept { return ids_.data(); }
  [[nodiscard]] const TriangleIds* end() const noexcept { return ids_.data() + count_; }

 private:
  std::array<TriangleIds, kBeamWidth> ids_{};
  std::size_t count_ = 0;
};

}  // namespace ist
