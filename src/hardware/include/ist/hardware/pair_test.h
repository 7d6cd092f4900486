#pragma once

#include <array>
#include <cstdint>

#include "ist/base/api.h"

/// @file
/// The pair test of the circuit, bit for bit, in integers alone. A unit is a sixth of half a fixed
/// leaf's edge; src/hardware/README.md gives the formats and derives the error bounds.
namespace ist {

/// The highest level: a tree has at most 2^16 voxels along an axis.
inline constexpr int kMaxNodeLevel = 16;
/// The largest coordinate of a cube's centre, units of its own tree: half the root's edge at level
/// 16.
inline constexpr std::int32_t kMaxCentre = 6 << kMaxNodeLevel;

/// The registers that all pairs of a query share; made by quantize_pose.
struct PairRegisters {
  std::array<std::int32_t, 9> rotation{};  ///< moving to fixed units, columns first; Q3.16
  std::array<std::uint16_t, 5> radius{};   ///< of moving nodes at level 0, by radius code; Q8.8
  std::uint16_t pad = 0;                   ///< error bound of the centres; Q8.8 units

  /// Compares all registers.
  friend bool operator==(const PairRegisters&, const PairRegisters&) = default;
};

/// A fixed and a moving node. A leaf is full: level 0 with mask 255.
struct NodePair {
  std::array<std::int32_t, 3> fixed_centre{};   ///< of its cube, units, at most ±kMaxCentre
  std::uint8_t fixed_level = 0,                 ///< 0 for a leaf, up to kMaxNodeLevel
      fixed_mask = 0;                           ///< bit k: octant k is not empty; 0: no node
  std::array<std::int32_t, 3> moving_centre{};  ///< of its cube, in the fixed frame (move_centre);
                                                ///< Q23.8 units
  std::uint8_t moving_level = 0,                ///< 0 for a leaf, up to kMaxNodeLevel
      moving_mask = 0;                          ///< bit k: octant k is not empty; 0: no node

  /// Compares both nodes.
  friend bool operator==(const NodePair&, const NodePair&) = default;
};

/// The answer of the pair test.
struct PairAnswer {
  std::uint64_t reach = 0;  ///< sum of both radii and the pad; Q25.8 units
  bool hit = false;         ///< the balls overlap, or nearly

  /// Compares both members.
  friend bool operator==(const PairAnswer&, const PairAnswer&) = default;
};

/// Returns the vector from the fixed ball's centre to the moving one's; Q24.8 units.
[[nodiscard]] std::array<std::int64_t, 3> ball_distance(const NodePair& pair,
                                                        const PairRegisters& registers) noexcept;

/// Tests whether the table balls of two nodes overlap. Never a miss if they do in exact arithmetic;
/// README.md bounds the distance of a false hit. A miss if either mask is 0.
///
/// Precondition: levels up to kMaxNodeLevel, a fixed centre within ±kMaxCentre.
[[nodiscard]] IST_API PairAnswer test_pair(const NodePair& pair,
                                           const PairRegisters& registers) noexcept;

}  // namespace ist
