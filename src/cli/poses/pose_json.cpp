#include "cli/poses/pose_json.h"

#include <nlohmann/json.hpp>
#include <vector>

namespace ist::cli {

nlohmann::ordered_json pose_json(const Eigen::Isometry3d& pose) {
  return std::vector<double>(pose.data(), pose.data() + 16);
}

}  // namespace ist::cli
