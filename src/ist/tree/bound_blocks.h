#pragma once

#include <cstdint>
#include <vector>

namespace ist {

/// A node's saved ball: the centre relative to the parent cube's centre, and the radius, in units
/// of 2^-16 of the parent cube's edge.
struct PackedBall {
  static constexpr double kUnit = 0x1p-16;  ///< of the parent cube's edge
  std::int16_t x, y, z;
  std::uint16_t r;

  friend bool operator==(const PackedBall&, const PackedBall&) = default;
};
static_assert(sizeof(PackedBall) == 8);

/// A node's saved slab: the points x with |n · (x - c) - offset| <= half, where c is the centre of
/// the node's saved ball. The normal, in units of 2^-7, has length 0.977 to 1, or 0 where the slab
/// holds everything. Offset and half width are in units of 2^-8 of the node's own cube's edge,
/// which is 128 of the ball's units.
struct PackedSlab {
  static constexpr double kNormalUnit = 0x1p-7;
  static constexpr double kUnit = 0x1p-8;  ///< of the cube's edge
  std::int8_t nx, ny, nz, offset;
  std::uint8_t half;

  friend bool operator==(const PackedSlab&, const PackedSlab&) = default;
};
static_assert(sizeof(PackedSlab) == 5);

/// The balls of one parent's children in one cache line: slot j holds the j-th child that exists,
/// and the slots beyond the last child are zero.
struct alignas(64) BallBlock {
  std::int16_t x[8], y[8], z[8];
  std::uint16_t r[8];

  [[nodiscard]] PackedBall operator[](int slot) const noexcept {
    return {x[slot], y[slot], z[slot], r[slot]};
  }
  void set(int slot, PackedBall ball) noexcept {
    x[slot] = ball.x;
    y[slot] = ball.y;
    z[slot] = ball.z;
    r[slot] = ball.r;
  }
};
static_assert(sizeof(BallBlock) == 64);

/// The slabs of one parent's children, in the same slots as their balls.
struct SlabBlock {
  std::int8_t nx[8], ny[8], nz[8], offset[8];
  std::uint8_t half[8];

  [[nodiscard]] PackedSlab operator[](int slot) const noexcept {
    return {nx[slot], ny[slot], nz[slot], offset[slot], half[slot]};
  }
  void set(int slot, PackedSlab slab) noexcept {
    nx[slot] = slab.nx;
    ny[slot] = slab.ny;
    nz[slot] = slab.nz;
    offset[slot] = slab.offset;
    half[slot] = slab.half;
  }
};
static_assert(sizeof(SlabBlock) == 40);

/// The saved bounds of a tree, as a bounding volume hierarchy (BVH): `balls[L][p]` and
/// `slabs[L][p]` bound the children, at level L, of parent p at level L + 1. At L = depth the
/// parent is the root's parent (LinearOctree::nodes), and slot 0 holds the root.
struct BoundBlocks {
  std::vector<std::vector<BallBlock>> balls;  ///< one array a level, leaves first; or empty
  std::vector<std::vector<SlabBlock>> slabs;  ///< in the same layout; empty if `balls` is
};

}  // namespace ist
