#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/bodies.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/refusals.h"
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

void show_mesh(const InfoArguments& options) {
  const TriangleMesh mesh = read_mesh(options.file);
  const MeshReport report = check_mesh(mesh);
  const Eigen::Vector3d low = report.box_min, high = report.box_max;
  if (options.json) {
    fmt::print("{}\n", ordered_json{{"file", options.file.string()},
                                    {"kind", "mesh"},
                                    {"vertices", report.vertices},
                                    {"triangles", report.triangles},
                                    {"components", report.components},
                                    {"boundary_edges", report.boundary_edges},
                                    {"non_manifold_edges", report.non_manifold_edges},
                                    {"duplicate_triangles", report.duplicate_triangles},
                                    {"degenerate_triangles", report.degenerate_triangles},
                                    {"inconsistent_edges", report.inconsistent_edges},
                                    {"box_min", {low[0], low[1], low[2]}},
                                    {"box_max", {high[0], high[1], high[2]}},
                                    {"warnings", warnings(report)}}
                           .dump());
    return;
  }
  fmt::print("{}: a mesh of {} triangles and {} vertices, {} component{}\n", options.file.string(),
             report.triangles, report.vertices, report.components,
             report.components == 1 ? "" : "s");
  fmt::print("box [{}, {}] [{}, {}] [{}, {}]\n", low[0], high[0], low[1], high[1], low[2], high[2]);
  print_warnings(warnings(report));
}

void show_tree(const InfoArguments& options) {
  const SphereTree tree = read_tree(options.file);
  const std::vector<LevelStatistics> levels = level_statistics(tree);
  const char* orientation = tree.orientation() == Orientation::kOutward ? "outward" : "assumed";
  if (options.json) {
    ordered_json line{{"file", options.file.string()},
                      {"kind", "tree"},
                      {"voxel_size", tree.voxel_size()},
                      {"cells", tree.parts().lattice.cells},
                      {"depth", tree.depth()},
                      {"voxels", tree.leaf_count()},
                      {"nodes", tree.parts().octree.node_count()},
                      {"memory", tree.bytes()},
                      {"orientation", orientation},
                      {"triangles", tree.triangles() != nullptr},
                      {"proximity", tree.has_proximity()},
                      {"levels", ordered_json::array()}};
    for (const LevelStatistics& level : levels) {
      ordered_json row{{"level", level.level}, {"edge", level.edge}, {"nodes", level.nodes}};
      for (const LevelSpheres& spheres : level.spheres) {
        row["volume"][std::string(to_string(spheres.policy))] = spheres.volume;
        row["milliseconds"][std::string(to_string(spheres.policy))] = spheres.milliseconds;
      }
      line["levels"].push_back(row);
    }
    fmt::print("{}\n", line.dump());
    return;
  }
  fmt::print("{}: a tree of {} voxels of edge {}, {} nodes, {:.1f} MB in memory\n",
             options.file.string(), tree.leaf_count(), tree.voxel_size(),
             tree.parts().octree.node_count(), static_cast<double>(tree.bytes()) / 1e6);
  fmt::print("orientation {}, {} triangles kept, {} proximity voxels\n\n", orientation,
             tree.triangles() ? tree.parts().triangles->mesh.triangles.size() : 0,
             tree.parts().proximity ? tree.parts().proximity->octree.leaf_count() : 0);
  fmt::print(
      "volume of the spheres, in circumspheres of a voxel, and time to make them (tight "
      "and slab: to read them)\n");
  fmt::print("{:>5} {:>10} {:>10}", "level", "edge", "nodes");
  for (const LevelSpheres& spheres : levels.front().spheres) {
    fmt::print(" {:>14} {:>9}", to_string(spheres.policy), "ms");
  }
  fmt::print("\n");
  const double unit = unit_ball_volume(tree.voxel_size());
  for (const LevelStatistics& level : levels) {
    fmt::print("{:>5} {:>10.4g} {:>10}", level.level, level.edge, level.nodes);
    for (const LevelSpheres& spheres : level.spheres) {
      fmt::print(" {:>14.0f} {:>9.3f}", spheres.volume / unit, spheres.milliseconds);
    }
    fmt::print("\n");
  }
}

}  // namespace

void add_info(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("info", "Show the contents of a mesh or a tree, level by level");
  const auto options = std::make_shared<InfoArguments>();
  command->add_option("FILE", options->file, "STL, OBJ or PLY mesh, or tree")->required();
  command->add_flag("--json", options->json, "print one JSON object");
  add_example(*command, "Example: ist info jaw.ist");
  command->callback(
      [options] { is_tree_file(options->file) ? show_tree(*options) : show_mesh(*options); });
}

}  // namespace ist::cli
