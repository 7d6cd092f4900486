#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cli/advise_report.h"
#include "cli/bodies.h"
#include "cli/commands.h"
#include "cli/poses.h"
#include "cli/progress_bar.h"
#include "cli/query_options.h"
#include "ist/base/error.h"
#include "ist/mesh/bounding_box.h"
#include "ist/query/advice/calibration.h"
#include "ist/query/kernels.h"
#include "ist/tree/tree_io.h"
#include "ist/voxel/voxelizer.h"

namespace ist::cli {
namespace {

// Of a body's own: the voxels of the tree whose triangles are asked.
constexpr double kExact = 1.0 / 200;

struct AdviseArguments {
  std::filesystem::path fixed, moving, poses;
  std::optional<double> budget, error;
  std::string axis;
  CalibrationOptions calibration;
  bool json = false;
};

void check(const AdviseArguments& options) {
  if (options.budget.has_value() == options.error.has_value()) {
    throw CLI::ValidationError("--budget-us, --error", "give one of them");
  }
  const auto positive = [](const char* name, const std::optional<double>& value, const char* unit) {
    if (value && !(*value > 0 && std::isfinite(*value))) {
      throw CLI::ValidationError(name, fmt::format("give a positive number of {}", unit));
    }
  };
  positive("--budget-us", options.budget, "microseconds");
  positive("--error", options.error, "mesh units");
  if (!options.poses.empty() && !options.axis.empty()) {
    throw CLI::ValidationError("--axis", "contradicts --poses, which say where bodies are asked");
  }
  static_cast<void>(find_kernels(options.calibration.target));  // before anything is built
  for (const std::filesystem::path& file : {options.fixed, options.moving}) {
    if (is_tree_file(file)) {
      throw CLI::ValidationError(file.string(),
                                 "it is a tree, whose voxel size is fixed already: name the mesh "
                                 "that it was built from");
    }
  }
}

double extent_of(const TriangleMesh& mesh) { return bounding_box(mesh).diagonal().maxCoeff(); }

CheckedMesh load(const std::filesystem::path& file) {
  constexpr double kAny = 1;
  CheckedMesh checked = load_mesh(file);
  const std::optional<Error> flaw = lattice_flaw(checked.mesh, kAny);
  if (flaw && flaw->code() == ErrorCode::kMeshExtent) {  // whatever the voxels
    throw Error(flaw->code(), fmt::format("{}: {}", file.string(), flaw->what()));
  }
  return checked;
}

SizeRange sizes_for(const TriangleMesh& fixed, const TriangleMesh& moving,
                    const AdviseArguments& options) {
  const double of_fixed = extent_of(fixed), of_moving = extent_of(moving);
  if (const auto range = sizes_between(of_fixed, of_moving)) return *range;
  const bool fixed_is_larger = of_fixed > of_moving;
  throw Error(
      ErrorCode::kMeshExtent,
      fmt::format("{}: {:.1e} times as large as {}, and no voxel size is for both: give only the "
                  "part of it that may be touched",
                  (fixed_is_larger ? options.fixed : options.moving).string(),
                  std::max(of_fixed, of_moving) / std::min(of_fixed, of_moving),
                  (fixed_is_larger ? options.moving : options.fixed).string()));
}

// A tree to ask triangles of: how large its voxels are is a matter of time alone, so they are made
// larger where memory is scarce.
SphereTree load_exact(const std::filesystem::path& file, CheckedMesh checked,
                      std::uint64_t max_memory) {
  const double extent = extent_of(checked.mesh);
  BuildOptions build;
  build.voxel_size = kExact * extent;
  build.keep_triangles = true;
  build.max_memory = max_memory;
  while (build.voxel_size < extent && !can_build_tree(checked.mesh, build)) build.voxel_size *= 2;
  SphereTree tree =
      build_with_progress(file.string(), std::move(checked.mesh), build, checked.warnings);
  print_warnings(checked.warnings);
  return tree;
}

std::string name_of(Way way) {
  return fmt::format("{}{}", way.sign < 0 ? "-" : "", "xyz"[way.axis]);
}

Way named_way(const std::string& name) { return {name.back() - 'x', name.size() > 1 ? -1 : +1}; }

ClosingPath find_path(ExactBodies& bodies, const std::string& axis) {
  const Way opening =
      axis.empty() ? opening_of(bodies.fixed_box(), bodies.moving_box()) : named_way(axis);
  const std::optional<ClosingPath> path = find_closing_path(bodies, opening);
  if (!path) {
    throw CLI::ValidationError(
        "--poses", fmt::format("needed, because the bodies do not touch where they are stored, nor "
                               "when the moving one goes from there along {}: give poses at which "
                               "they do, or another --axis",
                               name_of({opening.axis, -opening.sign})));
  }
  fmt::print(stderr,
             "{} poses: opening towards {}, from {:.4g} to {:.4g}; the bodies touch from {:.6g} "
             "on\n",
             Calibration::kPoses, name_of(opening), path->begin, path->end, path->touch);
  return *path;
}

void run(const AdviseArguments& options) {
  check(options);
  std::vector<Eigen::Isometry3d> poses;
  if (!options.poses.empty()) {
    poses = read_poses(options.poses);
    fmt::print(stderr, "{} poses from {}\n", poses.size(), options.poses.string());
  }
  CheckedMesh fixed_mesh = load(options.fixed), moving_mesh = load(options.moving);
  const SizeRange range = sizes_for(fixed_mesh.mesh, moving_mesh.mesh, options);
  const std::uint64_t max_memory = options.calibration.max_memory;
  const SphereTree fixed = load_exact(options.fixed, std::move(fixed_mesh), max_memory);
  const SphereTree moving = load_exact(options.moving, std::move(moving_mesh), max_memory);
  ExactBodies bodies(fixed, moving);
  Calibration calibration =
      poses.empty() ? Calibration(bodies, find_path(bodies, options.axis), options.calibration)
                    : Calibration(bodies, std::move(poses), options.calibration);

  const AdviceGoal goal = options.budget
                              ? AdviceGoal{AdviceGoal::Of::kSlowestQuery, kOfGoal * *options.budget}
                              : AdviceGoal{AdviceGoal::Of::kError, kOfGoal * *options.error};
  const VoxelAdvice advice = [&] {
    Progress progress;
    const ProgressBar bar(progress);
    return advise_voxel_size(goal, range, [&](double voxel_size) {
      const std::optional<SizeMeasure> measured = calibration.measure(voxel_size, &progress);
      // Coarse voxels touch first, and are tried first.
      if (options.budget && measured && measured->most_contacts == 0) {
        throw Error(ErrorCode::kInputInvalid,
                    fmt::format("{}: at no pose do voxels of {:g} touch, so there is nothing that "
                                "takes time: add the poses at which most touches",
                                options.poses.string(), voxel_size));
      }
      return measured;
    });
  }();
  if (options.error && !options.poses.empty() && !advice.measured.empty() &&
      std::all_of(advice.measured.begin(), advice.measured.end(),
                  [](const SizeMeasure& size) { return size.error == 0; })) {
    throw Error(ErrorCode::kInputInvalid,
                fmt::format("{}: no pose shows an error, because surfaces touch there or voxels "
                            "do not: add poses shortly before the bodies touch",
                            options.poses.string()));
  }
  options.json ? print_json(advice) : print_table(advice);
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
  command->add_option("FIXED", options->fixed, "mesh of the body that stays")->required();
  command->add_option("MOVING", options->moving, "mesh of the body that is moved")->required();
  command->add_option("--budget-us", options->budget,
                      "microseconds that a query may take, for all voxels that touch: the smallest "
                      "voxels whose slowest pose takes at most 80 % of it");
  command->add_option(
      "--error", options->error,
      "how far apart surfaces may still be when voxels say first that they touch, "
      "in mesh units: the largest voxels with which they were at most 80 % of that");
  command->add_option("--poses", options->poses,
                      "JSON: an array of objects with \"pose\", 16 numbers, column-major; by "
                      "default a straight way on which the bodies come to where they are stored, "
                      "or from there to a touch");
  command
      ->add_option("--axis", options->axis,
                   "the way on which the moving body leaves the fixed one; by default that on "
                   "which its bounding box leaves soonest")
      ->check(CLI::IsMember({"x", "-x", "y", "-y", "z", "-z"}));
  command->add_option("--workers", options->calibration.workers, "threads of an answer")
      ->check(CLI::Range(1, 2))
      ->capture_default_str();
  command->add_option("--target", options->calibration.target,
                      fmt::format("instruction set: {} on this processor; by default what the "
                                  "environment's IST_TARGET names, or the first",
                                  target_names()));
  add_max_memory(*command, options->calibration.max_memory);
  command->add_flag("--json", options->json, "print one JSON object a line");
  add_example(
      *command,
      "Each voxel size is built and timed, so let nothing else run: what is printed is the "
      "median of the slowest pose.\n"
      "Its error is measured against triangles, also on ways that are inclined and turned a "
      "little; what is certain for\n"
      "any pose is the bound beside it.\n"
      "Example: ist advise maxilla.stl mandible.stl --budget-us 300");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
