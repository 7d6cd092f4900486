#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ist/base/api.h"
#include "ist/base/float_environment.h"
#include "ist/base/pose.h"
#include "ist/query/pair_cache/cached_search.h"
#include "ist/query/query.h"
#include "ist/query/traversal/root_test.h"
#include "ist/query/triangles/triangle_search.h"
#include "ist/query/workers/shared_search.h"

namespace ist::detail {

/// The two bodies at one pose.
struct Approach {
  RelativePose relative;
  RootTest roots;
  double margin;  ///< added to the radius sum of every test
};

/// Returns the result for a pose that is no rigid motion.
[[nodiscard]] inline QueryResult invalid_pose(const Eigen::Isometry3d& pose) noexcept {
  return {.status = QueryStatus::kInvalidPose,
          .complete = false,
          .rotation_error = rotation_error(pose)};
}

/// Numbers of a tree that take time to measure.
struct TreeFacts {
  struct Leaves {
    TreeShape shape;
    MotionBound::Box box;
  };
  explicit TreeFacts(const SphereTree& tree) : triangles(TriangleLengths::of(tree)) {
    if (tree.has_voxels()) leaves = Leaves{TreeShape(tree), MotionBound::box_of(tree)};
  }

  std::optional<Leaves> leaves;  ///< only with voxels
  TriangleLengths triangles;
};

/// The memory of a query for pairs of trees that it is bound to later.
struct QueryRoom {
  std::size_t search_items = 0;   ///< the least Search::items_for()
  std::size_t cluster_items = 0;  ///< the least ClusterSearch::items_for()
  /// A tree with voxels, and one with triangles, if two trees of a pair may have them. Null: the
  /// query's own trees stand for those that come later.
  const SphereTree* voxels = nullptr;
  const SphereTree* triangles = nullptr;
};

/// Returns why two trees can answer no question together, and the remedy: one has no voxels, and
/// the other no triangles. Empty if they can.
[[nodiscard]] std::string lacks_common(const SphereTree& a, std::string_view a_name,
                                       const SphereTree& b, std::string_view b_name);

/// Returns whether a length may be the margin of a query.
[[nodiscard]] inline bool is_margin(double margin) noexcept {
  return margin >= 0 && margin < std::numeric_limits<double>::infinity();
}

/// Returns the options of the pair cache of such a query.
[[nodiscard]] inline CacheOptions cache_options(const QueryOptions& options) noexcept {
  return {options.frontier_pairs, options.front_pairs, options.workers, options.period};
}

/// The memory of a Query, and the steps that its verbs share.
struct QueryState {
  QueryState(const SphereTree& fixed_tree, const SphereTree& moving_tree,
             const QueryOptions& options, const ScopedFloatEnvironment& environment,
             const QueryRoom& room = {});

  /// Asks two other trees from now on, and forgets earlier questions. Allocates nothing.
  /// Preconditions: the query has one worker, no pair cache of its own, and room for the trees.
  ///
  /// @param of_leaves whether the next question may search leaves: else binding takes less time
  void bind(const SphereTree& fixed_tree, const TreeFacts& of_fixed, const SphereTree& moving_tree,
            const TreeFacts& of_moving, bool of_leaves) noexcept;

  /// Returns the bytes that the memory of a query takes. Throws the same errors as the constructor.
  [[nodiscard]] IST_LOOP_API static std::size_t bytes_for(const SphereTree& fixed,
                                                          const SphereTree& moving,
                                                          const QueryOptions& options,
                                                          const QueryRoom& room = {});
  /// Returns the policy of a query of two trees; kSimple if one of them lacks voxels.
  [[nodiscard]] static SpherePolicy policy_of(const SphereTree& fixed, const SphereTree& moving,
                                              const QueryOptions& options) noexcept {
    return options.policy.value_or(std::min(fixed.tightest(), moving.tightest()));
  }

  /// Reserves the memory for questions of leaves. Precondition: there is a plan.
  void reserve_leaves(const QueryOptions& options, const QueryRoom& room);
  /// Composes the relative pose and tests the roots. Returns nothing if `pose` is no rigid motion.
  [[nodiscard]] std::optional<Approach> approach(const Eigen::Isometry3d& pose,
                                                 double margin = 0) const noexcept;
  /// Returns the rounding error of a triangle that is moved in double, mesh units; 0 if a tree has
  /// no triangles.
  [[nodiscard]] double triangle_error(const Eigen::Isometry3d& pose) const noexcept;
  [[nodiscard]] SearchPose to_float(const Approach& approach, double margin = 0) const noexcept;
  /// Returns the pad of leaves that a leaf pair may need, mesh units.
  [[nodiscard]] double pad_of(const SearchPose& pose) const noexcept;
  /// Returns whether both trees have voxels. The steps of leaves need them. A query that was bound
  /// for another question has none.
  [[nodiscard]] bool has_leaves() const noexcept { return has_plan; }
  /// Returns the search of the calling thread alone.
  [[nodiscard]] Search& serial() noexcept;
  /// Passes the leaf pairs of two bodies whose roots overlap to a Lister's sink: from a cache, or
  /// by a fresh search. Completes `result` but for its distance, and returns the interval of that.
  template <class Lister>
  [[nodiscard]] DistanceInterval search(const Approach& bodies, const SearchPose& pose,
                                        const Budget& budget, Measured measured,
                                        typename Lister::Sink& sink, QueryResult& result) noexcept;
  /// Searches from the roots with all workers.
  template <class Lister>
  [[nodiscard]] SharedSearch::End search_afresh(const SearchPose& pose, const BudgetMeter& meter,
                                                Measured measured,
                                                typename Lister::Sink& sink) noexcept;
  /// Lists all leaf pairs at a pose.
  [[nodiscard]] QueryResult list(const Eigen::Isometry3d& pose, const Budget& budget,
                                 LeafPairSink& sink) noexcept;
  /// Returns the result that the root test alone gives.
  [[nodiscard]] QueryResult root_result(const RootTest& roots, double margin = 0) const noexcept;
  /// Passes on the leaf pairs of a pair cache, and goes on with the next one. Returns the interval
  /// of the distance.
  template <class Sink>
  [[nodiscard]] DistanceInterval answer_from(const CachedSearch::CacheAt& found,
                                             const Approach& bodies, const SearchPose& pose,
                                             const Budget& budget, Sink& sink,
                                             QueryResult& result) noexcept;
  void set_pad(double pad, QueryResult& result) const noexcept;
  /// Narrow the interval of `result` to a width of `tolerance` by triangles or by leaves. They stop
  /// earlier at the end of the budget, or if rounding allows no more.
  void nearest_triangles(const Eigen::Isometry3d& pose, const Approach& bodies, double tolerance,
                         const Budget& budget, DistanceResult& result) noexcept;
  void nearest_leaves(const Approach& bodies, double tolerance, const Budget& budget,
                      DistanceResult& result) noexcept;

  SphereTree fixed, moving;  // which share the content
  const std::optional<SpherePolicy> wanted_policy;
  SpherePolicy policy;
  const Kernels& kernels;
  int workers;
  std::optional<SearchPlan> plan;  // only with voxels, as `searches` and the cache
  bool has_plan;                   // of these trees
  bool is_bound;                   // to these trees; else bind() has to come first
  std::size_t bytes;
  std::variant<std::monostate, Search, SharedSearch> searches;  // made after the plan it refers to
  std::optional<CachedSearch> own_cache;
  CachedSearch* cached = nullptr;  // the own one, or one that a World keeps for the pair
  std::optional<TriangleSearch> own_triangles;
  TriangleSearch* triangles = nullptr;  // null if a tree has no triangles
  std::vector<LeafPair> window;         // the leaf pairs that a stream is given at once
  std::atomic_flag in_use;
};

/// The use of a query or a world by one thread, until the end of the scope. Is false if another
/// thread is using it. @param state has an `in_use`
class Use {
 public:
  template <class State>
  explicit Use(State& state) noexcept
      : in_use_(state.in_use.test_and_set(std::memory_order_acquire) ? nullptr : &state.in_use) {}
  ~Use() {
    if (in_use_ != nullptr) in_use_->clear(std::memory_order_release);
  }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;
  [[nodiscard]] explicit operator bool() const noexcept { return in_use_ != nullptr; }

 private:
  std::atomic_flag* in_use_;
};

}  // namespace ist::detail
