#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ist/measure/depth_search.h"
#include "simd/dispatch.h"

namespace ist {

/// Searches two bodies for the deepest point by their outer balls: down the clusters of both
/// surfaces, then the corners of triangles. A DepthSearch settles what is left.
///
/// If asked, it keeps a front: nodes, clusters and triangles that cover both surfaces, each with a
/// bound of its depth. Where no point of a surface moves farther than w, all bounds grow by w at
/// most: if a point is now d deep and came by w, then the ball of radius d round it held its old
/// place, which so was at least d - w deep. The next search looks again only at what may exceed the
/// limit.
class DepthFront {
 public:
  /// Precondition: both bodies have outer balls.
  DepthFront(const std::array<SurfaceInBody, 2>& sides, const ClusterKernels& kernels);

  /// Sets the pose of a side: its cluster frame to the field of its body. Returns whether floats
  /// hold it.
  [[nodiscard]] bool set_pose(std::size_t side, const RigidMove& to_body, DepthSearch& search);
  /// Searches afresh. Keeps a front if `keeps`. Returns whether the search came to its end.
  bool search_all(DepthSearch& search, bool keeps);
  /// Searches what may be too deep by the front, after each surface moved by no more than `ways`.
  bool search_front(DepthSearch& search, const std::array<double, 2>& ways);
  /// Returns whether there is a front worth keeping.
  [[nodiscard]] bool has_front() const noexcept {
    return !keys_.empty() && keys_.size() <= most_entries_;
  }
  void forget() noexcept { keys_.clear(); }
  /// Returns what no point is deeper than, by the search and the front.
  [[nodiscard]] double bound(const DepthSearch& search) const noexcept;
  /// The tests of sixteen nodes or triangles since begin.
  [[nodiscard]] std::uint64_t tests() const noexcept { return tests_; }

 private:
  struct Side {
    const TriangleClusters& clusters;
    const OuterBalls& balls;
    const SurfaceInBody& surface;
    BallGrid grid;
    BallPose pose{};
    double clock = 0;  // the way since the front was made
  };
  static constexpr std::uint8_t kTriangle = 0xFF;
  static constexpr std::size_t kNowhere = ~std::size_t{0};
  // A node, a cluster (level 0) or a triangle. The children in `taken` have entries of their own.
  struct Entry {
    std::uint32_t index;
    std::uint8_t level, side;
    std::uint16_t taken;
    FewTriangles near;
  };
  // What is to be looked at: children of a node or a cluster, or a triangle of a cluster.
  struct Open {
    double bound;
    std::uint32_t index;
    std::uint32_t cluster;  // of a triangle
    std::uint8_t level, side;
    std::uint16_t taken;
    std::size_t entry;  // kNowhere: none yet

    friend bool operator<(const Open& a, const Open& b) {
      return std::tie(b.bound, a.side, a.index) < std::tie(a.bound, b.side, b.index);
    }
  };
  struct Settled {
    std::uint32_t cluster, near;
    std::uint8_t side;
  };
  struct Given {
    std::size_t entry, handed;
  };

  [[nodiscard]] float limit_of(const Side& side, const DepthSearch& search) const noexcept;
  [[nodiscard]] double bound_in(const Side& side, float bound) const noexcept;
  void open_node(const Open& node, DepthSearch& search);
  void open_cluster(const Open& cluster, DepthSearch& search);
  BallLanes bound_triangles(const Open& cluster, const DepthSearch& search,
                            float (&bounds)[kClusterWidth]);
  void keep(const Open& one, double bound, std::uint32_t taken);
  void probe(DepthSearch& search);
  void hand_over(DepthSearch& search);
  bool finish(DepthSearch& search);

  std::array<Side, 2> sides_;
  const ClusterKernels& kernels_;
  bool keeps_ = false;
  std::vector<double> keys_;  // of each entry: its bound less its side's clock
  std::vector<Entry> entries_;
  std::size_t most_entries_ = 0;
  std::uint64_t tests_ = 0;
  std::vector<Open> nodes_, clusters_, triangles_, again_;
  std::vector<Settled> settled_;
  std::vector<Given> given_;
};

}  // namespace ist
