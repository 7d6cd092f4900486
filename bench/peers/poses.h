#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace ist::bench {

struct NamedPose {
  std::string name;   ///< in the benchmark's name
  std::string label;  ///< what it is
  Eigen::Isometry3d pose;
};

/// The closing of bodies.h, then the poses of truth_human.json where that is there.
[[nodiscard]] std::vector<NamedPose> peer_poses();

}  // namespace ist::bench
