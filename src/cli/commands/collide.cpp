#include <memory>

#include "cli/commands/commands.h"
#include "cli/poses.h"
#include "cli/query_options.h"
#include "cli/query_run.h"

namespace ist::cli {

void add_collide(CLI::App& app) {
  struct Options {
    QueryOptions query;
    std::filesystem::path poses;
  };
  CLI::App* command =
      app.add_subcommand("collide", "Find where two bodies touch, at poses from a file");
  const auto options = std::make_shared<Options>();
  add_query_options(*command, options->query);
  command
      ->add_option("--poses", options->poses,
                   "JSON: an array of objects with \"pose\", 16 numbers, column-major, which map "
                   "moving to fixed coordinates")
      ->required();
  add_example(
      *command,
      "contacts: leaf pairs, pairs of voxels whose bounds overlap; their surfaces are no farther\n"
      "apart than \"resolution\".\n"
      "Example: ist collide maxilla.stl mandible.stl --voxel-size 0.4 --poses poses.json --json");
  command->callback([options] {
    const QueryOptions& query = options->query;
    query.check();
    refuse_to_overwrite(query.leaf_pairs, {query.files.fixed, query.files.moving, options->poses});
    const auto poses = read_poses(options->poses);
    run_queries(load_bodies(query.body_files()), poses, query);
  });
}

}  // namespace ist::cli
