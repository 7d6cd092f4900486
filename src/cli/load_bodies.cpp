#include "cli/load_bodies.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <system_error>
#include <utility>

#include "answers/extents.h"
#include "answers/json_parts.h"
#include "answers/refusals.h"
#include "cli/common_options.h"
#include "cli/progress_bar.h"
#include "ist/base/counted.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/mesh_source.h"
#include "ist/tree/tree_parts.h"

namespace ist::cli {

using namespace answers;

namespace {

// Refuses an option that names another unit than the file. To leave the option out is no remedy:
// the other file may state no unit, and would be taken to be in this file's unit.
void require_unit(LengthUnit told, LengthUnit stated, const char* option, const std::string& file) {
  refuse_if(contradict(told, stated), option,
            "{} says that its unit is {}: name the unit of the first file by --unit, "
            "and of the second by --unit-moving; if the file is wrong, convert it to "
            "STL, PLY or OBJ, which say no unit",
            file, to_string(stated));
}

// A body before its tree is built.
struct LoadedBody {
  // `told` is the unit that the option names.
  LoadedBody(const std::filesystem::path& path, LengthUnit told, const char* option)
      : file(path), unit(told) {
    if (is_tree_file(file)) {
      tree = read_tree(file);
      source = tree->source();
      require_unit(told, source.unit, option, name());
      if (source.unit != LengthUnit::kUnknown) unit = source.unit;
    } else {
      source = source_of(file);
      checked = load_mesh(file);
      const LengthUnit stated = checked.mesh.unit;
      require_unit(told, stated, option, name());
      if (stated != LengthUnit::kUnknown) unit = stated;
    }
    source.unit = unit;
    extent = largest_extent(tree ? box_of(*tree) : box_of(checked.mesh));
  }
  [[nodiscard]] std::string name() const { return file.string(); }
  [[nodiscard]] bool has_triangles() const { return !tree || tree->triangles() != nullptr; }
  [[nodiscard]] PatientFrame frame() const { return tree ? tree->frame() : checked.mesh.frame; }

  std::filesystem::path file;
  LengthUnit unit;
  std::optional<SphereTree> tree;  // empty of a mesh
  CheckedMesh checked;
  MeshSource source;
  double extent = 0;
};

void note(const std::string& sentence) { std::fprintf(stderr, "note: %s\n", sentence.c_str()); }

// Takes the tree out of `body`, or builds it of its mesh, without voxels if the size is 0.
SphereTree take_tree(LoadedBody& body, const BodyFiles& files, double voxel_size) {
  if (body.tree) return std::move(*body.tree);
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.spheres = files.policy.value_or(options.spheres);
  options.max_memory = files.max_memory;
  options.source = body.source;
  options.frame = files.to_frame;
  SphereTree tree = build_with_progress(body.name(), std::move(body.checked.mesh), options,
                                        body.checked.warnings);
  print_warnings(body.checked.warnings);
  return tree;
}

// Converts the moving mesh to the unit of the fixed body, if --unit-moving asks for it, and refuses
// two known units otherwise. Returns the factor.
double convert_unit(const LoadedBody& fixed, LoadedBody& moving, bool is_moving_told) {
  constexpr LengthUnit kUnknown = LengthUnit::kUnknown;
  refuse_if(is_moving_told && fixed.unit == kUnknown, "--unit-moving",
            "the unit of {} is not known: give --unit too", fixed.name());
  if (fixed.unit == moving.unit) return 1;
  if (fixed.unit == kUnknown || moving.unit == kUnknown) {
    const bool is_fixed_known = moving.unit == kUnknown;
    const LoadedBody &known = is_fixed_known ? fixed : moving,
                     &other = is_fixed_known ? moving : fixed;
    note(
        fmt::format("{} says no unit, and is taken to be in {}, as {} is: if it is not, give "
                    "--unit and --unit-moving",
                    other.name(), to_string(known.unit), known.name()));
    return 1;
  }
  refuse_if(moving.tree.has_value(), moving.name(),
            "the tree is in {}, and {} in {}: name the tree's mesh, and its unit by "
            "--unit-moving, and it is converted",
            to_string(moving.unit), fixed.name(), to_string(fixed.unit));
  refuse_if(!is_moving_told, moving.name(),
            "its unit is {}, and the unit of {} is {}: give --unit-moving {} to convert the mesh",
            to_string(moving.unit), fixed.name(), to_string(fixed.unit), to_string(moving.unit));
  // Both in micrometres are whole numbers, so that the factor is rounded once.
  const double factor = std::round(1e6 * metres_per_unit(moving.unit)) /
                        std::round(1e6 * metres_per_unit(fixed.unit));
  for (Eigen::Vector3d& vertex : moving.checked.mesh.vertices) vertex *= factor;
  moving.extent *= factor;
  note(fmt::format("{} was converted from {} to {}", moving.name(), to_string(moving.unit),
                   to_string(fixed.unit)));
  moving.unit = moving.source.unit = moving.checked.mesh.unit = fixed.unit;
  return factor;
}

// Refuses bodies in different frames, unless they are to be turned into one.
void check_frames(const LoadedBody& fixed, const LoadedBody& moving, PatientFrame to_frame) {
  for (const LoadedBody* body : {&fixed, &moving}) {
    const bool turns = contradict(body->frame(), to_frame);
    refuse_if(turns && body->tree, body->name(),
              "the tree is in the frame {}: name its mesh, or build it again by 'ist "
              "build --to-frame {}'",
              to_string(body->frame()), to_string(to_frame));
    if (turns) {
      note(fmt::format("{} was turned from the frame {} to {}", body->name(),
                       to_string(body->frame()), to_string(to_frame)));
    } else if (to_frame != PatientFrame::kUnknown && body->frame() == PatientFrame::kUnknown) {
      note(fmt::format("{} does not say its frame, and stays as it is", body->name()));
    }
  }
  if (to_frame != PatientFrame::kUnknown || !contradict(fixed.frame(), moving.frame())) return;
  const PatientFrame common = moving.tree && !fixed.tree ? moving.frame() : fixed.frame();
  const bool both_are_trees = fixed.tree && moving.tree;
  refuse_if(true, moving.name(), "its frame is {}, and the frame of {} is {}: {} --to-frame {}{}",
            to_string(moving.frame()), fixed.name(), to_string(fixed.frame()),
            both_are_trees ? "build it again of its mesh by 'ist build" : "give", to_string(common),
            both_are_trees ? "'" : " to turn the mesh");
}

// Returns the voxel size of bodies without a --voxel-size, and says so on stderr.
double default_voxel_size(double extent) {
  const double size = rounded_voxel_size(extent);
  std::fprintf(stderr,
               "voxel size %s: 1/%.0f of the smaller body's largest extent; --voxel-size names "
               "another\n",
               fmt::format("{:.3g}", size).c_str(), kVoxelsOfExtent);
  return size;
}

void tell_of_twins(const LoadedBody& fixed, const LoadedBody& moving) {
  std::error_code unknown;
  const bool twins = (fixed.source.hash != 0 && fixed.source.hash == moving.source.hash) ||
                     std::filesystem::equivalent(fixed.file, moving.file, unknown);
  if (twins) {
    note(fmt::format("{} and {} hold one mesh: it is compared with itself", fixed.name(),
                     moving.name()));
  }
}

void warn_of_units(const LoadedBody& fixed, const LoadedBody& moving) {
  constexpr double kRatio = 10;
  const double smaller = std::min(fixed.extent, moving.extent);
  if (!(std::max(fixed.extent, moving.extent) > kRatio * smaller)) return;
  print_warnings(
      {fmt::format("the largest extent of {} is {:.4g}, and that of {} is {:.4g}: if they are in "
                   "different units, give --unit and --unit-moving",
                   fixed.name(), fixed.extent, moving.name(), moving.extent)});
}

}  // namespace

CheckedMesh load_mesh(const std::filesystem::path& file) {
  if (is_tree_file(file)) {
    throw_error(ErrorCode::kNotAMesh, "{}: this is a tree: name the mesh that it was built from",
                file.string());
  }
  CheckedMesh checked{read_mesh(file), {}};
  MeshReport report = check_mesh(checked.mesh);
  checked.has_border = std::exchange(report.boundary_edges, 0) > 0;
  for (const std::string& warning : warnings(report)) {
    checked.warnings.push_back(fmt::format("{}: {}", file.string(), warning));
  }
  return checked;
}

std::string open_surfaces(const std::vector<std::string>& names) {
  return fmt::format(
      "{} {}, as scans usually are: depth there is a lower bound, measured at vertices",
      fmt::join(names, " and "), names.size() == 1 ? "is an open surface" : "are open surfaces");
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  }
}

void check_voxel_size(const std::optional<double>& voxel_size) {
  refuse_if(voxel_size == 0.0, "--voxel-size",
            "0 is no size: give a positive number, or leave the option out for no voxels");
}

SphereTree build_with_progress(const std::string& name, TriangleMesh mesh,
                               const BuildOptions& options, std::vector<std::string>& warnings,
                               BuildReport* report, Progress* progress) {
  std::optional<ProgressBar> bar;
  if (progress == nullptr) progress = &bar.emplace();
  BuildReport own;
  BuildReport& filled = report != nullptr ? *report : own;
  SphereTree tree = build_tree(std::move(mesh), options, &filled, progress);
  if (filled.turned_components > 0) {
    warnings.push_back(fmt::format(
        "{}: {} inside out: turned outward", name,
        counted(filled.turned_components, "closed component was", "closed components were")));
  }
  return tree;
}

void add_units_and_frame(CLI::App& command, BodyFiles& files) {
  const auto add_unit = [&command](const char* name, LengthUnit& unit, const char* help) {
    command
        .add_option_function<std::string>(
            name, [&unit](const std::string& word) { unit = *length_unit(word); }, help)
        ->transform(unit_name());
  };
  add_unit("--unit", files.unit, "unit of the lengths in both files; a file may state its own");
  add_unit("--unit-moving", files.moving_unit,
           "unit of the second file, if it is another one; its mesh is converted");
  command
      .add_option_function<std::string>(
          "--to-frame",
          [&files](const std::string& word) { files.to_frame = *patient_frame(word); },
          "turn meshes into this frame of the patient, if their files say SPACE=RAS or SPACE=LPS")
      ->transform(one_of({"ras", "lps"}));
}

Bodies load_bodies(const BodyFiles& files) {
  check_voxel_size(files.voxel_size);
  const bool is_moving_told = files.moving_unit != LengthUnit::kUnknown;
  LoadedBody fixed(files.fixed, files.unit, "--unit"),
      moving(files.moving, is_moving_told ? files.moving_unit : files.unit,
             is_moving_told ? "--unit-moving" : "--unit");
  const bool both_are_trees = fixed.tree && moving.tree;
  refuse_if(both_are_trees && files.voxel_size, "--voxel-size",
            "both bodies are trees, which have their own voxel sizes: leave it out");
  const double factor = convert_unit(fixed, moving, is_moving_told);
  check_frames(fixed, moving, files.to_frame);
  warn_of_units(fixed, moving);
  using Voxels = BodyFiles::Voxels;
  const bool triangles = fixed.has_triangles() && moving.has_triangles();
  const bool voxels =
      files.voxels == Voxels::kMade || (files.voxels == Voxels::kNeeded && !triangles);
  for (const LoadedBody* body : {&fixed, &moving}) {
    if (files.voxels != Voxels::kMade || !body->tree || body->tree->has_voxels()) continue;
    throw_error(ErrorCode::kVoxelsMissing,
                "{}: the tree holds no voxels, and {} needs them: build it again by ist build with "
                "--voxel-size, or name the mesh",
                body->name(), files.voxels_for);
  }
  double voxel_size = files.voxel_size.value_or(0);
  if (!both_are_trees && !files.voxel_size && voxels) {
    voxel_size = default_voxel_size(std::min(fixed.extent, moving.extent));
  }
  Bodies bodies{take_tree(fixed, files, voxel_size), take_tree(moving, files, voxel_size),
                SpherePolicy::kTable};
  if (files.unit != LengthUnit::kUnknown || is_moving_told) bodies.told_unit = fixed.unit;
  bodies.moving_factor = factor;
  bodies.fixed_name = source_name(fixed.file.filename().string());
  bodies.moving_name = source_name(moving.file.filename().string());
  bodies.fixed_has_border = fixed.checked.has_border;
  bodies.moving_has_border = moving.checked.has_border;
  bodies.policy =
      files.policy.value_or(std::min(bodies.fixed.tightest(), bodies.moving.tightest()));
  if (bodies.have_voxels()) {
    bodies.fixed.require(bodies.policy, fixed.name());
    bodies.moving.require(bodies.policy, moving.name());
  }
  tell_of_twins(fixed, moving);
  if (!voxels) return bodies;
  for (const auto& [body, tree] : {std::pair(&fixed, &bodies.fixed), {&moving, &bodies.moving}}) {
    const auto warning = voxel_warning(body->name(), tree->voxel_size(), body->extent);
    if (warning) print_warnings({*warning});
  }
  return bodies;
}

SphereTree load_body(const std::filesystem::path& file, std::uint64_t max_memory) {
  LoadedBody body(file, LengthUnit::kUnknown, "--unit");
  if (body.checked.has_border) note(open_surfaces({body.name()}));
  BodyFiles files;
  files.max_memory = max_memory;
  return take_tree(body, files, 0);
}

}  // namespace ist::cli
