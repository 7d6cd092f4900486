#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace ist::bench {

/// The truth about a pose, known by other ways than any contestant's.
struct Truth {
  std::uint64_t pairs;  ///< triangles that meet
  double distance;      ///< of the surfaces, mesh units
};

struct NamedPose {
  std::string name;   ///< in the benchmark's name
  std::string label;  ///< what it is
  Eigen::Isometry3d pose;
  std::optional<Truth> truth{};
};

/// The closing of bodies.h.
[[nodiscard]] std::vector<NamedPose> closing_poses();

/// closing_poses(), then the poses of truth_human.json where that and the real pair are
/// there; three of them where it is quick().
[[nodiscard]] std::vector<NamedPose> peer_poses();

}  // namespace ist::bench
