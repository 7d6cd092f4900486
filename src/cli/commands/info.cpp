#include <fmt/format.h>

#include <Eigen/Geometry>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands/commands.h"
#include "cli/commands/info_text.h"
#include "cli/common_options.h"
#include "cli/extents.h"
#include "cli/header_line.h"
#include "cli/source_file.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"

namespace ist::cli {
namespace {

using nlohmann::ordered_json;

struct InfoArguments {
  std::filesystem::path file;
  bool json = false;
};

ordered_json numbers(const Eigen::Vector3d& vector) { return {vector[0], vector[1], vector[2]}; }

// Adds the keys that a mesh and a tree share; without a report the surface's are null.
void add_measures(ordered_json& line, const Eigen::Vector3d& extent,
                  const std::optional<MeshReport>& report, const MeshSource& source) {
  line["extent"] = numbers(extent);
  for (const char* key : {"closed", "consistent", "volume"}) line[key] = nullptr;
  if (report) {
    line["closed"] = report->closed;
    line["consistent"] = report->consistent;
    if (report->closed && report->consistent) line["volume"] = report->signed_volume;
  }
  line["unit"] = json_of(source.unit);
  line["source"] = json_of(source);
}

void show_mesh(const InfoArguments& options) {
  const MeshReport report = check_mesh(read_mesh(options.file));
  if (!options.json) return print_mesh(options.file, report);
  print_header("info", {{"mesh", options.file}});
  ordered_json line{{"file", options.file.string()},
                    {"kind", "mesh"},
                    {"vertices", report.vertices},
                    {"triangles", report.triangles},
                    {"components", report.components},
                    {"boundary_edges", report.boundary_edges},
                    {"non_manifold_edges", report.non_manifold_edges},
                    {"duplicate_triangles", report.duplicate_triangles},
                    {"degenerate_triangles", report.degenerate_triangles},
                    {"inconsistent_edges", report.inconsistent_edges},
                    {"box_min", numbers(report.box_min)},
                    {"box_max", numbers(report.box_max)},
                    {"warnings", warnings(report)}};
  add_measures(line, report.box_max - report.box_min, report, source_of(options.file));
  fmt::print("{}\n", line.dump());
}

void show_tree(const InfoArguments& options) {
  const SphereTree tree = read_tree(options.file);
  const std::vector<LevelStatistics> levels = level_statistics(tree);
  std::optional<MeshReport> triangles;
  if (tree.triangles() != nullptr) triangles = check_mesh(*tree.triangles());
  if (!options.json) return print_tree(options.file, tree, triangles, levels);
  print_header("info", {{"tree", options.file}});
  ordered_json line{
      {"file", options.file.string()},
      {"kind", "tree"},
      {"voxel_size", tree.voxel_size()},
      {"cells", tree.parts().lattice.cells},
      {"depth", tree.depth()},
      {"voxels", tree.leaf_count()},
      {"nodes", tree.parts().octree.node_count()},
      {"memory", tree.bytes()},
      {"orientation", tree.orientation() == Orientation::kOutward ? "outward" : "assumed"},
      {"triangles", tree.triangles() != nullptr},
      {"proximity", tree.has_proximity()}};
  add_measures(line, box_of(tree).sizes(), triangles, tree.source());
  line["levels"] = ordered_json::array();
  for (const LevelStatistics& level : levels) {
    ordered_json row{{"level", level.level}, {"edge", level.edge}, {"nodes", level.nodes}};
    for (const LevelSpheres& spheres : level.spheres) {
      row["volume"][std::string(to_string(spheres.policy))] = spheres.volume;
      row["milliseconds"][std::string(to_string(spheres.policy))] = spheres.milliseconds;
    }
    line["levels"].push_back(row);
  }
  fmt::print("{}\n", line.dump());
}

}  // namespace

void add_info(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("info", "Show the contents of a mesh or a tree, level by level");
  const auto options = std::make_shared<InfoArguments>();
  command->add_option("FILE", options->file, "STL, OBJ, PLY, OFF, glTF or 3MF mesh, or tree")
      ->type_name("FILE")
      ->required();
  command->add_flag("--json", options->json, "print one JSON object");
  add_example(*command, "Example: ist info jaw.ist");
  command->callback(
      [options] { is_tree_file(options->file) ? show_tree(*options) : show_mesh(*options); });
}

}  // namespace ist::cli
