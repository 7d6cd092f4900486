#pragma once

#include <Eigen/Geometry>
#include <nlohmann/json_fwd.hpp>

namespace ist::cli {

/// Returns the 16 numbers of a pose, column by column: the form of poses in all JSON of the
/// command.
[[nodiscard]] nlohmann::ordered_json pose_json(const Eigen::Isometry3d& pose);

}  // namespace ist::cli
