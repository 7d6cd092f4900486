#pragma once

#include <array>

#include "ist/mesh/clusters/triangle_clusters.h"
#include "ist/query/traversal/budget_meter.h"
#include "simd/triangles/cluster_step.h"

namespace ist {

inline constexpr std::size_t kBeamWidth = 6;

/// Pairs of clusters that are near each other, best first, for the first bound of a distance. The
/// constructor goes down both trees with the kBeamWidth best pairs of nodes of each level. There
/// are no pairs if the budget ended it.
class NearestBeam {
 public:
  struct NodePair {
    std::uint32_t fixed, moving;
    float score;
  };

  NearestBeam(const TriangleClusters& fixed, const TriangleClusters& moving,
              const ClusterKernels& kernels, const ClusterPose& pose, BudgetMeter& meter) noexcept;

  [[nodiscard]] const NodePair* begin() const noexcept { return pairs_.data(); }
  [[nodiscard]] const NodePair* end() const noexcept { return pairs_.data() + count_; }

 private:
  std::array<NodePair, kBeamWidth> pairs_{};
  std::size_t count_ = 0;
};

}  // namespace ist
