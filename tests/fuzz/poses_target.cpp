// A file of poses, as `ist collide --poses` takes it.

#include <nlohmann/json.hpp>

#include "cli/poses/pose_file.h"
#include "fuzz/fuzz_target.h"
#include "ist/base/error.h"
#include "ist/base/pose.h"
#include "support/temp_dir.h"

namespace ist::test {

std::string fuzz_poses(std::string_view bytes) {
  static const MemoryFile file;
  file.write(bytes);
  std::vector<Eigen::Isometry3d> poses;
  try {
    poses = cli::read_poses(file.path());
  } catch (const Error& error) {
    require(std::string_view(error.what()).starts_with(file.path().string() + ": "),
            "an error does not name the file");
    return to_string(error.code());
  }
  require(!poses.empty(), "a file without poses is fine");
  nlohmann::json list = nlohmann::json::array();
  for (const Eigen::Isometry3d& pose : poses) {
    const auto rigid = project_to_rigid(pose);
    require(rigid && rigid->matrix().isApprox(pose.matrix(), 1e-4), "a pose is no rigid motion");
    list.push_back({{"pose", std::vector<double>(pose.data(), pose.data() + 16)}});
  }
  file.write(list.dump());
  const auto again = cli::read_poses(file.path());
  require(again.size() == poses.size(), "some poses do not come back");
  for (std::size_t i = 0; i < poses.size(); ++i) {
    require(again[i].matrix() == poses[i].matrix(), "a pose does not come back as it was");
  }
  return "fine";
}

}  // namespace ist::test
