#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "ist/query/relative_pose.h"
#include "ist/query/triangles/cluster_walk.h"
#include "ist/query/triangles/near_visitor.h"

namespace ist {

/// Carries near pairs from one pose to the next. A list holds all pairs within a reach at its
/// centre. While the moving body stays within the list's slack of that centre, no other pair can be
/// near, so only the listed pairs are measured again. A pair that was measured and is not near gets
/// a plane between its triangles. It is not measured again while the plane has room enough. The
/// next list is filled in slices, before the last one is used up, for a centre ahead of the body. A
/// tick pays for a slice.
///
///              want            advance            find
///     kEmpty ---------> kFilling -------> kReady ----------> kKept
///
/// If a body is too fast for that, fill() makes a list at once. It costs little more than a search,
/// and the next ticks use it.
///
/// A list becomes kEmpty again if it is used up, if it has no room, or if the body went another
/// way. The answer is that of a fresh search, bit by bit.
class NearCache {
 public:
  /// Reserves all memory: two lists of so many pairs, 195 bytes each, and a ClusterWalk.
  NearCache(const TriangleMesh& fixed, const TriangleMesh& moving,
            const TriangleClusters& fixed_clusters, const TriangleClusters& moving_clusters,
            const ClusterKernels& kernels, std::size_t pairs);

  /// What a list needs to hold at a pose.
  struct Need {
    const Eigen::Isometry3d& pose;
    double enough;  ///< pairs that are farther apart are not asked for
    double error;   ///< of a distance in double
  };

  /// Begins a tick. Returns whether a list holds all pairs of the pose.
  [[nodiscard]] bool find(const Need& need) noexcept;
  /// Measures the pairs of the list that find() found. Returns false if the deadline came before
  /// the end. `measured` counts the pairs.
  bool answer(NearDecision& decision, std::uint64_t& measured) noexcept;
  /// Ends a tick: goes on with the next list. `pose_of(centre)` returns a ClusterPose. `tests`
  /// counts those of this tick's own search, 0 if a list answered.
  template <class PoseOf>
  void prepare(const Need& need, std::uint64_t tests, const Budget& budget, FoundMemory& memory,
               PoseOf pose_of) noexcept {
    if (want(need, tests)) {
      const ClusterPose pose = pose_of(to_isometry(next().centre));
      walk_.begin(pose, rounded_up(next().reach + double{pose.error}));
    }
    advance(slice_, budget, memory);
  }
  /// Fills a list at once, after find() found none. Returns whether it has all pairs of the pose:
  /// not if the list would be used up soon, has no room, or the deadline came. `tests` counts its
  /// tests.
  template <class PoseOf>
  [[nodiscard]] bool fill(const Need& need, const Budget& budget, FoundMemory& memory,
                          std::uint64_t& tests, PoseOf pose_of) noexcept {
    // A list that is filled in slices goes on.
    const bool goes_on = next().state == State::kFilling && holds(next(), poses_[0], need);
    const std::uint64_t before = goes_on ? walk_.tests() : 0;
    if (!goes_on) {
      if (!begin_here(need)) return false;
      const ClusterPose pose = pose_of(to_isometry(next().centre));
      walk_.begin(pose, rounded_up(next().reach + double{pose.error}));
    }
    advance(std::numeric_limits<std::uint64_t>::max(), budget, memory);
    tests += walk_.tests() - before;
    if (next().state != State::kReady) {
      next().state = State::kEmpty;
      return false;
    }
    use_next(need);
    return true;
  }
  void forget() noexcept;

  /// Returns the bytes that a cache with room for so many pairs reserves.
  [[nodiscard]] static std::size_t bytes_for(const TriangleClusters& fixed,
                                             const TriangleClusters& moving,
                                             std::size_t pairs) noexcept;

 private:
  enum class State : std::uint8_t { kEmpty, kFilling, kReady, kKept };
  // Pairs that are about as far apart at the list's centre.
  struct Block {
    TriangleOctet corners;
    TriangleIds ids[TriangleOctet::kSize];
    double distance[TriangleOctet::kSize];  // lower bounds at the centre
    // Planes between the triangles: their normals, and how high the fixed triangles reach. 0 before
    // a pair was measured and left out.
    double normal[3][TriangleOctet::kSize], top[TriangleOctet::kSize];
    double least;
    std::size_t count;
  };
  // The classes of distance, from the nearest: a block has pairs of one.
  static constexpr std::size_t kClasses = 8;
  struct List {
    State state = State::kEmpty;
    std::vector<Block> blocks;
    std::size_t used = 0;
    std::array<std::size_t, kClasses> open{};  // a block of each class that has room, and 1; or 0
    RelativePose centre{};                     // of the meshes
    double enough = 0, reach = 0;  // it was made for pairs within `enough`, and has those in reach
    std::uint64_t pairs = 0;
  };

  [[nodiscard]] List& kept() noexcept { return lists_[kept_]; }
  [[nodiscard]] List& next() noexcept { return lists_[1 - kept_]; }
  [[nodiscard]] double way(const RelativePose& from, const RelativePose& to) const noexcept {
    return longest_way(box_, from, to);
  }
  // Returns whether a list has all pairs that are near at a pose; `spare` is left of its slack
  // then.
  [[nodiscard]] bool holds(const List& list, const RelativePose& pose, const Need& need,
                           double spare = 0) const noexcept;
  [[nodiscard]] RelativePose ahead(double ticks) const noexcept;
  [[nodiscard]] bool want(const Need& need, std::uint64_t tests) noexcept;
  [[nodiscard]] double slack_of(const Need& need, double margins, double ticks) const noexcept;
  void begin(const Need& need, double slack, double ticks) noexcept;
  [[nodiscard]] bool begin_here(const Need& need) noexcept;
  void use_next(const Need& need) noexcept;
  void advance(std::uint64_t most, const Budget& budget, FoundMemory& memory) noexcept;
  // Returns, as bits, the lanes whose planes have more room than `least` between the triangles.
  [[nodiscard]] static std::uint32_t parted(const Block& block, const PlainMove& move,
                                            double least) noexcept;
  static void set_plane(Block& block, std::size_t lane, const NearPair& closest) noexcept;
  [[nodiscard]] bool take(FoundTriangles& found) noexcept;
  [[nodiscard]] bool add(TriangleIds ids, double distance) noexcept;
  void set_width() noexcept;

  const TriangleMesh &fixed_, &moving_;
  const ClusterKernels& kernels_;
  Eigen::AlignedBox3d box_;  // of the moving body
  ClusterWalk walk_;
  std::array<List, 2> lists_;
  std::size_t kept_ = 0;
  // The last poses, the newest first.
  static constexpr std::size_t kTicks = 5;
  std::array<RelativePose, kTicks> poses_{};
  std::size_t ticks_ = 0;
  double speed_ = 0, drift_ = 0;   // of a tick: the most of the last, and in the mean
  double motion_ = 0, error_ = 0;  // since the centre of the list that find() found
  double width_ = 1;              // of the next list: a factor of the slack that the speed asks for
  std::uint64_t list_tests_ = 0;  // of the last list
  std::uint64_t slice_ = 0, pause_ = 0;
};

}  // namespace ist
