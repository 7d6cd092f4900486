#pragma once

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <vector>

namespace ist::cli {

/// Returns the 16 numbers of a pose, column by column, as all JSON of the command has them.
[[nodiscard]] inline nlohmann::ordered_json pose_json(const Eigen::Isometry3d& pose) {
  return std::vector<double>(pose.data(), pose.data() + 16);
}

}  // namespace ist::cli
