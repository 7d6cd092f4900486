#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "advise/voxel_advice.h"
#include "answers/engine.h"
#include "answers/refusals.h"
#include "cli/commands/commands.h"
#include "cli/commands/reports.h"
#include "cli/common_options.h"
#include "cli/load_bodies.h"
#include "cli/poses/pose_file.h"
#include "cli/poses/pose_options.h"
#include "cli/progress_bar.h"
#include "cli/terminal.h"
#include "ist/base/counted.h"
#include "ist/base/error.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/bounding_box.h"
#include "ist/tree/sphere_tree.h"
#include "ist/voxel/voxelizer.h"
#include "simd/dispatch.h"

namespace ist::cli {

using namespace answers;

namespace {

struct AdviseArguments {
  std::filesystem::path fixed, moving, poses;
  std::optional<double> budget, error;
  std::string axis;
  MeasureOptions measure;
  bool json = false;
};

void check(const AdviseArguments& options) {
  refuse_if(options.budget.has_value() == options.error.has_value(), "--budget-us, --error",
            "give one of them");
  const auto positive = [](const char* name, const std::optional<double>& value, const char* unit) {
    refuse_if(value && !(*value > 0 && std::isfinite(*value)), name, "give a positive number of {}",
              unit);
  };
  positive("--budget-us", options.budget, "microseconds");
  positive("--error", options.error, "mesh units");
  refuse_if(!options.poses.empty() && !options.axis.empty(), "--axis",
            "contradicts --poses, which give the poses to measure");
  static_cast<void>(select_kernels(options.measure.target));  // before anything is built
  for (const std::filesystem::path& file : {options.fixed, options.moving}) {
    refuse_if(
        is_tree_file(file), file.string(),
        "it is a tree, whose voxel size is fixed already: name the mesh that it was built from");
  }
}

double extent_of(const TriangleMesh& mesh) { return bounding_box(mesh).diagonal().maxCoeff(); }

CheckedMesh load(const std::filesystem::path& file) {
  constexpr double kAny = 1;
  CheckedMesh checked = load_mesh(file);
  const std::optional<Error> flaw = lattice_flaw(checked.mesh, kAny);
  if (flaw && flaw->code() == ErrorCode::kMeshExtent) {  // at any voxel size
    throw_error(flaw->code(), "{}: {}", file.string(), flaw->what());
  }
  return checked;
}

double coarsest_for(const TriangleMesh& fixed, const TriangleMesh& moving,
                    const AdviseArguments& options) {
  const double of_fixed = extent_of(fixed), of_moving = extent_of(moving);
  if (const auto coarsest = coarsest_size(of_fixed, of_moving)) return *coarsest;
  const bool fixed_is_larger = of_fixed > of_moving;
  const std::filesystem::path& larger = fixed_is_larger ? options.fixed : options.moving;
  const std::filesystem::path& smaller = fixed_is_larger ? options.moving : options.fixed;
  throw_error(ErrorCode::kMeshExtent,
              "{}: {:.1e} times as large as {}, so no voxel size suits both: give only the part of "
              "it that can be in contact",
              larger.string(), std::max(of_fixed, of_moving) / std::min(of_fixed, of_moving),
              smaller.string());
}

// Builds a tree without voxels for exact queries.
SphereTree build_exact(const std::filesystem::path& file, TriangleMesh mesh,
                       std::uint64_t max_memory, std::vector<std::string>& warnings,
                       ProgressBar& bar) {
  BuildOptions build;
  build.max_memory = max_memory;
  SphereTree tree =
      build_with_progress(file.string(), std::move(mesh), build, warnings, nullptr, &bar);
  bar.end_part();
  return tree;
}

void run(const AdviseArguments& options) {
  check(options);
  std::vector<Eigen::Isometry3d> poses;
  if (!options.poses.empty()) {
    poses = read_poses(options.poses);
    fmt::print(stderr, "{} from {}\n", counted(poses.size(), "pose"), options.poses.string());
  }
  CheckedMesh fixed_mesh = load(options.fixed), moving_mesh = load(options.moving);
  const auto refuse_other = [&](const char* what, auto of_fixed, auto of_moving) {
    refuse_if(contradict(of_fixed, of_moving), options.moving.string(),
              "its {0} is {1}, and the {0} of {2} is {3}: export both in one {0}", what,
              to_string(of_moving), options.fixed.string(), to_string(of_fixed));
  };
  refuse_other("frame", fixed_mesh.mesh.frame, moving_mesh.mesh.frame);
  refuse_other("unit", fixed_mesh.mesh.unit, moving_mesh.mesh.unit);
  const double coarsest = coarsest_for(fixed_mesh.mesh, moving_mesh.mesh, options);
  const std::uint64_t max_memory = options.measure.max_memory;
  for (const CheckedMesh* mesh : {&fixed_mesh, &moving_mesh}) print_warnings(mesh->warnings);
  std::vector<std::string> turned;  // said when the bar is gone
  constexpr unsigned kBuilds = 2, kWay = 1;
  std::optional<ProgressBar> bar(std::in_place, kBuilds + kWay + kMostSizes);
  const SphereTree fixed =
      build_exact(options.fixed, std::move(fixed_mesh.mesh), max_memory, turned, *bar);
  const SphereTree moving =
      build_exact(options.moving, std::move(moving_mesh.mesh), max_memory, turned, *bar);
  std::optional<ClosingPath> path;
  if (poses.empty()) {
    bar->begin_stage("looking for the closing path", 0);
    path = find_closing_way(fixed, moving, options.axis);
    poses = path->poses();
  }
  bar->end_part();
  Query exact(fixed, moving);

  const AdviceGoal goal = options.budget
                              ? AdviceGoal{AdviceGoal::Of::kSlowestQuery, kOfGoal * *options.budget}
                              : AdviceGoal{AdviceGoal::Of::kError, kOfGoal * *options.error};
  const VoxelAdvice advice = advise_voxel_size(goal, coarsest, [&](double voxel_size) {
    const auto measured = measure_size(exact, poses, path, voxel_size, options.measure, *bar);
    bar->end_part();
    // Coarse voxels overlap first, and are tried first.
    if (options.budget && measured && measured->max_leaf_pairs == 0) {
      throw_error(ErrorCode::kInputInvalid,
                  "{}: at no pose do voxels of {:g} touch, so no query takes time: add the poses "
                  "with most contact",
                  options.poses.string(), voxel_size);
    }
    return measured;
  });
  bar.reset();
  print_warnings(turned);
  if (options.error && !options.poses.empty() && !advice.measured.empty() &&
      std::all_of(advice.measured.begin(), advice.measured.end(),
                  [](const SizeMeasure& size) { return size.error == 0; })) {
    throw_error(ErrorCode::kInputInvalid,
                "{}: no pose shows an error, because at each the surfaces touch or the voxels do "
                "not: add poses shortly before the bodies touch",
                options.poses.string());
  }
  if (options.json) {
    print_header("advise", {{"fixed", options.fixed}, {"moving", options.moving}});
    print_json(advice);
  } else {
    print_table(advice);
  }

  if (!advice.recommended) throw std::runtime_error(why_none(advice, goal));
  if (!options.json) {
    print_build_commands(advice.measured[*advice.recommended].voxel_size, options.fixed,
                         options.moving, max_memory);
  }
  const bool is_last = *advice.recommended + 1 == advice.measured.size();
  if (options.budget && is_last && advice.too_fine) {
    fmt::print(
        stderr,
        "note: {:g} needs more memory than --max-memory allows, or is too fine for a lattice\n",
        *advice.too_fine);
  }
}

}  // namespace

void add_advise(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "advise", "Recommend a voxel size for a time or an error, measured on your own meshes");
  const auto options = std::make_shared<AdviseArguments>();
  add_file(*command, "FIXED", options->fixed, "mesh of the body that stays")->required();
  add_file(*command, "MOVING", options->moving, "mesh of the body that is moved")->required();
  command->add_option("--budget-us", options->budget,
                      "microseconds for a query of all leaf pairs: recommends the smallest voxels "
                      "whose slowest pose takes at most 80 % of them");
  command->add_option("--error", options->error,
                      "largest distance between surfaces whose voxels touch, in mesh units: "
                      "recommends the largest voxels with which at most 80 % of it was measured");
  add_file(*command, "--poses", options->poses,
           "JSON: an array of objects with \"pose\", 16 numbers, column by column; by default a "
           "straight closing path to the stored pose, or from there to first contact");
  command
      ->add_option("--axis", options->axis,
                   "direction in which the moving body leaves the fixed one; by default the "
                   "direction in which its bounding box leaves soonest")
      ->transform(one_of({"x", "-x", "y", "-y", "z", "-z"}));
  command->add_option("--workers", options->measure.workers, "threads of a query")
      ->check(CLI::Range(1, 2))
      ->capture_default_str();
  command
      ->add_option("--target", options->measure.target,
                   "instruction set, one that ist --version lists; by default IST_TARGET of the "
                   "environment, or the first")
      ->type_name("NAME");
  add_max_memory(*command, options->measure.max_memory);
  command->add_flag("--json", options->json, "print one JSON object a line");
  add_example(*command,
              "Each voxel size is built and timed, so let nothing else run: the printed time is "
              "the median of the slowest pose.\n"
              "The error is measured against triangles, on the same path; the bound beside it is "
              "certain for any pose.\n"
              "Example: ist advise maxilla.stl mandible.stl --budget-us 300");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
