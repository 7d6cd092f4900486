#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "answers/formats/format.h"
#include "answers/refusals.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/load_bodies.h"
#include "cli/page/page_blocks.h"
#include "cli/page/page_file.h"
#include "cli/poses/pose_options.h"
#include "ist/base/files.h"

namespace ist::cli {

using namespace answers;

namespace {

struct ViewArguments {
  std::filesystem::path fixed, moving, output, scene;
  BodyFiles told;  // units and frame alone
  PoseOptions pose;
  std::uint64_t max_memory = BuildOptions{}.max_memory;
  bool no_names = false;
};

std::string name_of(const SphereTree& tree, const std::filesystem::path& file) {
  return tree.source().name.empty() ? file.filename().string() : tree.source().name;
}

Bodies bodies_of(const ViewArguments& options) {
  if (options.moving.empty()) {
    const SphereTree body = load_body(options.fixed, options.max_memory);
    return {body, body, body.tightest()};  // trees share their content
  }
  BodyFiles files = options.told;
  files.fixed = options.fixed;
  files.moving = options.moving;
  files.voxels = BodyFiles::Voxels::kNone;  // the page makes its own
  files.max_memory = options.max_memory;
  return load_bodies(files);
}

nlohmann::ordered_json block_of_bodies(const ViewArguments& options) {
  const Bodies bodies = bodies_of(options);
  require_triangles(bodies);
  const auto named = [&](const char* role, const SphereTree& tree,
                         const std::filesystem::path& file) {
    return options.no_names ? NamedTree{role, without_name(tree)}
                            : NamedTree{name_of(tree, file), tree};
  };
  const NamedTree fixed = named("fixed", bodies.fixed, options.fixed);
  if (options.moving.empty()) return body_alone_block(fixed);
  return bodies_block(fixed, named("moving", bodies.moving, options.moving),
                      options.pose.poses_named().front().pose);
}

nlohmann::ordered_json block_of(const ViewArguments& options) {
  if (!is_recording(options.fixed)) {
    refuse_if(!options.scene.empty(), "--scene", "goes with a recording");
    refuse_if(options.moving.empty() && options.pose.is_named(), "--move",
              "a pose is of the second body: name two files");
    return block_of_bodies(options);
  }
  refuse_if(!options.moving.empty(), options.moving.string(),
            "a recording holds all bodies of its scene: name that by --scene");
  refuse_if(options.pose.is_named(), "--move", "a recording has its own poses");
  refuse_if(options.no_names, "--no-names", "a recording holds its scene, which names its files");
  return recording_block(options.fixed, options.scene, options.max_memory);
}

void run(const ViewArguments& options) {
  static_cast<void>(format_by_ending("-o", options.output, std::array{FileFormat::kHtml}));
  check_output(options.output, {options.fixed, options.moving, options.scene, options.pose.matrix});
  const std::optional<std::filesystem::path> page = find_page();
  if (!page) throw std::runtime_error(kHowToGetPage);
  refuse_to_overwrite(options.output, {*page});
  OutputFile file(options.output);
  write_page(*page, block_of(options), file);
  file.commit();
  fmt::print(stderr, "wrote {}: open it in a browser\n", options.output.string());
}

}  // namespace

void add_view(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "view", "Write a page that shows bodies, or plays a recording, in any browser");
  const auto options = std::make_shared<ViewArguments>();
  add_file(*command, "FIXED", options->fixed,
           "mesh or tree of the body that stays, or a recording of 'ist run --record'")
      ->required();
  add_file(*command, "MOVING", options->moving, "mesh or tree of the body that is moved");
  add_file(*command, "-o,--output", options->output, "the page, which ends in .html")->required();
  add_file(*command, "--scene", options->scene,
           "the scene that a recording is of, for its bodies; else the page shows frames "
           "and forces alone");
  command->add_flag("--no-names", options->no_names, "write fixed and moving for the files' names");
  add_max_memory(*command, options->max_memory, "each tree, and for all queries together");
  add_units_and_frame(*command, options->told);
  add_pose_options(*command, options->pose, Poses::kOne);
  add_example(*command,
              "The page holds the engine and all data, asks no server, and can be mailed.\n"
              "Examples: ist view upper.stl lower.stl -o jaws.html\n"
              "          ist view ticks.jsonl --scene scene.toml -o run.html");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
