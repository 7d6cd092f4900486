#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "ist/base/float_rounding.h"
#include "ist/base/ordered_vector.h"
#include "ist/query/triangles/moving_pair.h"
#include "ist/query/triangles/near_visitor.h"
#include "ist/query/triangles/swept_nodes.h"
#include "ist/query/triangles/triangle_distance.h"
#include "ist/query/triangles/triangle_visitors.h"

namespace ist {

/// The findings of SweptPairs.
struct SweptList {
  // Pairs of clusters, of one block of moving ones.
  struct Group {
    std::uint32_t moving;  // the first of the block
    std::size_t first, count;
  };
  std::vector<SweptPair> pairs;
  std::vector<std::uint32_t> codes;  ///< of pairs of clusters
  std::vector<Group> groups;         ///< of codes

  /// Reserves memory for so many pairs of clusters, and of triangles.
  void reserve(std::size_t most) {
    pairs.reserve(most);
    codes.reserve(most + kClusterWidth);  // a kernel may read a vector behind the last code
    groups.reserve(most);
  }
};

/// Lists all pairs of triangles that may meet on a part of a motion: a visitor of a ClusterSearch
/// whose nodes are swept. Doubles decide about each pair, so the list has the same pairs on every
/// instruction set. The clusters come first, so that too long a list costs little.
class SweptPairs {
 public:
  static constexpr bool kMostFirst = false, kMeasuresRest = false;
  /// If the way is longer than the clusters' radii, all their triangles are compared: a pair counts
  /// as so many.
  static constexpr std::size_t kFarWork = 8;

  /// @param error of a distance in double, mesh units
  /// @param most  more pairs, of clusters or of triangles, end the search; `out` has room for them,
  /// and is empty
  SweptPairs(const VisitorContext& context, const TriangleMesh& moving,
             const TriangleClusters& moving_clusters, const ScrewPart& part, double error,
             std::size_t most, SweptList& out) noexcept
      : context_(context),
        moving_(moving),
        moving_clusters_(moving_clusters),
        part_(part),
        at_start_(moving, to_isometry(part.start)),
        plain_(plain_move(to_isometry(part.middle))),
        error_(error),
        reach_{rounded_up(part.speed * part.half + part.pad + 2 * error),
               std::numeric_limits<float>::infinity()},
        most_(most),
        out_(out) {}

  /// Returns whether all pairs fit.
  [[nodiscard]] bool fits() const noexcept { return fits_; }
  [[nodiscard]] float reach() const noexcept {
    return rounded_up(part_.pad + double{context_.step.pose.error});
  }
  bool visit(const ClusterPairs& clusters) noexcept {
    const LaneNodes& pairs = clusters.pairs;
    const NodeBlock& moving = moving_clusters_.bounds(0)[clusters.moving / kClusterWidth];
    for (std::size_t k = 0; k < pairs.count; ++k) {
      const std::uint32_t lane = pairs.lane(k), node = pairs.node(k);
      const NodeBlock& fixed = context_.step.fixed_nodes.blocks[node / kClusterWidth];
      const float radii = moving.radius[lane] + fixed.radius[node % kClusterWidth];
      work_ += reach_.triangles > radii ? kFarWork : 1;
    }
    fits_ = work_ <= most_;
    if (!fits_ || pairs.count == 0) return fits_;
    out_.groups.push_back({clusters.moving, out_.codes.size(), pairs.count});
    out_.codes.insert(out_.codes.end(), pairs.codes, pairs.codes + pairs.count);
    return true;
  }
  /// Compares the triangles. Returns false if there are too many pairs, or if the deadline came
  /// before the end.
  bool finish() noexcept {
    TurnedBlock turned;
    for (const SweptList::Group& group : out_.groups) {
      context_.kernels.turn_nodes(moving_clusters_.bounds(0)[group.moving / kClusterWidth],
                                  context_.step.pose, turned);
      const ClusterPairs clusters{
          turned, group.moving, {out_.codes.data() + group.first, group.count}};
      const bool goes_on = in_turns(
          clusters,
          [&](const ClusterPairs& rest) {
            Reach same = reach_;
            return context_.kernels.near_clusters(context_.step, rest, same, context_.batch,
                                                  context_.found);
          },
          [&] { return take_found(); });
      if (!goes_on) return false;
    }
    return decide();
  }

 private:
  // Returns false if there are too many pairs, or if the deadline came before the end.
  bool take_found() noexcept {
    FoundTriangles& found = context_.found;
    for (std::size_t k = 0; k < found.open.count; ++k) {
      if (context_.is_late(k)) return false;
      if (add(found.open[k], found.squares[k] > 0) && count_ == TriangleOctet::kSize && !decide()) {
        return false;
      }
    }
    found.open.count = 0;
    return true;
  }
  // Adds a pair to the octet, unless the boxes round their ways or some axes part the triangles.
  bool add(TriangleIds ids, bool apart) noexcept {
    const TriangleCorners a = corners_of(context_.meshes.fixed, ids.fixed);
    const TriangleCorners b = context_.meshes.moving[ids.moving];
    double fastest = 0;  // its square
    Eigen::Vector3d low = b[0], high = b[0];
    for (const Eigen::Vector3d& corner : b) {
      const Eigen::Vector3d velocity = part_.velocity(corner);
      fastest = std::max(fastest, square_in_order(velocity));
      for (Eigen::Index i = 0; i < 3; ++i) {
        const double way = std::abs(velocity[i]) * part_.half;
        low[i] = std::min(low[i], corner[i] - way);
        high[i] = std::max(high[i], corner[i] + way);
      }
    }
    fastest = std::sqrt(fastest);
    const double more = part_.bend(fastest) + part_.pad;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const auto [least, greatest] = std::minmax({a[0][i], a[1][i], a[2][i]});
      if (low[i] > greatest + more || high[i] < least - more) return false;
    }
    const double length = 2 * part_.half;
    const TriangleCorners first = at_start_[ids.moving];
    const double after = MovingPair(a, first, part_).quick_free_time(length);
    if (after >= length) return false;
    set_lane(octet_.fixed, count_, context_.meshes.fixed, ids.fixed);
    set_lane(octet_.moving, count_, moving_, ids.moving);
    pairs_[count_] = {after, ids};
    apart_[count_] = apart;
    enough_[count_++] = fastest * part_.half + part_.pad + error_;
    return true;
  }
  // Keeps the pairs of the octet that are near enough in the middle of the part. Returns false if
  // there are too many.
  bool decide() noexcept {
    if (count_ == 0) return true;
    for (std::size_t lane = count_; lane < TriangleOctet::kSize; ++lane) {
      set_lane(octet_.fixed, lane, context_.meshes.fixed, pairs_[0].ids.fixed);
      set_lane(octet_.moving, lane, moving_, pairs_[0].ids.moving);
    }
    OctetDistances distances;
    context_.kernels.closest_octet(octet_, plain_, distances);
    for (std::size_t lane = 0; lane < count_; ++lane) {
      const bool far = std::sqrt(distances.square[lane]) > enough_[lane];
      // Of triangles that intersect, the octet measured the borders.
      if (far && (apart_[lane] || !context_.meshes.meet(pairs_[lane].ids))) continue;
      fits_ = out_.pairs.size() < most_;
      if (!fits_) return false;
      out_.pairs.push_back(pairs_[lane]);
    }
    count_ = 0;
    return true;
  }

  VisitorContext context_;
  const TriangleMesh& moving_;
  const TriangleClusters& moving_clusters_;
  const ScrewPart& part_;
  MovedTriangles at_start_;
  PlainMove plain_;
  double error_;
  Reach reach_;
  std::size_t most_;
  SweptList& out_;
  TriangleOctet octet_;
  SweptPair pairs_[TriangleOctet::kSize];
  bool apart_[TriangleOctet::kSize];
  double enough_[TriangleOctet::kSize];
  std::size_t count_ = 0;
  std::size_t work_ = 0;  // of the pairs of clusters
  bool fits_ = true;
};

}  // namespace ist
