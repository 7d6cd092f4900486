#include "peers/poses.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "support/bodies.h"
#include "support/effort.h"

namespace ist::bench {

std::vector<NamedPose> closing_poses() {
  std::vector<NamedPose> poses;
  for (const double dz : kClosing) {
    char name[16];
    std::snprintf(name, sizeof name, "%.1f", dz);
    poses.push_back({name, std::string(pair_name()) + " dz=" + name, closing(dz)});
  }
  return poses;
}

std::vector<NamedPose> peer_poses() {
  std::vector<NamedPose> poses = closing_poses();
  std::ifstream file(data_file("truth_human.json"));
  if (!file || std::string_view(pair_name()) != "human") return poses;
  int index = 0;
  for (const nlohmann::json& item : nlohmann::json::parse(file)) {
    const auto numbers = item["pose"].get<std::vector<double>>();
    Eigen::Isometry3d pose;
    std::copy(numbers.begin(), numbers.end(), pose.matrix().data());
    const Truth truth{item["triangle_pairs"], item["distance"]};
    poses.push_back({"truth" + std::to_string(index++), item["label"], pose, truth});
    if (quick() && index == 3) break;
  }
  return poses;
}

}  // namespace ist::bench
