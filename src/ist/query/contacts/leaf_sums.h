#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/base/ordered_vector.h"
#include "ist/tree/linear_octree.h"
#include "simd/contact_step.h"

namespace ist {

/// The sums over all leaf pairs of one fixed node, in the units of ContactTerms. Two of them add up
/// to that of a common ancestor.
struct LeafSum {
  std::uint32_t node;               ///< by index, but a leaf by its address, 8 · parent + slot
  std::array<float, 3> first;       ///< w n of the first pair, for a sum that has no direction
  double weight, depth;             ///< Σ w and Σ w x
  Eigen::Vector3d position, force;  ///< Σ w p and Σ w n

  void add(const LeafSum& other) noexcept {
    weight += other.weight;
    depth += other.depth;
    add_to(position, other.position);
    add_to(force, other.force);
  }
};

/// Adds up leaf pairs by their fixed leaf, in bounded memory. Pairs come in the order of the fixed
/// leaves, so the sums are a list that only grows. When there are more leaves than fit, sums are
/// merged by their parents in the octree, and later leaves are added at that level: nothing is
/// dropped. The nodes follow from the pairs alone, in whatever batches they come.
class LeafSums final : public ContactTermsStream {
 public:
  /// Reserves memory for `most` nodes, at least one: 80 bytes each.
  LeafSums(const LinearOctree& octree, std::size_t most);
  /// A list that cannot merge: it leaves out what does not fit, and is_short() says so.
  explicit LeafSums(std::size_t most) : nodes_(most), room_(most) {}

  /// Takes the leaves of another octree from now on, at most `most` nodes. Allocates nothing.
  /// Precondition: the list has so many, or one for each leaf.
  void bind(const LinearOctree& octree, std::size_t most) noexcept;

  void clear() noexcept;
  /// Adds leaf pairs. Cost: 4 ns each.
  void take(const ContactTerms& terms) noexcept override;
  /// Adds the sums of leaves that another list took, after all that this one took.
  void append(std::span<const LeafSum> leaves) noexcept;
  /// Ends the list: the last leaf is a node, too.
  void close() noexcept;

  /// Returns nodes that are complete, whatever another thread appends behind them.
  [[nodiscard]] std::span<const LeafSum> part(std::size_t begin, std::size_t count) const noexcept {
    return {nodes_.data() + begin, count};
  }
  /// Returns the nodes, in the order of the fixed tree; without the last one until close().
  [[nodiscard]] std::span<LeafSum> nodes() noexcept { return {nodes_.data(), count_}; }
  /// Returns the level of the nodes: 0 as long as they are leaves.
  [[nodiscard]] int level() const noexcept { return level_; }
  /// Returns whether something was left out.
  [[nodiscard]] bool is_short() const noexcept { return short_; }

  /// Merges the nodes by their parents, one level up. Precondition: level() < depth of the octree.
  void coarsen() noexcept;
  /// Removes the nodes at a few places.
  void take_out(std::span<const std::size_t> places) noexcept;
  /// Keeps the first `count` nodes; then nothing is left out.
  void shorten(std::size_t count) noexcept;

  /// Returns the bytes that a list of at most `most` nodes of an octree reserves.
  [[nodiscard]] static std::size_t bytes_for(const LinearOctree& octree, std::size_t most) noexcept;

 private:
  void push(const LeafSum& leaf) noexcept;
  [[nodiscard]] std::uint32_t parent_of(int level, std::uint32_t node) noexcept;

  static constexpr std::size_t kMostLevels = 32;
  const LinearOctree* octree_ = nullptr;
  std::vector<LeafSum> nodes_;
  std::size_t room_;  // of them
  std::size_t count_ = 0;
  int level_ = 0;
  bool open_ = false, short_ = false;
  LeafSum last_;                                      // the leaf that may go on, if open_
  std::array<std::uint32_t, kMostLevels> parents_{};  // the last one found, by its children's level
};

}  // namespace ist
