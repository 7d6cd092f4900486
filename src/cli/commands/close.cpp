#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "cli/commands/commands.h"
#include "cli/query_options.h"
#include "cli/query_run.h"

namespace ist::cli {
namespace {

constexpr double kMostSteps = 1e6;

struct CloseArguments {
  QueryOptions query;
  std::string axis;
  double from = 0, to = 0, step = 0;
};

std::vector<Eigen::Isometry3d> straight_path(const CloseArguments& options) {
  const double length = std::abs(options.to - options.from);
  refuse_if(!std::isfinite(options.from) || !std::isfinite(options.to), "--from, --to",
            "give finite numbers");
  refuse_if(!(options.step > 0) || !(length / options.step <= kMostSteps), "--step",
            fmt::format("give a positive number that makes at most {:.0f} steps", kMostSteps));
  const auto steps = static_cast<int>(std::floor(length / options.step * (1 + 1e-12)));
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i <= steps; ++i) {
    Eigen::Isometry3d& pose = poses.emplace_back(Eigen::Isometry3d::Identity());
    const double distance = i * options.step;
    pose.translation()[options.axis[0] - 'x'] =
        options.to < options.from ? options.from - distance : options.from + distance;
  }
  return poses;
}

}  // namespace

void add_close(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("close", "Find where two bodies touch, along a straight path");
  const auto options = std::make_shared<CloseArguments>();
  add_query_options(*command, options->query);
  command->add_option("--axis", options->axis, "axis along which the moving body is displaced")
      ->required()
      ->check(CLI::IsMember({"x", "y", "z"}));
  command->add_option("--from", options->from, "first displacement, in mesh units")->required();
  command->add_option("--to", options->to, "last displacement, in mesh units")->required();
  command->add_option("--step", options->step, "distance from one pose to the next, in mesh units")
      ->required();
  add_example(*command,
              "Line i is the answer i steps from --from towards --to, which is reached if it is a "
              "whole number\n"
              "of steps away.\n"
              "Example: ist close maxilla.stl mandible.stl --voxel-size 0.4 --axis z --from -3 "
              "--to 0 --step 0.1");
  command->callback([options] {
    const QueryOptions& query = options->query;
    query.check();
    refuse_to_overwrite(query.leaf_pairs, {query.files.fixed, query.files.moving});
    const auto poses = straight_path(*options);
    run_queries(load_bodies(query.body_files()), poses, query);
  });
}

}  // namespace ist::cli
