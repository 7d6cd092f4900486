#pragma once

#include <memory>

#include "ist/tree/sphere_tree.h"
#include "loop/haptics/simulation_parts.h"

namespace ist::test {

inline constexpr CouplingSettings kHapticCoupling{1000, 0.5, 2, 0.001, 4, 0.1};
inline constexpr SafetySettings kHapticSafety{8, 0.3, 2000, 50, 0.1};

/// A held body over a fixed one, millimetres, that touch along z.
class HapticBodies {
 public:
  HapticBodies(SphereTree fixed, SphereTree held, double touching)
      : fixed_(std::make_unique<const SphereTree>(std::move(fixed))),
        held_(std::make_unique<const SphereTree>(std::move(held))),
        touching_(touching) {}

  /// With springs of 20,000 N/m, and one more effect if it is there, at 1 kHz, starting 1 mm apart.
  [[nodiscard]] Simulation simulation(std::unique_ptr<Effect> other = nullptr) const;
  /// The tool so far above where the surfaces meet, m.
  [[nodiscard]] Placement at(double height) const {
    return {Eigen::Matrix3d::Identity(), {0, 0, touching_ + height}};
  }
  /// Of the tool, where the surfaces meet, m.
  [[nodiscard]] double touching() const noexcept { return touching_; }
  [[nodiscard]] double voxel() const noexcept { return 1e-3 * held_->voxel_size(); }

 private:
  std::unique_ptr<const SphereTree> fixed_, held_;
  double touching_;
};

/// A ball of radius 5 mm on a box whose upper face is z = 0, voxels of 0.5 mm.
[[nodiscard]] HapticBodies ball_over_box();

}  // namespace ist::test
