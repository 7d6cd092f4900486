#pragma once

#include <array>
#include <cstdint>

#include "ist/hardware/pair_test.h"
#include "ist/hardware/quantized_pose.h"

namespace ist::test {

/// A node as a tree has it: its cube's centre in units of its own tree.
struct HardwareNode {
  std::array<std::int32_t, 3> centre{};
  int level = 0;
  std::uint8_t mask = 255;
};

/// The circuit's input for two nodes.
[[nodiscard]] inline NodePair node_pair(const QuantizedPose& pose, const HardwareNode& fixed,
                                        const HardwareNode& moving) noexcept {
  NodePair pair;
  pair.fixed_centre = fixed.centre;
  pair.fixed_level = static_cast<std::uint8_t>(fixed.level);
  pair.fixed_mask = fixed.mask;
  pair.moving_centre = move_centre(pose, moving.centre);
  pair.moving_level = static_cast<std::uint8_t>(moving.level);
  pair.moving_mask = moving.mask;
  return pair;
}

}  // namespace ist::test
