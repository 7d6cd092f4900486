#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "answers/extents.h"
#include "answers/json_parts.h"
#include "answers/refusals.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/load_bodies.h"
#include "cli/terminal.h"
#include "ist/base/counted.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"

namespace ist::cli {

using namespace answers;

namespace {

struct BuildArguments {
  std::filesystem::path mesh, output;
  BuildOptions build;
  std::optional<double> voxel_size;  // empty: no voxels
  std::optional<std::string> spheres;
  std::string unit, frame, to_frame;  // empty: unknown
  bool no_triangles = false;
  std::vector<std::string> classes{"surface"};
  bool json = false;
};

// Gives the mesh the frame that the user names, if its file names none.
void take_frame(const std::string& name, const std::filesystem::path& file, TriangleMesh& mesh) {
  if (name.empty()) return;
  const PatientFrame frame = *patient_frame(name);
  refuse_if(contradict(frame, mesh.frame), "--frame",
            "{} says that its frame is {}: leave the option out, or turn the mesh by --to-frame {}",
            file.string(), to_string(mesh.frame), name);
  mesh.frame = frame;
}

constexpr std::string_view kDefaultSpheres = to_string(BuildOptions{}.spheres);

// Refuses the options of voxels without a voxel size.
void check_voxels(const BuildArguments& options) {
  check_voxel_size(options.voxel_size);
  if (options.voxel_size) return;
  constexpr const char* kNeeds = "goes with --voxel-size: without it the tree has triangles alone";
  refuse_if(options.spheres.has_value(), "--spheres", kNeeds);
  refuse_if(options.build.proximity, "--classes", kNeeds);
  refuse_if(options.no_triangles, "--no-triangles", kNeeds);
}

nlohmann::ordered_json json_of_build(const BuildArguments& options, const SphereTree& tree,
                                     std::size_t triangles, std::uint64_t bytes,
                                     const BuildReport& report,
                                     const std::vector<std::string>& warnings) {
  nlohmann::ordered_json line{{"file", options.output.filename().string()},
                              {"triangles", triangles},
                              {"voxel_size", voxel_size_json(tree)},
                              {"spheres", nullptr},
                              {"voxels", nullptr},
                              {"nodes", nullptr},
                              {"depth", nullptr},
                              {"bytes", bytes},
                              {"memory", tree.bytes()},
                              {"unit", json_of(tree.source().unit)},
                              {"frame", json_of(tree.frame())},
                              {"source", json_of(tree.source())}};
  if (tree.has_voxels()) {
    line["spheres"] = to_string(options.build.spheres);
    line["voxels"] = tree.leaf_count();
    line["nodes"] = voxels_of(tree).octree.node_count();
    line["depth"] = tree.depth();
  }
  if (tree.has_proximity()) {
    line["proximity_voxels"] = voxels_of(tree).proximity->octree.leaf_count();
  }
  for (const auto& stage : report.stages) line["milliseconds"][stage.name] = stage.milliseconds;
  line["warnings"] = nlohmann::ordered_json::array();
  for (std::string warning : warnings) {  // which begin with the file, and JSON holds no path
    if (warning.starts_with(options.mesh.string())) {
      warning.replace(0, options.mesh.string().size(), options.mesh.filename().string());
    }
    line["warnings"].push_back(warning);
  }
  return line;
}

void print_build(const BuildArguments& options, const SphereTree& tree, std::size_t triangles,
                 std::uint64_t bytes, const BuildReport& report) {
  const std::string of = tree.has_voxels()
                             ? fmt::format("{} voxels, {} nodes, depth {}", tree.leaf_count(),
                                           voxels_of(tree).octree.node_count(), tree.depth())
                             : fmt::format("{} triangles, no voxels", triangles);
  fmt::print("{}: {}, {:.1f} MB\n", options.output.string(), of, static_cast<double>(bytes) / 1e6);
  if (tree.has_proximity()) {
    fmt::print("proximity voxels: {}\n", voxels_of(tree).proximity->octree.leaf_count());
  }
  for (const auto& stage : report.stages) {
    fmt::print("  {:<18} {:8.1f} ms\n", stage.name, stage.milliseconds);
  }
}

void run(BuildArguments options) {
  options.build.spheres = *sphere_policy(options.spheres.value_or(std::string(kDefaultSpheres)));
  const auto names = [&](const char* name) {
    return std::find(options.classes.begin(), options.classes.end(), name) != options.classes.end();
  };
  refuse_if(!names("surface"), "--classes",
            "surface voxels are always made: give surface,proximity");
  options.build.proximity = names("proximity");
  options.build.voxel_size = options.voxel_size.value_or(0);
  check_voxels(options);
  check_output(options.output, {options.mesh});
  options.build.source = source_of(options.mesh);
  options.build.source.unit = length_unit(options.unit).value_or(LengthUnit::kUnknown);
  options.build.keep_triangles = !options.no_triangles;
  options.build.frame = patient_frame(options.to_frame).value_or(PatientFrame::kUnknown);
  CheckedMesh checked = load_mesh(options.mesh);
  take_frame(options.frame, options.mesh, checked.mesh);
  refuse_if(contradict(options.build.source.unit, checked.mesh.unit), "--unit",
            "{} says that its unit is {}: leave the option out, or, if the file is wrong, convert "
            "it to STL, PLY or OBJ, which say no unit",
            options.mesh.string(), to_string(checked.mesh.unit));
  refuse_if(!options.to_frame.empty() && checked.mesh.frame == PatientFrame::kUnknown, "--to-frame",
            "{} does not say its frame: tell it by --frame", options.mesh.string());
  if (checked.has_border) {
    fmt::print(stderr, "note: {}\n", open_surfaces({options.mesh.string()}));
  }
  const double extent = largest_extent(box_of(checked.mesh));
  const std::size_t triangles = checked.mesh.triangles.size();
  BuildReport report;
  const SphereTree tree = build_with_progress(options.mesh.string(), std::move(checked.mesh),
                                              options.build, checked.warnings, &report);
  if (const auto warning = voxel_warning(options.mesh.string(), tree.voxel_size(), extent)) {
    checked.warnings.push_back(*warning);
  }
  print_warnings(checked.warnings);
  const std::uint64_t bytes = write_tree(tree, options.output);

  if (!options.json) return print_build(options, tree, triangles, bytes, report);
  print_header("build", {{"mesh", options.mesh}});
  print_json(json_of_build(options, tree, triangles, bytes, report, checked.warnings));
}

}  // namespace

void add_build(CLI::App& app) {
  CLI::App* command = app.add_subcommand("build", "Make a tree from a mesh, and save it");
  const auto options = std::make_shared<BuildArguments>();
  add_file(*command, "MESH", options->mesh,
           fmt::format("{} file; no unit is converted", kMeshFormats))
      ->required();
  add_file(*command, "-o,--output", options->output, "the tree file to write, .ist")->required();
  command->add_option("--voxel-size", options->voxel_size,
                      "edge of a voxel, in mesh units; by default the tree gets no voxels, because "
                      "only leaf pairs and contacts need them");
  command
      ->add_option("--unit", options->unit,
                   "unit of the mesh's lengths, which the tree remembers; nothing is converted")
      ->transform(unit_name());
  command
      ->add_option("--frame", options->frame,
                   "frame of the patient that the mesh is in, if its file does not say SPACE=RAS "
                   "or SPACE=LPS")
      ->transform(one_of({"ras", "lps"}));
  command
      ->add_option("--to-frame", options->to_frame,
                   "frame to turn the mesh into: x and y change their signs if it is another one")
      ->transform(one_of({"ras", "lps"}));
  command
      ->add_option("--spheres", options->spheres,
                   "bounds of voxels to save beside simple and table, which need no saving")
      ->transform(one_of(policy_names()))
      ->default_str(std::string(kDefaultSpheres));
  command->add_flag("--no-triangles", options->no_triangles,
                    "make a smaller tree without the triangles, which exact answers need");
  command
      ->add_option("--classes", options->classes,
                   "classes of voxels: surface, or surface,proximity")
      ->delimiter(',')
      // Help and pages would show the check as a choice of one word.
      ->transform(one_of({"surface", "proximity"}).description(""))
      ->type_name("LIST")
      ->capture_default_str();
  add_max_memory(*command, options->build.max_memory);
  command->add_flag("--json", options->json, "print one JSON object");
  add_example(*command, "Example: ist build jaw.stl -o jaw.ist --voxel-size 0.2 --unit mm");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
