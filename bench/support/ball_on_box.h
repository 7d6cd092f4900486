#pragma once

#include <memory>
#include <set>
#include <string>

#include "ist/haptics/devices/hand_device.h"
#include "ist/haptics/simulation.h"
#include "ist/tree/sphere_tree.h"

namespace ist::bench {

/// The scene of scripts/tick_instructions.py without its scene file: a program that knows which
/// effects it wants, and makes these and what they need out of the library's parts.
struct BallOnBox {
  std::unique_ptr<const SphereTree> box, ball, near_box, near_ball;
  std::unique_ptr<Simulation> simulation;  ///< refers to the trees
  std::unique_ptr<HandDevice> device;
};

/// @param effects of "contact", "friction", "damping", "proximity", "gravity", "snap"
[[nodiscard]] BallOnBox make_ball_on_box(const std::set<std::string>& effects);

}  // namespace ist::bench
