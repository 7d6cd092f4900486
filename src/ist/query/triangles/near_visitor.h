#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "ist/base/float_rounding.h"
#include "ist/query/results.h"
#include "ist/query/triangles/triangle_distance.h"
#include "ist/query/triangles/triangle_visitors.h"
#include "simd/triangles/closest.h"
#include "simd/triangles/cluster_step.h"

namespace ist {

/// Near pairs for a caller's span. A span that is too short keeps the nearest ones.
class NearList {
 public:
  void begin(std::span<NearPair> out) noexcept {
    out_ = out;
    count_ = 0;
  }
  void add(const NearPair& pair) noexcept {
    const std::uint64_t at = count_++;
    if (at < out_.size()) {
      out_[static_cast<std::size_t>(at)] = pair;
      if (count_ == out_.size()) std::make_heap(out_.begin(), out_.end(), before);
    } else if (!out_.empty() && before(pair, out_.front())) {
      std::pop_heap(out_.begin(), out_.end(), before);
      out_.back() = pair;
      std::push_heap(out_.begin(), out_.end(), before);
    }
  }
  /// Sorts the pairs in the span by distance, fixed and moving triangle.
  void finish() noexcept {
    const std::span<NearPair> kept =
        out_.first(static_cast<std::size_t>(std::min<std::uint64_t>(count_, out_.size())));
    std::sort(kept.begin(), kept.end(), before);
  }
  /// Returns the number of pairs that were added, in the span or not.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }

 private:
  struct Before {
    bool operator()(const NearPair& a, const NearPair& b) const noexcept {
      return a.distance < b.distance || (a.distance == b.distance && a.triangles < b.triangles);
    }
  };
  static constexpr Before before{};

  std::span<NearPair> out_;
  std::uint64_t count_ = 0;
};

/// Copies the corners of a triangle to a lane of an octet.
inline void set_lane(double (&corners)[3][3][TriangleOctet::kSize], std::size_t lane,
                     const TriangleMesh& mesh, std::uint32_t triangle) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d& corner = mesh.vertices[mesh.triangles[triangle][k]];
    for (std::size_t i = 0; i < 3; ++i) {
      corners[k][i][lane] = corner[static_cast<Eigen::Index>(i)];
    }
  }
}

/// Measures pairs of triangles in double, and lists those that are near: the decision of
/// Query::near_pairs, which no traversal changes.
class NearDecision {
 public:
  /// @param enough  pairs that are farther apart are left out
  NearDecision(const VisitorContext& context, const TriangleMesh& moving, const PlainMove& move,
               double enough, NearList& list) noexcept
      : context_(context), moving_(moving), move_(move), enough_(enough), list_(list) {}

  [[nodiscard]] double enough() const noexcept { return enough_; }
  [[nodiscard]] const VisitorContext& context() const noexcept { return context_; }
  [[nodiscard]] const PlainMove& move() const noexcept { return move_; }

  /// Takes up to eight pairs whose corners an octet has. Bit k of `apart` says that pair k surely
  /// does not intersect. Calls `leave_out(lane, closest)` for each
  /// pair that is farther apart; closest() returns it.
  template <class LeaveOut>
  void take(const TriangleOctet& octet, std::span<const TriangleIds> ids, std::uint32_t apart,
            LeaveOut leave_out) noexcept {
    OctetDistances distances;
    context_.kernels.closest_octet(octet, move_, distances);
    for (std::size_t lane = 0; lane < ids.size(); ++lane) {
      const bool parted = (apart >> lane & 1U) != 0;
      const auto closest = [&] {
        return closest_points(corners_of(context_.meshes.fixed, ids[lane].fixed),
                              context_.meshes.moving[ids[lane].moving],
                              {ids[lane].fixed, ids[lane].moving},
                              static_cast<std::size_t>(distances.parts[lane]));
      };
      if (parted && std::sqrt(distances.square[lane]) > enough_) {
        leave_out(lane, closest);
        continue;
      }
      const NearPair pair = closest();
      if (pair.distance <= enough_) {
        list_.add(pair);
      } else {
        leave_out(lane, [&] { return pair; });
      }
    }
  }
  /// Takes pairs by their indices. `squares` are lower bounds of the squares of their distances.
  /// Returns false if the deadline came before the end.
  bool take(const TriangleList& found, const float* squares) noexcept {
    constexpr std::size_t kSize = TriangleOctet::kSize;
    for (std::size_t first = 0; first < found.count; first += kSize) {
      if (context_.budget.is_past()) return false;
      const std::size_t count = std::min(kSize, found.count - first);
      TriangleOctet octet;
      TriangleIds ids[kSize];
      std::uint32_t apart = 0;
      for (std::size_t lane = 0; lane < kSize; ++lane) {
        ids[lane] = found[first + std::min(lane, count - 1)];
        if (squares[first + std::min(lane, count - 1)] > 0) apart |= std::uint32_t{1} << lane;
        set_lane(octet.fixed, lane, context_.meshes.fixed, ids[lane].fixed);
        set_lane(octet.moving, lane, moving_, ids[lane].moving);
      }
      take(octet, {ids, count}, apart, [](std::size_t, const auto&) {});
    }
    return true;
  }

 private:
  VisitorContext context_;
  const TriangleMesh& moving_;
  PlainMove move_;
  double enough_;
  NearList& list_;
};

/// Lists all pairs that are near: a visitor of a ClusterSearch.
class NearbyPairs {
 public:
  static constexpr bool kMostFirst = false, kMeasuresRest = false;

  explicit NearbyPairs(const NearDecision& decision) noexcept : decision_(decision) {}

  [[nodiscard]] float reach() const noexcept {
    return rounded_up(decision_.enough() + double{context().step.pose.error});
  }
  bool visit(const ClusterPairs& clusters) noexcept {
    // An infinite margin keeps the reach as it is.
    Reach reaches{rounded_up(decision_.enough()), std::numeric_limits<float>::infinity()};
    return in_turns(
        clusters,
        [&](const ClusterPairs& rest) {
          return context().kernels.near_clusters(context().step, rest, reaches, context().batch,
                                                 context().found);
        },
        [&] { return context().found.has_room() || finish(); });
  }
  /// Measures the pairs that are left. Returns false if the deadline came before.
  bool finish() noexcept {
    FoundTriangles& found = context().found;
    const bool in_time = decision_.take(found.open, found.squares);
    found.open.count = 0;
    return in_time;
  }

 private:
  [[nodiscard]] const VisitorContext& context() const noexcept { return decision_.context(); }

  NearDecision decision_;
};

}  // namespace ist
