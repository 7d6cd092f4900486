#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "ist/tree/bound_blocks.h"
#include "ist/tree/linear_octree.h"
#include "ist/tree/sphere_tree.h"
#include "ist/voxel/packed_normal.h"

namespace ist {

/// One level's implicit balls, as a step decodes them: lengths in mesh units, by the codes of the
/// lookup table's words.
struct alignas(32) ImplicitLevel {
  float offset[8];            ///< from a cube's centre along an axis, by the code of a coordinate
  float radius[8];            ///< by radius code; the last three are 0
  const std::uint8_t* masks;  ///< occupancy masks; null where all balls are circumspheres
};

/// The view of one tree that a step of the breadth-first traversal reads: the nodes of one level,
/// here called parents, and their children's blocks. Pointers into a tree; plain floats, so that
/// vector code and its scalar twin see the same bits.
struct SearchSide {
  const OctreeNode* nodes;        ///< the parents, and one more as an end
  const BallBlock* balls;         ///< by parent; null where the octree implies the spheres
  const SlabBlock* slabs;         ///< by parent; null where the policy has none
  const std::uint8_t* masks;      ///< occupancy masks of the parents
  const ImplicitLevel* implicit;  ///< of the children; null where there are blocks

  float voxel_size;     ///< mesh units to a voxel, the unit of node centres
  float ball_unit;      ///< mesh units to a unit of BallBlock
  float slab_unit;      ///< mesh units to a unit of SlabBlock
  float octant_offset;  ///< from a parent's centre to its children's along an axis, mesh units

  /// Whether the step tests the children of the frontier's nodes, or these nodes themselves. The id
  /// of a node that descends is its index; of one that does not, its address, 8 · parent + slot.
  bool descends;
  bool emits_slots;  ///< whether the ids of survivors are addresses rather than indices
};
static_assert(sizeof(SearchSide) <= 64, "a kernel's copy of it is one vector; more costs a tenth");

/// One step of the traversal: from the overlapping pairs of nodes of one level to those of the
/// next.
struct SearchStep {
  SearchSide fixed, moving;
  bool last;           ///< no step follows: rows may be cut
  bool leaves;         ///< whether both sides of the pairs that it tests are leaves
  float radius_limit;  ///< exceeds every sum of two radii, mesh units; without pads
  /// The normals of the leaves, by index.
  const PackedNormal *fixed_normals = nullptr, *moving_normals = nullptr;
};

/// The pads of one kind of step, mesh units: of the sum of radii, and of the fixed and of the
/// moving nodes' slabs.
struct Pads {
  float ball, slab_fixed, slab_moving;
};

/// The motion from the fixed tree's frame to the moving one's, x = rotation · y + translation, and
/// the pads of the tests of leaves and of all others. The same for all steps of a query.
struct SearchPose {
  float rotation[9];  ///< row by row
  float translation[3];
  Pads leaf, inner;
};

[[nodiscard]] inline const Pads& pads_of(const SearchPose& pose, const SearchStep& step) noexcept {
  return step.leaves ? pose.leaf : pose.inner;
}

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

/// Continues the row of a fixed node that the last call left unfinished, or begins it. Returns the
/// place at which end_row() begins its group.
[[nodiscard]] inline std::size_t begin_row(Frontier& frontier, std::uint32_t fixed) noexcept {
  if (frontier.group_count == 0 || frontier.groups[frontier.group_count - 1].fixed != fixed) {
    return frontier.moving_count;
  }
  --frontier.group_count;
  return frontier.group_count == 0 ? 0 : frontier.groups[frontier.group_count - 1].end;
}

/// Makes a group of the moving nodes appended since there were `before`, if any.
inline void end_row(Frontier& frontier, std::uint32_t fixed, std::size_t before) noexcept {
  frontier.groups[frontier.group_count] = {fixed,
                                           static_cast<std::uint32_t>(frontier.moving_count)};
  frontier.group_count += frontier.moving_count != before ? 1 : 0;
}

/// The position in a frontier at which a step continues: a group, a child of its fixed node (a
/// row), and one of its moving nodes, where a row was left unfinished.
struct SearchCursor {
  std::size_t group = 0;
  std::uint32_t row = 0;
  std::uint32_t moving = 0;  ///< counted from the group's first node

  friend bool operator==(const SearchCursor&, const SearchCursor&) = default;
};

/// The most moving nodes of a group that are tested against one row at a time: a piece. Every form
/// of a step stops between pieces alone, at the same ones.
inline constexpr std::uint32_t kPieceNodes = 56;
inline constexpr std::size_t kPieceTests = 8 * kPieceNodes;

/// Returns the moving nodes for which a frontier needs room before a step tests a row's remaining
/// `nodes`, or in the last step their next piece.
[[nodiscard]] inline std::size_t room_of_row(const SearchStep& step, std::uint32_t nodes) noexcept {
  const std::size_t piece = step.last && nodes > kPieceNodes ? kPieceNodes : nodes;
  return step.moving.descends ? 8 * piece : piece;
}

/// The result of one call of a step.
struct Advanced {
  std::uint64_t tests;  ///< pairs of bounds that were tested
  bool full;            ///< `out` had no room for more
};

/// The bounds of the distance between two bodies that tests give, mesh units; radii include pads.
struct DistanceBounds {
  static constexpr float kNone = std::numeric_limits<float>::infinity();
  /// The least signed distance of the pairs of bounds that are not descended: of those that do not
  /// overlap, and in the last step of all.
  float lower = kNone;
  /// The least of the largest distances between points of two balls: of those that overlap, or
  /// where `lower` is measured of all.
  float upper = kNone;

  void add(const DistanceBounds& other) noexcept {
    lower = std::min(lower, other.lower);
    upper = std::min(upper, other.upper);
  }
};

/// The bounds that a search measures. Cost: a sixth of the search for the upper, half of it for
/// both.
enum class Measured : std::uint8_t { kNothing, kUpper, kBoth };

struct SearchScratch;

/// Tests the pairs of `in` from `cursor` on, and appends the overlapping ones to `out`, until all
/// are tested, `out` is full, or `most` tests are not enough: it stops before a group that would
/// exceed them, and where that is the first, before such a piece. A row (all moving nodes that
/// overlap one fixed node) begins only where `out` has room for the whole of it; in the last step,
/// where it has room for the next piece. An empty `out` must have room for a row or, in the last
/// step, for a piece. A row that was left unfinished continues in the same `out`.
///
/// Updates `bounds` by every pair that it tests, as `measured` says.
using AdvanceFunction = Advanced (*)(const SearchStep& step, const SearchPose& pose,
                                     const Frontier& in, SearchCursor& cursor, Frontier& out,
                                     SearchScratch& scratch, std::uint64_t most, Measured measured,
                                     DistanceBounds& bounds);

/// Advances without vectors; it specifies the vector kernels, which test the same pairs in the same
/// order by the same float operations. Cost: 10 to 20 ns a test.
Advanced advance_scalar(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                        SearchCursor& cursor, Frontier& out, SearchScratch& scratch,
                        std::uint64_t most, Measured measured, DistanceBounds& bounds);

/// Writes the pairs of a frontier of leaves. `out` must have room for all of them and
/// kLeafPairSpare more.
using WriteLeafPairsFunction = void (*)(const Frontier& leaves, LeafPair* out);
inline constexpr std::size_t kLeafPairSpare = 8;

/// Writes leaf pairs without vectors. Cost: 1 ns a leaf pair.
void write_leaf_pairs_scalar(const Frontier& leaves, LeafPair* out);

}  // namespace ist
