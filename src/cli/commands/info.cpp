#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/answers/body_json.h"
#include "cli/answers/json_text.h"
#include "cli/commands/commands.h"
#include "cli/commands/info_text.h"
#include "cli/common_options.h"
#include "cli/header_line.h"
#include "cli/source_file.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/mesh_source.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/sphere_tree.h"

namespace ist::cli {
namespace {

struct InfoArguments {
  std::filesystem::path file;
  bool json = false;
};

void show_mesh(const InfoArguments& options) {
  const TriangleMesh mesh = read_mesh(options.file);
  const MeshReport report = check_mesh(mesh);
  if (!options.json) return print_mesh(options.file, report, mesh);
  print_header("info", {{"mesh", options.file}});
  MeshSource source = source_of(options.file);
  source.unit = mesh.unit;
  print_json(mesh_json(source.name, report, source, mesh.frame));
}

void show_tree(const InfoArguments& options) {
  const SphereTree tree = read_tree(options.file);
  const std::vector<LevelStatistics> levels = level_statistics(tree);
  std::optional<MeshReport> triangles;
  if (tree.triangles() != nullptr) triangles = check_mesh(*tree.triangles());
  if (!options.json) return print_tree(options.file, tree, triangles, levels);
  print_header("info", {{"tree", options.file}});
  print_json(tree_json(source_name(options.file.filename().string()), tree, triangles, levels));
}

}  // namespace

void add_info(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("info", "Show the contents of a mesh or a tree, level by level");
  const auto options = std::make_shared<InfoArguments>();
  command->add_option("FILE", options->file, fmt::format("{} mesh, or tree", kMeshFormats))
      ->type_name("FILE")
      ->required();
  command->add_flag("--json", options->json, "print one JSON object");
  add_example(*command, "Example: ist info jaw.ist");
  command->callback(
      [options] { is_tree_file(options->file) ? show_tree(*options) : show_mesh(*options); });
}

}  // namespace ist::cli
