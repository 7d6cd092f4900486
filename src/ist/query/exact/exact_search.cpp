#include "ist/query/exact/exact_search.h"

#include <algorithm>
#include <cmath>

#include "ist/base/ordered_vector.h"
#include "ist/query/exact/moved_triangles.h"
#include "ist/query/exact/nearest_beam.h"
#include "ist/query/exact/triangle_distance.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

// The length of a list of indices that the kernels write.
constexpr std::size_t kListed = FoundTriangles::kRoom + kClusterWidth;
// Pairs that are sorted fast.
constexpr std::size_t kSorted = 1 << 14;

// Returns the largest coordinate, without its sign, of a vertex in use; others may lie anywhere.
double largest_coordinate(const TriangleMesh& mesh) {
  double largest = 0;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      largest = std::max(largest, mesh.vertices[v].cwiseAbs().maxCoeff());
    }
  }
  return largest;
}

double longest_edge(const TriangleMesh& mesh) {
  double squared = 0;
  for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
    const TriangleCorners t = corners_of(mesh, k);
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d edge = difference(t[i], t[(i + 1) % 3]);
      squared = std::max(squared, dot_in_order(edge, edge));
    }
  }
  return std::sqrt(squared);
}

float rounded_up(double value) noexcept {
  return static_cast<float>(value * (1 + 0x1p-22)) + std::numeric_limits<float>::min();
}

// Two meshes, the moving one at a pose.
struct Meshes {
  const TriangleMesh& fixed;
  MovedTriangles moving;

  [[nodiscard]] bool meet(TriangleIds ids) const noexcept {
    return triangles_meet(corners_of(fixed, ids.fixed), moving[ids.moving]);
  }
};

// What visitors share: the kernels, and where they put what they find.
struct Bench {
  const ClusterStep& step;
  const ClusterKernels& kernels;
  const Meshes& meshes;
  TriangleBatch& batch;
  FoundTriangles& found;
};

// Calls `run(rest)` for the rest of the pairs until it has done all, and `take()` after each,
// which empties the lists of what was found and says whether to go on.
template <class Run, class Take>
bool in_turns(const ClusterPairs& clusters, Run run, Take take) {
  const LaneNodes& all = clusters.pairs;
  for (std::size_t done = 0; done < all.count;) {
    done += run(ClusterPairs{clusters.lanes, clusters.moving, all.part(done, all.count)});
    if (!take()) return false;
  }
  return true;
}

// Lists all pairs that intersect.
class AllPairs {
 public:
  static constexpr bool kMostFirst = false, kMeasuresRest = false;

  AllPairs(Bench bench, PairList& list) noexcept : bench_(bench), list_(list) {}

  [[nodiscard]] float reach() const noexcept { return bench_.step.pose.error; }
  bool visit(const ClusterPairs& clusters) noexcept {
    return in_turns(
        clusters,
        [&](const ClusterPairs& rest) {
          return bench_.kernels.meet_clusters(bench_.step, rest, bench_.batch, bench_.found);
        },
        [&] {
          if (!bench_.found.has_room()) take();
          return true;
        });
  }
  // Decides and takes what is left.
  void finish() noexcept {
    if (!bench_.found.has_room()) take();
    bench_.kernels.decide_triangles(bench_.batch, bench_.found);
    take();
  }

 private:
  void take() noexcept {
    FoundTriangles& found = bench_.found;
    for (std::size_t k = 0; k < found.certain.count; ++k) add(found.certain[k]);
    for (std::size_t k = 0; k < found.open.count; ++k) {
      if (bench_.meshes.meet(found.open[k])) add(found.open[k]);
    }
    found.certain.count = found.open.count = 0;
  }
  void add(TriangleIds ids) noexcept { list_.add({ids.fixed, ids.moving}); }

  Bench bench_;
  PairList& list_;
};

// Ends with the first pair that intersects.
class AnyPair {
 public:
  static constexpr bool kMostFirst = true, kMeasuresRest = false;

  explicit AnyPair(Bench bench) noexcept : bench_(bench) {}

  [[nodiscard]] bool found() const noexcept { return found_; }
  [[nodiscard]] float reach() const noexcept { return bench_.step.pose.error; }
  bool visit(const ClusterPairs& clusters) noexcept {
    return in_turns(
        clusters,
        [&](const ClusterPairs& rest) {
          const std::size_t done =
              bench_.kernels.meet_clusters(bench_.step, rest, bench_.batch, bench_.found);
          if (bench_.batch.count > 0) bench_.kernels.decide_triangles(bench_.batch, bench_.found);
          return done;
        },
        [&] {
          take();
          return !found_;
        });
  }

 private:
  void take() noexcept {
    FoundTriangles& found = bench_.found;
    found_ = found.certain.count > 0;
    for (std::size_t k = 0; k < found.open.count && !found_; ++k) {
      found_ = bench_.meshes.meet(found.open[k]);
    }
    found.certain.count = found.open.count = 0;
  }

  Bench bench_;
  bool found_ = false;
};

// Finds the nearest pair, or one that is farther by at most the tolerance. Only nodes are left out
// for the tolerance's sake; of the triangles that are compared the nearest is found, so that the
// answer does not depend on how the kernels decide.
class NearestPair {
 public:
  static constexpr bool kMostFirst = false, kMeasuresRest = true;

  NearestPair(Bench bench, double tolerance, double longest_edge, double nearest) noexcept
      : bench_(bench),
        tolerance_(tolerance > 0 ? tolerance : 0),  // a NaN too
        longest_edge_(longest_edge),
        nearest_(nearest) {}

  [[nodiscard]] double distance() const noexcept { return nearest_; }
  [[nodiscard]] double error() const noexcept {
    return nearest_ > 0 ? kTriangleDistanceError * (longest_edge_ + nearest_) : 0;
  }
  /// Returns the distance from which on nothing was looked for.
  [[nodiscard]] double within() const noexcept {
    return std::max(0.0, nearest_ + 2 * error() - tolerance_);
  }
  [[nodiscard]] float reach() const noexcept {
    return rounded_up(within() + double{bench_.step.pose.error});
  }
  bool visit(const ClusterPairs& clusters) noexcept {
    const float margin = rounded_up(2 * error() + double{bench_.step.pose.error});
    Reach reaches{rounded_up(nearest_) + margin, margin};
    return in_turns(
        clusters,
        [&](const ClusterPairs& rest) {
          return bench_.kernels.near_clusters(bench_.step, rest, reaches, bench_.batch,
                                              bench_.found);
        },
        [&] {
          measure_found();
          bench_.found.open.count = 0;
          return nearest_ > 0;
        });
  }

 private:
  // First the pair that may be the nearest, so that few others may still be nearer.
  void measure_found() noexcept {
    const FoundTriangles& found = bench_.found;
    const std::size_t count = found.open.count;
    const auto first = static_cast<std::size_t>(
        std::min_element(found.squares, found.squares + count) - found.squares);
    if (count > 0) measure(found.open[first]);
    for (std::size_t k = 0; k < count && nearest_ > 0; ++k) {
      const double enough = nearest_ + 2 * error() + double{bench_.step.pose.error};
      if (k != first && double{found.squares[k]} <= enough * enough) measure(found.open[k]);
    }
  }
  void measure(TriangleIds ids) noexcept {
    const TriangleCorners a = corners_of(bench_.meshes.fixed, ids.fixed);
    const TriangleCorners b = bench_.meshes.moving[ids.moving];
    const double boxes = box_distance_squared(a, b);
    const double enough = nearest_ + 2 * error();
    if (boxes > enough * enough || surely_farther(a, b, enough)) return;
    nearest_ = boxes == 0 && triangles_meet(a, b)
                   ? 0
                   : std::min(nearest_, std::sqrt(distance_squared(a, b)));
  }

  Bench bench_;
  double tolerance_, longest_edge_, nearest_;
};

}  // namespace

ExactSearch::ExactSearch(const SphereTree& fixed, const SphereTree& moving, const Kernels& kernels)
    : fixed_(fixed),
      moving_(moving),
      fixed_clusters_(fixed.parts().triangles->clusters),
      moving_clusters_(moving.parts().triangles->clusters),
      kernels_(kernels.clusters),
      largest_coordinate_(largest_coordinate(*moving.triangles())),
      longest_edge_(std::max(longest_edge(*fixed.triangles()), longest_edge(*moving.triangles()))),
      search_(fixed_clusters_, moving_clusters_, kernels_),
      list_(kSorted),
      ids_(4 * kListed),
      squares_(kListed) {}

double ExactSearch::moved_error(const Eigen::Isometry3d& rigid) const noexcept {
  return 0x1p-48 * (largest_coordinate_ + rigid.translation().cwiseAbs().maxCoeff());
}

bool ExactSearch::is_too_far(const RelativePose& pose) const noexcept {
  constexpr double kFar = 0x1p12;
  const double radii = fixed_.bounding_radius() + moving_.bounding_radius();
  return pose.translation.cwiseAbs().maxCoeff() > kFar * radii;
}

// The motion between the clusters' frames. Beside the rounding of moved vertices, that of the
// frames' origins, of the motion's product, and of coordinates in a frame.
ClusterPose ExactSearch::cluster_pose(const ExactPose& pose) const noexcept {
  const Eigen::Matrix3d &a = fixed_clusters_.axes(), &b = moving_clusters_.axes();
  ClusterPose out;
  Eigen::Matrix3d turned;  // rotation · b
  const auto& r = pose.relative.rotation;
  const auto product = [](const auto& row, const auto& column) {
    return (row[0] * column[0] + row[1] * column[1]) + row[2] * column[2];
  };
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) turned(i, j) = product(r.row(i), b.col(j));
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      out.rotation[i][j] = product(a.col(i), turned.col(j));
    }
    out.translation[i] = product(a.col(i), pose.relative.translation);
  }
  out.grid = fixed_clusters_.grid();
  const double frames =
      0x1p-46 * (fixed_.bounding_radius() + moving_.bounding_radius() +
                 pose.relative.translation.cwiseAbs().maxCoeff()) +
      0x1p-50 * (fixed_.origin().cwiseAbs().maxCoeff() + moving_.origin().cwiseAbs().maxCoeff());
  out.error = rounded_up(2 * moved_error(pose.rigid) + frames);
  return out;
}

void ExactSearch::clear_found() noexcept {
  std::uint32_t* const ids = ids_.data();
  found_ = {{ids, ids + kListed}, {ids + 2 * kListed, ids + 3 * kListed}, squares_.data()};
  batch_.count = 0;
}

ExactSearch::End ExactSearch::pairs(const ExactPose& pose, const Budget& budget,
                                    std::span<TrianglePair> out) noexcept {
  clear_found();
  list_.begin(out);
  const Meshes meshes{*fixed_.triangles(), {*moving_.triangles(), pose.rigid}};
  AllPairs all({search_.step(), kernels_, meshes, batch_, found_}, list_);
  ClusterBudget spent(budget, 0);
  search_.begin(cluster_pose(pose));
  const bool complete = search_.run(spent, all);
  all.finish();
  list_.finish();
  return {complete, spent.spent()};
}

ExactSearch::End ExactSearch::any(const ExactPose& pose, const Budget& budget,
                                  bool& found) noexcept {
  clear_found();
  const Meshes meshes{*fixed_.triangles(), {*moving_.triangles(), pose.rigid}};
  AnyPair any({search_.step(), kernels_, meshes, batch_, found_});
  ClusterBudget spent(budget, 0);
  search_.begin(cluster_pose(pose));
  const bool complete = search_.run(spent, any);
  found = any.found();
  return {complete || found, spent.spent()};
}

ExactSearch::End ExactSearch::nearest(const ExactPose& pose, double tolerance, const Budget& budget,
                                      DistanceInterval& distance) noexcept {
  clear_found();
  const Meshes meshes{*fixed_.triangles(), {*moving_.triangles(), pose.rigid}};
  const ClusterPose at = cluster_pose(pose);
  NearestPair nearest({search_.step(), kernels_, meshes, batch_, found_}, tolerance, longest_edge_,
                      distance.upper);
  ClusterBudget spent(budget, 0);
  search_.begin(at);
  TurnedBlock turned;
  for (const auto& pair : NearestBeam(fixed_clusters_, moving_clusters_, kernels_, at)) {
    const std::uint32_t block = pair.moving / kClusterWidth, lane = pair.moving % kClusterWidth;
    kernels_.turn_nodes(moving_clusters_.bounds(0)[block], at, turned);
    const std::uint32_t code = kClusterWidth * pair.fixed + lane;
    nearest.visit({turned, kClusterWidth * block, {&code, 1}});
  }
  bool complete = nearest.distance() == 0 || search_.run(spent, nearest);
  complete = complete || nearest.distance() == 0;
  const double error = nearest.error();
  double lower =
      nearest.distance() > 0 ? std::min(nearest.within(), nearest.distance()) - error : 0;
  if (!complete) lower = std::min(lower, search_.nearest_left());
  distance = {std::max(distance.lower, lower), nearest.distance() + error};
  return {complete, spent.spent()};
}

std::size_t ExactSearch::bytes() const noexcept {
  return search_.bytes() + list_.bytes() + ids_.size() * sizeof(std::uint32_t) +
         squares_.size() * sizeof(float) + sizeof(batch_);
}

}  // namespace ist
