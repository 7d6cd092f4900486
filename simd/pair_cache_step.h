#pragma once

#include <cstddef>
#include <cstdint>

#include "simd/contact_lanes.h"
#include "simd/contact_step.h"
#include "simd/lanes.h"

namespace ist {

/// Leaf pairs that are kept from one pose to the next, side by side: a pair cache. Pairs are in the
/// order of the search; the pairs of one fixed leaf are a row. The memory is the owner's, with room
/// for kCacheSpare more of each array, which begins at a multiple of 64 bytes.
struct CacheLanes {
  /// The fixed leaves, one a row, in their tree's frame.
  struct Fixed {
    float* lane[kLanes];
    float *normal_x, *normal_y, *normal_z;  ///< of the surface, as long as it is coherent
    std::uint32_t* id;                      ///< as the step names it
    std::uint32_t* address;                 ///< 8 · parent + slot
  } fixed;
  /// The moving leaves, one a pair, in their tree's frame.
  struct Moving {
    float* lane[kLanes];
    float *x, *y, *z;                       ///< the surface point
    float *normal_x, *normal_y, *normal_z;  ///< of the surface, as long as it is coherent
    std::uint32_t* id;                      ///< as the step names it
    std::uint32_t* row;                     ///< of the pair's fixed leaf
  } moving;
  std::size_t row_count, pair_count;
  std::size_t row_capacity, pair_capacity;
};

/// Kernels read and write whole vectors, so they may go this far behind the capacity.
inline constexpr std::size_t kCacheSpare = 64;

/// Returns whether a cache has room for `rows` rows with `pairs` pairs among them.
[[nodiscard]] inline bool has_room(const CacheLanes& cache, std::size_t rows,
                                   std::size_t pairs) noexcept {
  return cache.pair_count + pairs <= cache.pair_capacity &&
         cache.row_count + rows <= cache.row_capacity;
}

/// The rows of a cache at one pose, as FixedRows and FixedPoints; normals are those of the
/// surfaces. The memory is the owner's, as in CacheLanes.
struct CacheRows {
  float *x, *y, *z, *radius;
  float *normal_x, *normal_y, *normal_z, *offset, *half;
  float* scaled_radius;
  struct Surface {
    float *x, *y, *z;
    float *normal_x, *normal_y, *normal_z;
  } surface;
};

/// Advances like AdvanceFunction in a last step, but appends the overlapping pairs to a cache. It
/// is full where it may have no room for the next piece. Measures nothing.
using AdvanceCacheFunction = Advanced (*)(const SearchStep& step, const SearchPose& pose,
                                          const Frontier& in, SearchCursor& cursor, CacheLanes& out,
                                          SearchScratch& scratch, std::uint64_t most);

/// Turns the rows of a cache into the moving tree's frame; the surfaces only where `surfaces`.
using TurnCacheFunction = void (*)(const CacheLanes& cache, const SearchStep& step,
                                   const SearchPose& pose, bool surfaces, CacheRows& rows);

/// Tests pairs [begin, end) of a cache at the pose of `rows`. Writes the places of those that
/// overlap to `out`, which has room for all and for kCacheSpare more, and returns their number.
/// `begin` is a multiple of 16.
using SelectCacheFunction = std::size_t (*)(const CacheLanes& cache, const SearchStep& step,
                                            const CacheRows& rows, std::size_t begin,
                                            std::size_t end, std::uint32_t* out);

/// Tests pairs [begin, end) of a cache at the pose of `rows` and adds up those that overlap, as
/// AdvanceContactsFunction and AddContactsFunction do: the same terms, but none of pairs without
/// weight. `begin` is a multiple of 16.
using AddCacheFunction = void (*)(const CacheLanes& cache, const SearchStep& step,
                                  const CacheRows& rows, std::size_t begin, std::size_t end,
                                  ContactAdder& out);

/// The scalar forms specify the vector kernels, which give the same numbers, bit by bit. Cost: 10
/// ns a pair, 40 for one that overlaps.
Advanced advance_cache_scalar(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                              SearchCursor& cursor, CacheLanes& out, SearchScratch& scratch,
                              std::uint64_t most);
void turn_cache_scalar(const CacheLanes& cache, const SearchStep& step, const SearchPose& pose,
                       bool surfaces, CacheRows& rows);
std::size_t select_cache_scalar(const CacheLanes& cache, const SearchStep& step,
                                const CacheRows& rows, std::size_t begin, std::size_t end,
                                std::uint32_t* out);
void add_cache_scalar(const CacheLanes& cache, const SearchStep& step, const CacheRows& rows,
                      std::size_t begin, std::size_t end, ContactAdder& out);

// The rest is shared by the scalar and the vector forms.

/// Returns the number of lanes that a bound takes.
[[nodiscard]] inline std::size_t lanes_of(bool slabs) noexcept { return slabs ? kLanes : kNormalX; }

/// Begins a batch of terms; the fixed leaves of its pairs go into the adder's lanes, which hold no
/// pairs.
inline void begin_terms(ContactAdder& out) noexcept {
  out.terms.count = 0;
  out.terms.fixed = out.lanes.fixed;
}

/// Ends a batch of terms that were added up.
inline void hand_over_terms(ContactAdder& out) noexcept {
  if (out.stream != nullptr && out.terms.count > 0) out.stream->take(out.terms);
  out.terms.count = 0;
}

/// Names the fixed leaf `row` of a group, if the last row is not the same leaf, cut by a limit.
/// Returns the number of its row.
inline std::size_t name_row(const FixedGroup& group, std::size_t row, bool slabs,
                            CacheLanes& out) noexcept {
  const FixedLanes& fixed = group.lanes;
  const FixedPoints& points = group.points;
  const std::uint32_t id = fixed.id[row];
  const std::size_t rows = out.row_count;
  if (rows > 0 && out.fixed.id[rows - 1] == id) return rows - 1;
  for (std::size_t lane = 0; lane < lanes_of(slabs); ++lane) {
    out.fixed.lane[lane][rows] = fixed.lane[lane][row];
  }
  out.fixed.id[rows] = id;
  out.fixed.address[rows] = points.first + static_cast<std::uint32_t>(row);
  const FloatVector normal = unpack_normal(points.normals[row].word());
  out.fixed.normal_x[rows] = normal.x;
  out.fixed.normal_y[rows] = normal.y;
  out.fixed.normal_z[rows] = normal.z;
  ++out.row_count;
  return rows;
}

}  // namespace ist
