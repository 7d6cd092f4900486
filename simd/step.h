#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "ist/tree/bound_blocks.h"
#include "ist/tree/linear_octree.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// The view of one tree that a step of the breadth-first traversal reads: the nodes of one level,
/// here called parents, and their children's blocks. Pointers into a tree; plain floats, so that
/// vector code and its scalar twin see the same bits.
struct SearchSide {
  const OctreeNode* nodes;          ///< the parents, and one more as an end
  const BallBlock* balls;           ///< by parent; null where the octree implies the spheres
  const SlabBlock* slabs;           ///< by parent; null where the policy has none
  const std::uint8_t* masks;        ///< occupancy masks of the parents
  const std::uint8_t* child_masks;  ///< occupancy masks of the children; null for circumspheres

  float voxel_size;     ///< mesh units to a voxel, the unit of node centres
  float ball_unit;      ///< mesh units to a unit of BallBlock
  float slab_unit;      ///< mesh units to a unit of SlabBlock
  float octant_offset;  ///< from a parent's centre to its children's along an axis, mesh units
  float half_edge;      ///< of a child's cube, mesh units

  /// Whether the step tests the children of the frontier's nodes, or these nodes themselves. The id
  /// of a node that descends is its index; of one that does not, its address, 8 · parent + slot.
  bool descends;
  bool emits_slots;  ///< whether the ids of survivors are addresses rather than indices
};

/// One step of the traversal: from the overlapping pairs of nodes of one level to those of the
/// next.
struct SearchStep {
  SearchSide fixed, moving;
};

/// The motion from the fixed tree's frame to the moving one's, x = rotation · y + translation, and
/// the pads of the tests, mesh units. The same for all steps of a query.
struct SearchPose {
  float rotation[9];  ///< row by row
  float translation[3];
  float ball_pad, slab_pad;
};

/// The moving nodes that overlap one fixed node: from the previous group's end to `end`.
struct SearchGroup {
  std::uint32_t fixed, end;
};

/// The pairs alive at one level, or as many as fit: groups in the order of their fixed nodes, and
/// in a group the moving nodes in order (a bounding volume traversal front). The memory is the
/// owner's.
struct Frontier {
  SearchGroup* groups;
  std::uint32_t* moving;
  std::size_t group_count, moving_count;
  std::size_t capacity;  ///< of both arrays; behind it is room for kFrontierSpare more
};

/// Kernels store whole vectors, so they may write, and read, this far behind a frontier's capacity.
inline constexpr std::size_t kFrontierSpare = 64;

/// Returns whether a frontier has room for `rows` groups with `moving` nodes among them. An empty
/// frontier always has room for one row.
[[nodiscard]] inline bool has_room(const Frontier& frontier, std::size_t rows,
                                   std::size_t moving) noexcept {
  return (frontier.moving_count == 0 && rows == 1) ||
         (frontier.moving_count + moving <= frontier.capacity &&
          frontier.group_count + rows <= frontier.capacity);
}

/// Makes a group of the moving nodes appended since there were `before`, if any.
inline void end_row(Frontier& frontier, std::uint32_t fixed, std::size_t before) noexcept {
  frontier.groups[frontier.group_count] = {fixed,
                                           static_cast<std::uint32_t>(frontier.moving_count)};
  frontier.group_count += frontier.moving_count != before ? 1 : 0;
}

/// The position in a frontier at which a step continues: a group, a child of its fixed node, and
/// where rows may be cut one of its moving nodes.
struct SearchCursor {
  std::size_t group = 0;
  std::uint32_t row = 0;
  std::uint32_t moving = 0;  ///< counted from the group's first node
};

template <std::size_t N>
struct BoundLanes;
struct FixedRows;
struct SearchScratch;

/// Tests the pairs of `in` from `cursor` on, and appends the overlapping ones to `out`, until all
/// are tested or `out` has no room for another row (all moving nodes that overlap one fixed node).
/// An empty `out` must have room for one row: all moving nodes of that level.
///
/// @return the number of pairs tested
using AdvanceFunction = std::uint64_t (*)(const SearchStep& step, const SearchPose& pose,
                                          const Frontier& in, SearchCursor& cursor, Frontier& out,
                                          SearchScratch& scratch);

/// Advances without vectors; it specifies the vector kernels, which test the same pairs in the same
/// order by the same float operations. Cost: 10 to 20 ns a test.
std::uint64_t advance_scalar(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                             SearchCursor& cursor, Frontier& out, SearchScratch& scratch);

/// Writes the pairs of a frontier of leaves. `out` must have room for all of them and
/// kLeafPairSpare more.
using WriteLeafPairsFunction = void (*)(const Frontier& leaves, LeafPair* out);
inline constexpr std::size_t kLeafPairSpare = 8;

/// Writes leaf pairs without vectors. Cost: 1 ns a leaf pair.
void write_leaf_pairs_scalar(const Frontier& leaves, LeafPair* out);

/// The bounds of the distance between two bodies that tests give, mesh units, pads included.
struct DistanceBounds {
  static constexpr float kNone = std::numeric_limits<float>::infinity();
  float min_pruned = kNone;       ///< least distance of two bounds that do not overlap
  float min_overlapping = kNone;  ///< least signed distance of two that do: negative
  float upper = kNone;            ///< least of the largest distances of points of two balls
};

/// The parts of a step, each callable alone, for tests and benchmarks.
struct StepParts {
  /// Decodes a frontier's `node` into lanes from `at` on; see ist::decode.
  std::uint32_t (*decode)(const SearchSide& side, std::uint32_t node, BoundLanes<1024>& out,
                          std::size_t at);
  /// Turns all eight rows; see ist::turn.
  void (*turn)(const SearchPose& pose, bool slabs, const BoundLanes<8>& fixed, FixedRows& rows);
  /// Tests one row against the lanes [begin, end), `begin` a multiple of 16; see ist::overlap.
  /// Writes the ids of the overlapping lanes, with room for 16 more behind them, and returns their
  /// number.
  std::size_t (*overlap_row)(const FixedRows& rows, std::size_t row, const BoundLanes<1024>& moving,
                             std::size_t begin, std::size_t end, bool slabs, std::uint32_t* out);
  /// Tests like overlap_row and bounds the distance by every pair; see ist::measure.
  std::size_t (*measure_row)(const FixedRows& rows, std::size_t row, const BoundLanes<1024>& moving,
                             std::size_t begin, std::size_t end, bool slabs, std::uint32_t* out,
                             DistanceBounds& measure);
};

}  // namespace ist
