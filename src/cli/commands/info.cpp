#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "answers/body_json.h"
#include "answers/extents.h"
#include "answers/json_parts.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/load_bodies.h"
#include "cli/terminal.h"
#include "ist/base/counted.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/mesh_source.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"

namespace ist::cli {

using namespace answers;

namespace {

void print_extent(const Eigen::AlignedBox3d& box, LengthUnit unit) {
  const Eigen::Vector3d sides = box.sizes();
  if (unit == LengthUnit::kUnknown) {
    fmt::print("extent {} (as mm: {}; as inches: {})\n", sides_text(sides),
               size_text(sides, LengthUnit::kMillimetre), size_text(sides, LengthUnit::kInch));
  } else {
    fmt::print("extent {} {} ({})\n", sides_text(sides), to_string(unit), size_text(sides, unit));
  }
  fmt::print("box {}\n", box_text(box));
}

void print_frame(PatientFrame frame) {
  if (frame == PatientFrame::kUnknown) return;
  fmt::print("frame {}: +x to the patient's {}, +y to the {}\n", to_string(frame),
             frame == PatientFrame::kRas ? "right" : "left",
             frame == PatientFrame::kRas ? "front" : "back");
}

void print_topology(const MeshReport& report, LengthUnit unit) {
  fmt::print("{}, {}", report.closed ? "closed" : "open",
             report.consistent ? "wound consistently" : "not wound consistently");
  if (report.closed && report.consistent) {
    fmt::print(", volume {}", number_text(report.signed_volume));
    if (unit != LengthUnit::kUnknown) fmt::print(" {}³", to_string(unit));
  }
  fmt::print("\n");
  if (report.self_intersections == 0) return;
  fmt::print("{}{}, first:\n", report.self_intersections_complete ? "" : "at least ",
             counted(report.self_intersections, "pair of triangles intersects",
                     "pairs of triangles intersect"));
  for (const SelfIntersection& one : report.first_self_intersections) {
    fmt::print("  triangles {} and {} near ({:g}, {:g}, {:g})\n", one.triangles[0],
               one.triangles[1], one.near[0], one.near[1], one.near[2]);
  }
}

void print_source(const MeshSource& source) {
  fmt::print("built of {}", source.name.empty() ? "a mesh of unknown name" : source.name);
  if (source.hash != 0) fmt::print(", XXH3 {:016x}", source.hash);
  fmt::print(", unit {}\n", to_string(source.unit));
}

void print_levels(const SphereTree& tree, const std::vector<LevelStatistics>& levels) {
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

// Prints for people the counts, size, topology and box of a mesh, and its warnings to stderr.
void print_mesh(const std::filesystem::path& file, const MeshReport& report,
                const TriangleMesh& mesh) {
  fmt::print("{}: a mesh of {} and {}, {}\n", file.string(), counted(report.triangles, "triangle"),
             counted(report.vertices, "vertex", "vertices"),
             counted(report.components, "component"));
  print_extent({report.box_min, report.box_max}, mesh.unit);
  print_frame(mesh.frame);
  print_topology(report, mesh.unit);
  print_warnings(warnings(report));
}

// Prints for people the counts, source, size and levels of a tree, and the topology of its
// triangles if it keeps any.
void print_tree(const std::filesystem::path& file, const SphereTree& tree,
                const std::optional<MeshReport>& triangles,
                const std::vector<LevelStatistics>& levels) {
  const std::string of =
      tree.has_voxels()
          ? fmt::format("{} of edge {}, {}", counted(tree.leaf_count(), "voxel"), tree.voxel_size(),
                        counted(voxels_of(tree).octree.node_count(), "node"))
          : "triangles without voxels";
  fmt::print("{}: a tree of {}, {:.1f} MB in memory\n", file.string(), of,
             static_cast<double>(tree.bytes()) / 1e6);
  print_source(tree.source());
  print_extent(box_of(tree), tree.source().unit);
  print_frame(tree.frame());
  if (triangles) print_topology(*triangles, tree.source().unit);
  fmt::print("orientation {}, {} kept",
             tree.orientation() == Orientation::kOutward ? "outward" : "assumed",
             counted(triangles ? triangles->triangles : 0, "triangle"));
  if (!tree.has_voxels()) return fmt::print("\n");
  fmt::print(", {}\n\n",
             counted(tree.has_proximity() ? voxels_of(tree).proximity->octree.leaf_count() : 0,
                     "proximity voxel"));
  print_levels(tree, levels);
}

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
  add_file(*command, "FILE", options->file, fmt::format("{} mesh, or tree", kMeshFormats))
      ->required();
  command->add_flag("--json", options->json, "print one JSON object");
  add_example(*command, "Example: ist info jaw.ist");
  command->callback(
      [options] { is_tree_file(options->file) ? show_tree(*options) : show_mesh(*options); });
}

}  // namespace ist::cli
