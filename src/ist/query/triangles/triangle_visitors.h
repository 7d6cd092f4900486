#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "ist/base/rigid_move.h"
#include "ist/mesh/mesh.h"
#include "ist/mesh/triangles_meet.h"
#include "ist/query/results.h"
#include "ist/query/triangles/pair_list.h"
#include "simd/triangles/cluster_step.h"

/// The purposes of a search of clusters for triangles that intersect: visitors of a ClusterSearch.
namespace ist {

[[nodiscard]] inline TriangleCorners corners_of(const TriangleMesh& mesh,
                                                std::uint32_t triangle) noexcept {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

/// The triangles of a mesh at a pose. All exact answers are about these doubles.
class MovedTriangles {
 public:
  /// Precondition: `pose` is rigid. Holds a reference to the mesh.
  MovedTriangles(const TriangleMesh& mesh, const Eigen::Isometry3d& pose) noexcept
      : mesh_(mesh), moved_(pose) {}

  [[nodiscard]] TriangleCorners operator[](std::uint32_t triangle) const noexcept {
    const Triangle& t = mesh_.triangles[triangle];
    return {moved_(mesh_.vertices[t[0]]), moved_(mesh_.vertices[t[1]]),
            moved_(mesh_.vertices[t[2]])};
  }

 private:
  const TriangleMesh& mesh_;
  RigidMove moved_;
};

/// Two meshes, the moving one at a pose.
struct Meshes {
  const TriangleMesh& fixed;
  MovedTriangles moving;

  [[nodiscard]] bool meet(TriangleIds ids) const noexcept {
    return triangles_meet(corners_of(fixed, ids.fixed), moving[ids.moving]);
  }
};

/// The memory for the findings of the kernels.
class FoundMemory {
 public:
  FoundMemory() : ids_(4 * kLength), squares_(kLength) {}

  void clear() noexcept {
    std::uint32_t* const ids = ids_.data();
    found = {{ids, ids + kLength}, {ids + 2 * kLength, ids + 3 * kLength}, squares_.data()};
    batch.count = 0;
  }
  [[nodiscard]] static constexpr std::size_t bytes() noexcept {
    return 4 * kLength * sizeof(std::uint32_t) + kLength * sizeof(float) + sizeof(TriangleBatch);
  }

  TriangleBatch batch;
  FoundTriangles found{};

 private:
  // A list's, and a vector behind it.
  static constexpr std::size_t kLength = FoundTriangles::kRoom + kClusterWidth;
  std::vector<std::uint32_t> ids_;
  std::vector<float> squares_;
};

/// The context of a visitor: the bodies at a pose, the kernels, and the memory for what they find.
/// Exact decisions and measurements are not counted as tests: a pair takes 0.1 to 2 µs. The clock
/// is read before every eighth.
struct VisitorContext {
  VisitorContext(const ClusterStep& of, const ClusterKernels& by, const Meshes& bodies,
                 FoundMemory& memory, const Budget& within) noexcept
      : step(of),
        kernels(by),
        meshes(bodies),
        batch(memory.batch),
        found(memory.found),
        budget(within) {
    memory.clear();
  }
  /// Returns whether the deadline has passed. Looks before every eighth pair `k`.
  [[nodiscard]] bool is_late(std::size_t k) const noexcept {
    return k % 8 == 0 && budget.is_past();
  }

  const ClusterStep& step;
  const ClusterKernels& kernels;
  const Meshes& meshes;
  TriangleBatch& batch;
  FoundTriangles& found;
  Budget budget;
};

/// Calls `run(rest)` for the rest of the pairs until it has done all. After each call, `take()`
/// empties the lists of found triangles and returns whether to go on.
template <class Run, class Take>
bool in_turns(const ClusterPairs& clusters, Run run, Take take) {
  const LaneNodes& all = clusters.pairs;
  for (std::size_t done = 0; done < all.count;) {
    done += run(ClusterPairs{clusters.lanes, clusters.moving, all.part(done, all.count)});
    if (!take()) return false;
  }
  return true;
}

/// Lists all pairs that intersect.
class AllPairs {
 public:
  static constexpr bool kMostFirst = false, kMeasuresRest = false;

  AllPairs(const VisitorContext& context, PairList& list) noexcept
      : context_(context), list_(list) {}

  [[nodiscard]] float reach() const noexcept { return context_.step.pose.error; }
  bool visit(const ClusterPairs& clusters) noexcept {
    return in_turns(
        clusters,
        [&](const ClusterPairs& rest) {
          return context_.kernels.meet_clusters(context_.step, rest, context_.batch,
                                                context_.found);
        },
        [&] { return context_.found.has_room() || add_found(); });
  }
  /// Decides and adds the pairs that are left. Returns false if the deadline came before.
  bool finish() noexcept {
    const bool in_time = context_.found.has_room() || add_found();
    context_.kernels.decide_triangles(context_.batch, context_.found);
    return add_found() && in_time;
  }

 private:
  bool add_found() noexcept {
    FoundTriangles& found = context_.found;
    for (std::size_t k = 0; k < found.certain.count; ++k) add(found.certain[k]);
    bool in_time = true;
    for (std::size_t k = 0; k < found.open.count && in_time; ++k) {
      in_time = !context_.is_late(k);
      if (in_time && context_.meshes.meet(found.open[k])) add(found.open[k]);
    }
    found.certain.count = found.open.count = 0;
    return in_time;
  }
  void add(TriangleIds ids) noexcept { list_.add({ids.fixed, ids.moving}); }

  VisitorContext context_;
  PairList& list_;
};

/// Ends with the first pair that intersects.
class AnyPair {
 public:
  static constexpr bool kMostFirst = true, kMeasuresRest = false;

  explicit AnyPair(const VisitorContext& context) noexcept : context_(context) {}

  [[nodiscard]] const std::optional<TriangleIds>& found() const noexcept { return found_; }
  [[nodiscard]] float reach() const noexcept { return context_.step.pose.error; }
  bool visit(const ClusterPairs& clusters) noexcept {
    return in_turns(
        clusters,
        [&](const ClusterPairs& rest) {
          const std::size_t done =
              context_.kernels.meet_clusters(context_.step, rest, context_.batch, context_.found);
          if (context_.batch.count > 0)
            context_.kernels.decide_triangles(context_.batch, context_.found);
          return done;
        },
        [&] { return look() && !found_; });
  }

 private:
  // Returns false if the deadline came before the end.
  bool look() noexcept {
    FoundTriangles& found = context_.found;
    if (found.certain.count > 0) found_ = found.certain[0];
    bool in_time = true;
    for (std::size_t k = 0; k < found.open.count && !found_ && in_time; ++k) {
      in_time = !context_.is_late(k);
      if (in_time && context_.meshes.meet(found.open[k])) found_ = found.open[k];
    }
    found.certain.count = found.open.count = 0;
    return in_time;
  }

  VisitorContext context_;
  std::optional<TriangleIds> found_;
};

}  // namespace ist
