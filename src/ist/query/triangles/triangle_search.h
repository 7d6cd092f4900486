#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ist/query/relative_pose.h"
#include "ist/query/triangles/cluster_search.h"
#include "ist/query/triangles/near_cache.h"
#include "ist/query/triangles/near_visitor.h"
#include "ist/query/triangles/pair_list.h"
#include "ist/query/triangles/shared_pairs.h"
#include "ist/query/triangles/swept_nodes.h"
#include "ist/query/triangles/triangle_visitors.h"
#include "ist/tree/sphere_tree.h"
#include "simd/dispatch.h"

namespace ist {

struct SweptList;

struct TriangleOptions {
  int workers;                      ///< 1 or 2
  std::chrono::nanoseconds period;  ///< as for ResidentWorker::tick
  std::size_t near_pairs = 0;       ///< room of a NearCache; 0: there is none
  std::size_t items = 0;            ///< least ClusterSearch::items_for(), to be bound later
};

/// Lengths of a mesh, mesh units.
struct TriangleLengths {
  /// Measures a tree's triangles; zeros without triangles. Cost: 10 ns a triangle.
  static TriangleLengths of(const SphereTree& tree);

  double largest_coordinate = 0;  ///< without its sign, of a vertex in use
  double longest_edge = 0;
};

/// The triangles that a question found last at a pair of bodies, for the next one.
struct Witnesses {
  struct Nearest {
    TriangleIds ids;
    double distance;
  };
  std::optional<TriangleIds> met;       ///< to any question: other ones on other targets
  std::optional<TriangleIds> touching;  ///< to pairs() or nearest(): the same on every target
  std::optional<Nearest> nearest;
};

/// Two bodies at a pose, for exact questions.
struct TrianglePose {
  const Eigen::Isometry3d& rigid;  ///< of mesh coordinates
  const RelativePose& relative;    ///< the same, of the trees' frames
};

/// Answers questions about the triangles of two trees: a traversal of their clusters, a decision in
/// float with a bound of its error, and exact arithmetic for what that leaves open. A second worker
/// helps with pairs() alone.
///
/// Keeps witnesses, the triangles that met last and those that were nearest last. They are looked
/// at first, unless the budget has a limit of tests. An answer to nearest() depends on witnesses
/// that are the same on every target.
class TriangleSearch {
 public:
  /// Reserves all memory. Both trees must have triangles. Refers to both.
  TriangleSearch(const SphereTree& fixed, const SphereTree& moving, const Kernels& kernels,
                 const TriangleOptions& options);

  /// Asks two other trees from now on, and refers to them. Allocates nothing. Preconditions: both
  /// have triangles, and the search has ClusterSearch::items_for() numbers. It has one worker, and
  /// no NearCache.
  void bind(const SphereTree& fixed, const TriangleLengths& of_fixed, const SphereTree& moving,
            const TriangleLengths& of_moving) noexcept;

  /// The end of a search, and its cost.
  struct End {
    bool complete;        ///< the budget did not end it
    std::uint64_t tests;  ///< as Budget::tests counts them
  };
  struct Any : End {
    bool found;
  };
  struct Nearest : End {
    double error;                  ///< of a distance of triangles, mesh units
    std::optional<NearPair> pair;  ///< the nearest that was found
  };

  /// Finds all pairs of triangles that intersect; the first of them go into `out`. pair_count()
  /// says how many there are.
  End pairs(const TrianglePose& pose, const Budget& budget, std::span<TrianglePair> out) noexcept;
  [[nodiscard]] std::uint64_t pair_count() const noexcept { return list_.count(); }

  /// Tests whether any pair of triangles intersects.
  Any any(const TrianglePose& pose, const Budget& budget) noexcept;

  /// Bounds the distance between the surfaces by an interval that is no wider than `tolerance`, or
  /// twice the error, unless the budget ended the search.
  ///
  /// @param distance bounds it already; narrowed
  Nearest nearest(const TrianglePose& pose, double tolerance, const Budget& budget,
                  DistanceInterval& distance) noexcept;

  /// The witnesses. If a search serves several pairs, its owner keeps those of each pair.
  [[nodiscard]] Witnesses& witnesses() noexcept { return witnesses_; }

  struct Near : End {
    bool kept;  ///< a list from earlier poses answered
  };
  /// Lists all pairs of triangles no farther apart than `enough` in double, and no others.
  Near near(const TrianglePose& pose, double enough, const Budget& budget, NearList& list) noexcept;
  /// Returns the most by which the distance of two triangles that are no farther apart than
  /// `margin` is wrong in double, mesh units.
  [[nodiscard]] double distance_error(double margin) const noexcept {
    return kTriangleDistanceError * (longest_edge_ + margin);
  }

  struct Swept {
    bool complete;  ///< the deadline did not end the search
    bool fits;      ///< there are not too many pairs
  };
  /// Lists all pairs of triangles that may meet on a part of a motion: swept_pairs().
  Swept swept(const RelativePose& middle, const ScrewPart& part, const Budget& budget,
              std::size_t most, SweptList& out) noexcept;

  void forget() noexcept {
    witnesses_ = {};
    if (near_) near_->forget();
  }

  /// Returns whether the bodies are so far apart, against their sizes, that float cannot tell their
  /// triangles' distances from each other.
  [[nodiscard]] bool is_too_far(const RelativePose& pose) const noexcept;

  /// Returns the rounding error of a triangle that is moved in double, mesh units.
  [[nodiscard]] double moved_error(const Eigen::Isometry3d& rigid) const noexcept;
  /// Returns how often the second worker helped.
  [[nodiscard]] Sharing sharing() const noexcept {
    return shared_ ? shared_->sharing() : Sharing{};
  }
  /// Returns the bytes that a search of these trees reserves, with one worker or two.
  [[nodiscard]] static std::size_t bytes_for(const SphereTree& fixed, const SphereTree& moving,
                                             const TriangleOptions& options) noexcept;

 private:
  [[nodiscard]] double radii() const noexcept {
    return fixed_->bounding_radius() + moving_->bounding_radius();
  }
  [[nodiscard]] ClusterPose cluster_pose(const TrianglePose& pose) const noexcept;
  [[nodiscard]] ClusterPose cluster_pose(const Eigen::Isometry3d& rigid) const noexcept;
  [[nodiscard]] static bool still_meet(const std::optional<TriangleIds>& witness,
                                       const Meshes& meshes, const Budget& budget) noexcept;
  void prepare_near(const NearCache::Need& need, std::uint64_t tests,
                    const Budget& budget) noexcept;
  template <class Visitor>
  void begin_nearest(BudgetMeter& meter, Visitor& nearest) noexcept;

  const SphereTree *fixed_, *moving_;
  const TriangleClusters *fixed_clusters_, *moving_clusters_;
  const ClusterKernels& kernels_;
  double largest_coordinate_, longest_edge_;
  ClusterSearch search_;
  PairList list_;
  FoundMemory memory_;
  std::optional<SharedPairs> shared_;
  std::optional<NearCache> near_;
  Witnesses witnesses_;
};

}  // namespace ist
