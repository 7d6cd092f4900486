#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/base/api.h"

namespace ist {

/// A hash table of vertices by their positions. It holds their indices alone.
class PositionTable {
 public:
  static constexpr std::uint32_t kNoVertex = 0xFFFFFFFF;

  /// Makes room for that many positions, and a third more.
  explicit PositionTable(std::size_t positions = 0) { reset(positions); }

  /// Returns the slot of a position: it holds the vertex there, or kNoVertex and may be set.
  /// `vertices` are those whose indices the table holds. Coordinates 0 and -0 are equal.
  [[nodiscard]] std::uint32_t& slot_of(const Eigen::Vector3d& point,
                                       std::span<const Eigen::Vector3d> vertices);
  /// Forgets all, and makes room for that many.
  void reset(std::size_t positions);
  /// Returns the positions for which there is room.
  [[nodiscard]] std::size_t room() const noexcept { return slots_.size() / 4 * 3; }

 private:
  std::vector<std::uint32_t> slots_;  // a power of two, linear probing
};

/// Returns the first vertex at the position of each vertex. Cost: 50 ns a vertex.
[[nodiscard]] IST_LOOP_API std::vector<std::uint32_t> first_at_position(
    std::span<const Eigen::Vector3d> points);

}  // namespace ist
