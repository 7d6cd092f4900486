#pragma once

#include <array>

#include "ist/mesh/clusters/triangle_clusters.h"
#include "ist/query/exact/cluster_budget.h"
#include "simd/exact/cluster_step.h"

namespace ist {

inline constexpr std::size_t kBeamWidth = 6;

/// Pairs of clusters that are near each other, best first, for the first bound of a distance: by
/// going down both trees with the kBeamWidth pairs of nodes that score best at each level. None
/// where the budget ends it.
class NearestBeam {
 public:
  struct NodePair {
    std::uint32_t fixed, moving;
    float score;
  };

  NearestBeam(const TriangleClusters& fixed, const TriangleClusters& moving,
              const ClusterKernels& kernels, const ClusterPose& pose,
              ClusterBudget& budget) noexcept;

  [[nodiscard]] const NodePair* begin() const noexcept { return pairs_.data(); }
  [[nodiscard]] const NodePair* end() const noexcept { return pairs_.data() + count_; }

 private:
  std::array<NodePair, kBeamWidth> pairs_{};
  std::size_t count_ = 0;
};

}  // namespace ist
