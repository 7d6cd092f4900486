#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "answers/refusals.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/poses/pose_options.h"
#include "cli/query_options.h"
#include "cli/query_run.h"

namespace ist::cli {

using namespace answers;

namespace {

struct CollideArguments {
  QuestionOptions query;
  PoseOptions pose;
};

void run(const CollideArguments& options) {
  const QuestionOptions& query = options.query;
  query.check();
  check_output(query.contacts,
               {query.files.fixed, query.files.moving, options.pose.matrix, options.pose.poses});
  std::vector<AskedPose> poses;
  for (const GivenPose& given : options.pose.poses_named()) {
    poses.push_back({given.pose, std::nullopt, given.rotation_error});
  }
  const Bodies bodies = load_bodies(query.body_files());
  if (!query.json && poses.size() == 1) echo_pose(options.pose, poses.front().pose);
  const Meeting meeting = run_queries(bodies, poses, query);
  if (query.fail_if_touching) fail_where_they_meet(meeting);
}

}  // namespace

void add_collide(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "collide", "Find where two bodies touch, how deep and how far, at one pose or many");
  const auto options = std::make_shared<CollideArguments>();
  add_query_options(*command, options->query);
  command->add_flag("--escape", options->query.questions.escape,
                    "find the shortest rigid motion that frees the bodies, 0.2 to 1 s a pose: its "
                    "length is the way of the point that goes farthest");
  add_pose_options(*command, options->pose, Poses::kMany);
  add_example(*command,
              "touch is yes or no by triangles, near by voxels alone, and unknown where "
              "--max-tests ended the search.\n"
              "Examples: ist collide upper.stl lower.stl\n"
              "          ist collide upper.stl lower.stl --move 0,0,-1.5 --turn x,2@0,40,0\n"
              "          ist collide upper.stl lower.stl --escape");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
