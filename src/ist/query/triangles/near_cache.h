#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "ist/query/relative_pose.h"
#include "ist/query/triangles/cluster_walk.h"
#include "ist/query/triangles/near_visitor.h"

namespace ist {

/// Carries near pairs from one pose to the next. A list holds all pairs within a reach at its
/// centre. While the moving body stays within the list's slack of that centre, no other pair can be
/// near, so only the listed pairs are measured again. The next list is filled in slices, before the
/// last one is used up, for a centre ahead of the body. No tick pays for a whole list.
///
///              want            advance            find
///     kEmpty ---------> kFilling -------> kReady ----------> kKept
///
/// A list becomes kEmpty again if it is used up, if it has no room, or if the body went another
/// way. The answer is that of a fresh search, bit by bit.
class NearCache {
 public:
  /// Reserves all memory: two lists of so many pairs, 168 bytes each, and a ClusterWalk.
  NearCache(const TriangleMesh& fixed, const TriangleMesh& moving,
            const TriangleClusters& fixed_clusters, const TriangleClusters& moving_clusters,
            const ClusterKernels& kernels, std::size_t pairs);

  /// What a list needs to hold at a pose.
  struct Need {
    const Eigen::Isometry3d& pose;
    double enough;  ///< pairs that are farther apart are not asked for
    double error;   ///< of a distance in double
  };

  /// Begins a tick. Returns whether a list holds all pairs of the pose, and measuring them costs no
  /// more than a fresh search.
  [[nodiscard]] bool find(const Need& need) noexcept;
  /// Measures the pairs of the list that find() found. Returns false if the deadline came before
  /// the end. `measured` counts the pairs.
  bool answer(NearDecision& decision, std::uint64_t& measured) noexcept;
  /// The tests that take as long as to find a pair and to measure it, or to list it.
  static constexpr std::uint64_t kPairTests = 48;
  /// Ends a tick: goes on with the next list. `pose_of(centre)` returns a ClusterPose. `tests`
  /// counts those of this tick's own search, and kPairTests for each pair that it found; empty
  /// if a list answered.
  template <class PoseOf>
  void prepare(const Need& need, const std::optional<std::uint64_t>& tests, const Budget& budget,
               FoundMemory& memory, PoseOf pose_of) noexcept {
    note(tests);
    if (want(need)) {
      const ClusterPose pose = pose_of(to_isometry(next().centre));
      walk_.begin(pose, rounded_up(next().reach + double{pose.error}));
    }
    advance(budget, memory);
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
  // Returns whether all pairs of a block are farther apart now than `enough`. The distance of a
  // pair is less than at the centre by no more than the motion.
  [[nodiscard]] bool is_far(const Block& block, double enough) const noexcept {
    return block.least - nearer() > enough;
  }
  [[nodiscard]] double nearer() const noexcept { return motion_ + 4 * error_; }
  // Returns the pairs of the kept list that may be within a distance.
  [[nodiscard]] std::uint64_t within(double enough) noexcept;
  void end_chain() noexcept;
  void note(const std::optional<std::uint64_t>& tests) noexcept;
  [[nodiscard]] bool want(const Need& need) noexcept;
  [[nodiscard]] std::uint64_t done() const noexcept;
  [[nodiscard]] double allowed() const noexcept;
  void advance(const Budget& budget, FoundMemory& memory) noexcept;
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
  double slice_ = 0;              // tests
  double slack_ = 0;              // of the last list that was begun
  double until_ = 0;              // ticks from now to the tick that the next list is made for
  // Tests, and what takes as long: about those of a fresh search, and of this tick without its
  // slice.
  std::uint64_t fresh_ = 0, spent_ = 0;
  double saved_ = 0;  // of this chain of lists, against fresh searches; what takes as long as tests
  std::uint64_t pause_ = 0, last_pause_ = 0;  // ticks to the next chain, and between the last two
};

}  // namespace ist
