#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "answers/formats/format.h"
#include "answers/formats/glb_writer.h"
#include "answers/formats/level_geometry.h"
#include "answers/formats/ply_writer.h"
#include "answers/formats/vtp_writer.h"
#include "answers/refusals.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/progress_bar.h"
#include "cli/terminal.h"
#include "ist/base/counted.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"

namespace ist::cli {

using namespace answers;

namespace {

struct ExportArguments {
  std::filesystem::path tree, output;
  std::string what, spheres;
  std::optional<std::string> unit;
  int level = 0;
  bool json = false;
};

constexpr std::array kSurfaceFormats{FileFormat::kVtp, FileFormat::kPly, FileFormat::kGlb};
constexpr std::array kPointFormats{FileFormat::kVtp, FileFormat::kPly};  // a GLB knows no radius

constexpr const char* kWriting = "writing the file";

FileFormat format_of(const ExportArguments& options) {
  if (options.what == "voxels") return format_by_ending("-o", options.output, kSurfaceFormats);
  return format_by_ending("-o", options.output, kPointFormats);
}

// Returns the metres in a unit of the tree. Assumes millimetres if nobody tells it, and says so.
double metres_of(const SphereTree& tree, FileFormat format, const ExportArguments& options) {
  const LengthUnit stored = tree.source().unit;
  const LengthUnit named = options.unit ? *length_unit(*options.unit) : LengthUnit::kUnknown;
  refuse_if(stored != LengthUnit::kUnknown && named != LengthUnit::kUnknown && stored != named,
            "--unit", "the tree holds {}: leave it out", to_string(stored));
  const LengthUnit unit = stored != LengthUnit::kUnknown ? stored : named;
  if (unit != LengthUnit::kUnknown) return metres_per_unit(unit);
  if (format == FileFormat::kGlb) fmt::print(stderr, "unit: mm (assumed); --unit names another\n");
  return metres_per_unit(LengthUnit::kMillimetre);
}

void write(PolyData data, const SphereTree& tree, FileFormat format, const std::string& comment,
           const ExportArguments& options) {
  const double metres = metres_of(tree, format, options);
  data.frame = tree.frame();
  if (format == FileFormat::kVtp) return write_vtp(data, options.output);
  if (format == FileFormat::kPly) return write_ply(data, options.output, comment);
  const std::array body{
      NamedPolyData{fmt::format("{} of level {}", options.what, options.level), std::move(data)}};
  write_glb(body, metres, options.output);
}

void write_voxels(const SphereTree& tree, FileFormat format, const ExportArguments& options,
                  Progress& progress) {
  PolyData cubes = level_cubes(tree, options.level, &progress);
  progress.begin_stage(kWriting, 0);
  write(std::move(cubes), tree, format,
        fmt::format("voxels of level {}: cubes, inner faces left out", options.level), options);
}

void write_spheres(const SphereTree& tree, FileFormat format, const ExportArguments& options,
                   Progress& progress) {
  const SpherePolicy policy =
      options.spheres.empty() ? tree.tightest() : *sphere_policy(options.spheres);
  tree.require(policy, options.tree.string());
  const std::string comment =
      fmt::format("{} spheres of level {}: points with a radius", to_string(policy), options.level);
  PolyData centres = level_centres(tree, policy, options.level);
  progress.begin_stage(kWriting, 0);
  write(std::move(centres), tree, format, comment, options);
}

void run(const ExportArguments& options) {
  refuse_if(options.what == "voxels" && !options.spheres.empty(), "--spheres",
            "goes with --what spheres");
  const FileFormat format = format_of(options);
  refuse_if(options.unit && format != FileFormat::kGlb, "--unit",
            "goes with a .glb, which is in metres; .vtp and .ply keep the mesh's unit");
  check_output(options.output, {options.tree});
  const SphereTree tree = read_tree(options.tree);
  require_voxels(tree, options.tree.string());
  refuse_if(options.level > tree.depth(), "--level", "the tree has levels 0 to {}", tree.depth());
  {
    ProgressBar progress;
    (options.what == "voxels" ? write_voxels : write_spheres)(tree, format, options, progress);
  }
  const std::uint32_t count = voxels_of(tree).octree.node_count(options.level);
  if (options.json) {
    print_header("export", {{"tree", options.tree}});
    print_json({{"file", options.output.filename().string()},
                {"what", options.what},
                {"level", options.level},
                {"count", count}});
  } else {
    const char* one = options.what == "voxels" ? "voxel" : "sphere";
    fmt::print("{}: {}\n", options.output.string(), counted(count, one));
  }
}

}  // namespace

void add_export(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "export", "Write a level of a tree for viewers: " + endings_with_programs(kSurfaceFormats));
  const auto options = std::make_shared<ExportArguments>();
  add_file(*command, "TREE", options->tree, "tree file")->required();
  command
      ->add_option("--what", options->what, "cubes; or spheres, as points with an array 'radius'")
      ->required()
      ->transform(one_of({"voxels", "spheres"}));
  command->add_option("--level", options->level, "0 for the leaves")
      ->required()
      ->check(CLI::Range(0, 17));
  command
      ->add_option("--spheres", options->spheres,
                   "spheres to write, of slab the balls; by default the tightest that the tree has")
      ->transform(one_of(policy_names()));
  add_file(
      *command, "-o,--output", options->output,
      fmt::format("file to write, by its ending: of voxels {}; of spheres {}",
                  endings_with_programs(kSurfaceFormats), endings_with_programs(kPointFormats)))
      ->required();
  command
      ->add_option("--unit", options->unit,
                   "unit of a tree that holds none, which a .glb turns into metres; else mm")
      ->transform(unit_name());
  command->add_flag("--json", options->json, "print one JSON object");
  add_example(
      *command,
      "Example: ist export jaw.ist --what spheres --spheres table --level 2 -o spheres.vtp");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
