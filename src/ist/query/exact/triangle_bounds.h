#pragma once

#include <cstddef>
#include <cstdint>

#include "ist/query/exact/triangles_meet.h"

namespace ist {

/// A closed box. Plain floats, relative to some origin, mesh units.
struct FloatBox {
  float low[3], high[3];
};

/// Returns the box, rounded outward to float.
[[nodiscard]] FloatBox float_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) noexcept;

/// The bounds of a triangle that reject pairs before any exact test: a box, and a slab along a
/// normal, both rounded outward. Plain floats, relative to some origin, mesh units.
struct TriangleBounds {
  FloatBox box;
  float corner[3][3];
  float normal[3];    ///< no longer than 1; 0 where there is no area
  float bottom, top;  ///< least and greatest height of a corner along it
  float slack;        ///< rounding error of a corner's height along another normal
};

/// The number of floats in TriangleBounds.
inline constexpr std::size_t kTriangleNumbers = 21;
static_assert(sizeof(TriangleBounds) == kTriangleNumbers * sizeof(float));

[[nodiscard]] TriangleBounds bounds_of(const TriangleCorners& corners,
                                       const Eigen::Vector3d& origin) noexcept;

/// The bounds of up to kSize triangles side by side, one array a number, in the order of
/// TriangleBounds.
struct alignas(64) TriangleLanes {
  static constexpr std::size_t kSize = 64;
  float number[kTriangleNumbers][kSize] = {};
  std::uint32_t count = 0;

  void add(const TriangleBounds& bounds) noexcept;
};

/// The lane of one triangle and the index of another.
struct NearPair {
  std::uint32_t lane, triangle;
};

/// Finds the pairs of a lane and one of `ids` in `bounds` that neither an axis nor one of the two
/// normals separates by more than `distance`. Writes them to `out`, by id and then by lane, and
/// returns their number; `out` must have room for all of them and kNearSlack more.
using FindNearFunction = std::size_t (*)(const TriangleLanes& lanes, const TriangleBounds* bounds,
                                         const std::uint32_t* ids, std::size_t count,
                                         float distance, NearPair* out);
inline constexpr std::size_t kNearSlack = 16;

/// Finds near pairs without vectors; it specifies the vector kernels. Cost: 20 ns a pair.
std::size_t find_near_scalar(const TriangleLanes& lanes, const TriangleBounds* bounds,
                             const std::uint32_t* ids, std::size_t count, float distance,
                             NearPair* out);

}  // namespace ist
