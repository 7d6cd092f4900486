#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "ist/scene.h"

namespace ist::bench {

/// Poses of the lower jaw, one a tick of a millisecond.
using Poses = std::vector<Eigen::Isometry3d>;

/// A way in which the lower jaw moves.
struct Motion {
  const char* name;
  Poses (*make)(const Scene& jaws);
  bool with_two_workers = false;  ///< is asked of two workers too
};

/// As a simulated hand closes and opens the jaws of a scene and holds them closed, and by plain
/// laws: trembling in one place, to and fro at a speed.
[[nodiscard]] std::span<const Motion> motions();

/// How far the lower jaw's box moves from each tick to the next, at the corner that moves most, mm.
[[nodiscard]] std::vector<double> steps(const Poses& poses);

/// The scene of the real jaws, or of the built-in ones, with one worker.
[[nodiscard]] Scene scene_of_jaws(double voxel_size);

}  // namespace ist::bench
