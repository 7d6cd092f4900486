#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "ist/query/contact.h"
#include "ist/query/exact/triangle_bounds.h"
#include "ist/tree/bound_blocks.h"
#include "ist/tree/linear_octree.h"

namespace ist {

/// How one step of the breadth-first search reads one tree: the blocks of some level's nodes, which
/// are called parents here, and through them the parents' children. Pointers into a tree; plain
/// floats, so that vector code and its scalar twin see the same bits.
struct SearchSide {
  const OctreeNode* nodes;          ///< the parents, and one more
  const BallBlock* balls;           ///< by parent; null where spheres follow from the octree
  const SlabBlock* slabs;           ///< by parent; null where the policy has none
  const std::uint8_t* masks;        ///< of the parents
  const std::uint8_t* child_masks;  ///< of the children; null where those are circumspheres

  float voxel_size;     ///< a node's centre is in voxels
  float ball_unit;      ///< mesh units to one of BallBlock's
  float slab_unit;      ///< mesh units to one of SlabBlock's
  float octant_offset;  ///< from a parent's centre to its children's along an axis
  float half_edge;      ///< of a child's cube

  /// Whether children of the nodes in the frontier are tested, or those nodes themselves. A node
  /// that is opened is named by its index; one that is not by its address, 8 · parent + slot.
  bool opens;
  bool names_addresses;  ///< how survivors are named, by address or by index
};

/// One step of the search: from the pairs of nodes that touch at one level to those at the next.
struct SearchStep {
  SearchSide fixed, moving;
};

/// The motion from the fixed tree's frame to the moving one's, x = rotation · y + translation, and
/// what a test may err by, mesh units. The same for all steps of a query.
struct SearchPose {
  float rotation[9];  ///< row by row
  float translation[3];
  float ball_pad, slab_pad;
};

/// The moving nodes that touch one fixed node: those from the previous group's end on to `end`.
struct SearchGroup {
  std::uint32_t fixed, end;
};

/// All pairs alive at one level, or as many as there is room for: groups in the order of their
/// fixed nodes, and in a group the moving nodes in order. Memory is the owner's.
struct Frontier {
  SearchGroup* groups;
  std::uint32_t* moving;
  std::size_t group_count, moving_count;
  std::size_t capacity;  ///< of both; behind it is room for kFrontierSlack more
};

/// Kernels store whole vectors, so as much may be written, and read, behind a frontier's capacity.
inline constexpr std::size_t kFrontierSlack = 64;

/// Whether there is room for so many rows with so many moving nodes among them. An empty frontier
/// always has room for one row.
[[nodiscard]] inline bool has_room(const Frontier& frontier, std::size_t rows,
                                   std::size_t moving) noexcept {
  return (frontier.moving_count == 0 && rows == 1) ||
         (frontier.moving_count + moving <= frontier.capacity &&
          frontier.group_count + rows <= frontier.capacity);
}

/// Makes a group of the moving nodes appended since there were `before`, if there are any.
inline void end_row(Frontier& frontier, std::uint32_t fixed, std::size_t before) noexcept {
  frontier.groups[frontier.group_count] = {fixed,
                                           static_cast<std::uint32_t>(frontier.moving_count)};
  frontier.group_count += frontier.moving_count != before ? 1 : 0;
}

/// Where in a frontier a step goes on: at a child of a group's fixed node, and where rows may be
/// cut at one of its moving nodes.
struct SearchCursor {
  std::size_t group = 0;
  std::uint32_t row = 0;
  std::uint32_t moving = 0;  ///< counted from the group's first
};

template <std::size_t N>
struct BoundLanes;
struct FixedRows;
struct SearchScratch;

/// Tests the pairs of `in` from `cursor` on, and appends to `out` those whose bounds touch, until
/// all is done or `out` has no room for another row (all that touch one fixed node). `out` must
/// have room for one row when it is empty: as many as there are moving nodes at that level.
///
/// @return the number of pairs tested
using AdvanceFunction = std::uint64_t (*)(const SearchStep& step, const SearchPose& pose,
                                          const Frontier& in, SearchCursor& cursor, Frontier& out,
                                          SearchScratch& scratch);

/// The plain form, which specifies the vector kernels: the same pairs in the same order, tested by
/// the same float operations. Cost: 10 to 20 ns a test.
std::uint64_t advance_scalar(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                             SearchCursor& cursor, Frontier& out, SearchScratch& scratch);

/// The pairs of a frontier of leaves as contacts. `out` must have room for all of them and
/// kContactSlack more.
using WriteContactsFunction = void (*)(const Frontier& leaves, Contact* out);
inline constexpr std::size_t kContactSlack = 8;

/// Cost: 1 ns a contact.
void write_contacts_scalar(const Frontier& leaves, Contact* out);

/// What tests tell of the distance between two bodies, mesh units, pads included.
struct Measure {
  static constexpr float kNone = std::numeric_limits<float>::infinity();
  float pruned = kNone;    ///< least distance of two bounds that do not touch
  float touching = kNone;  ///< of two that do: less than nothing
  float farthest = kNone;  ///< least of the most that points of two balls can be apart
};

/// What a step is made of, each part for itself, to be tested and measured.
struct StepParts {
  /// The nodes that stand for a frontier's `node`, into lanes from `at` on; see ist::decode.
  std::uint32_t (*decode)(const SearchSide& side, std::uint32_t node, BoundLanes<1024>& out,
                          std::size_t at);
  /// All eight rows; see ist::turn.
  void (*turn)(const SearchPose& pose, bool slabs, const BoundLanes<8>& fixed, FixedRows& rows);
  /// One row against the lanes [begin, end), `begin` a multiple of 16; see ist::touch. Writes the
  /// names of those that touch, with 16 more for room behind them, and returns how many there are.
  std::size_t (*touch_row)(const FixedRows& rows, std::size_t row, const BoundLanes<1024>& moving,
                           std::size_t begin, std::size_t end, bool slabs, std::uint32_t* out);
  /// The same, and measures all pairs; see ist::measure.
  std::size_t (*measure_row)(const FixedRows& rows, std::size_t row, const BoundLanes<1024>& moving,
                             std::size_t begin, std::size_t end, bool slabs, std::uint32_t* out,
                             Measure& measure);
};

/// The functions that a query is made of, for one instruction set.
struct Kernels {
  const char* target;  ///< `scalar`, `avx3`, …
  AdvanceFunction advance;
  WriteContactsFunction write_contacts;
  StepParts parts;
  FindNearFunction find_near;
};

/// The plain form of all, which every processor runs.
extern const Kernels kScalarKernels;

}  // namespace ist
