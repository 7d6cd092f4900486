#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "ist/base/float_rounding.h"
#include "ist/query/triangles/triangle_distance.h"
#include "ist/query/triangles/triangle_visitors.h"

namespace ist {

/// Finds the nearest pair, or one that is farther by at most the tolerance. Only nodes are left out
/// for the tolerance's sake; of the triangles that are compared the nearest is found, so that the
/// answer does not depend on how the kernels decide.
class NearestPair {
 public:
  static constexpr bool kMostFirst = false, kMeasuresRest = true;

  NearestPair(const VisitorContext& context, double tolerance, double longest_edge,
              double nearest) noexcept
      : context_(context),
        tolerance_(tolerance > 0 ? tolerance : 0),  // a NaN too
        longest_edge_(longest_edge),
        nearest_(nearest) {}

  [[nodiscard]] double distance() const noexcept { return nearest_; }
  /// Returns the pair that has the distance, the first by its indices, if any was measured.
  [[nodiscard]] const std::optional<TriangleIds>& ids() const noexcept { return ids_; }
  [[nodiscard]] double error() const noexcept {
    return nearest_ > 0 ? kTriangleDistanceError * (longest_edge_ + nearest_) : 0;
  }
  /// Returns the distance from which on nothing was looked for: so that the interval is no wider
  /// than the tolerance, for all rounding of its ends.
  [[nodiscard]] double within() const noexcept {
    return std::max(0.0, nearest_ * (1 + 0x1p-49) + 2 * error() - tolerance_);
  }
  [[nodiscard]] float reach() const noexcept {
    return rounded_up(within() + double{context_.step.pose.error});
  }
  bool visit(const ClusterPairs& clusters) noexcept {
    const float margin = rounded_up(2 * error() + double{context_.step.pose.error});
    Reach reaches{rounded_up(nearest_) + margin, margin};
    return in_turns(
        clusters,
        [&](const ClusterPairs& rest) {
          return context_.kernels.near_clusters(context_.step, rest, reaches, context_.batch,
                                                context_.found);
        },
        [&] {
          const bool in_time = measure_found();
          context_.found.open.count = 0;
          return in_time && nearest_ > 0;
        });
  }
  void measure(TriangleIds ids) noexcept {
    const TriangleCorners a = corners_of(context_.meshes.fixed, ids.fixed);
    const TriangleCorners b = context_.meshes.moving[ids.moving];
    const double boxes = box_distance_squared(a, b);
    const double enough = nearest_ + 2 * error();
    if (boxes > enough * enough || surely_farther(a, b, enough)) return;
    const double distance =
        boxes == 0 && triangles_meet(a, b) ? 0 : std::sqrt(distance_squared(a, b));
    if (distance > nearest_ || (distance == nearest_ && ids_ && !(ids < *ids_))) return;
    nearest_ = distance;
    ids_ = ids;
  }

 private:
  // First the pair that may be the nearest, so that few others may still be nearer. Returns false
  // where the deadline came before the end.
  bool measure_found() noexcept {
    const FoundTriangles& found = context_.found;
    const std::size_t count = found.open.count;
    const auto first = static_cast<std::size_t>(
        std::min_element(found.squares, found.squares + count) - found.squares);
    if (count > 0) measure(found.open[first]);
    std::size_t measured = 0;
    for (std::size_t k = 0; k < count && nearest_ > 0; ++k) {
      const double enough = nearest_ + 2 * error() + double{context_.step.pose.error};
      if (k == first || double{found.squares[k]} > enough * enough) continue;
      if (context_.is_late(measured++)) return false;
      measure(found.open[k]);
    }
    return true;
  }

  VisitorContext context_;
  double tolerance_, longest_edge_, nearest_;
  std::optional<TriangleIds> ids_;
};

}  // namespace ist
