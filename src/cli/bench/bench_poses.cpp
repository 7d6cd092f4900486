#include "cli/bench/bench_poses.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "advise/closing_path.h"
#include "cli/engine.h"
#include "ist/base/error.h"

namespace ist::cli {
namespace {

Eigen::Isometry3d lowered(double by) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().z() = -by;
  return pose;
}

}  // namespace

std::vector<BenchPose> poses_of_jaws() {
  constexpr double kJustApart = 1.5;  // mm
  return {{"closed", "closed", lowered(0)}, {"apart", "just apart", lowered(kJustApart)}};
}

std::vector<BenchPose> poses_on_way(const SphereTree& fixed, const SphereTree& moving) {
  ExactBodies bodies(fixed, moving);
  const AxisDirection direction = shortest_open_direction(bodies.fixed_box(), bodies.moving_box());
  const std::optional<ClosingPath> path = find_closing_path(bodies, direction);
  if (!path) {
    throw CLI::ValidationError(
        "--poses",
        fmt::format("needed, because the bodies never meet on the way that was tried: from where "
                    "they are stored along {}{}: give poses at which they do",
                    direction.sign < 0 ? "" : "-", "xyz"[direction.axis]));
  }
  const double apart =
      path->first_contact + path->accuracy + std::max(fixed.voxel_size(), moving.voxel_size());
  return {{"closed", "closed", path->pose(path->end)}, {"apart", "just apart", path->pose(apart)}};
}

std::vector<BenchPose> poses_among(const std::filesystem::path& file,
                                   const std::vector<Eigen::Isometry3d>& poses,
                                   const SphereTree& fixed, const SphereTree& moving) {
  Engine engine(kEngineNames.front(), fixed, moving,
                {.policy = std::min(fixed.tightest(), moving.tightest())});
  std::vector<std::uint64_t> pairs;
  pairs.reserve(poses.size());
  for (const Eigen::Isometry3d& pose : poses) pairs.push_back(engine.ask(pose).result.leaf_pairs);
  const auto [fewest, most] = std::ranges::minmax_element(pairs);
  if (pairs.empty() || *most == 0) {
    throw Error(ErrorCode::kInputInvalid,
                fmt::format("{}: the bodies meet at none of its {} poses, so no query would have "
                            "anything to find: add poses with contact",
                            file.string(), poses.size()));
  }
  if (*most == *fewest) {
    throw Error(ErrorCode::kInputInvalid,
                fmt::format("{}: each of its {} poses has {} leaf pairs, and two situations are "
                            "compared: add a pose with fewer or more",
                            file.string(), poses.size(), *most));
  }
  const auto at = [&](auto place) {
    return poses[static_cast<std::size_t>(place - pairs.begin())];
  };
  return {{"most", "most contact", at(most)}, {"fewest", "fewest", at(fewest)}};
}

}  // namespace ist::cli
