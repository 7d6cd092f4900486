#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/bench/bench_poses.h"
#include "cli/bench/bench_report.h"
#include "cli/bench/contestants.h"
#include "cli/bench/rivals.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/header_line.h"
#include "cli/load_bodies.h"
#include "cli/measure_progress.h"
#include "cli/poses/pose_file.h"
#include "cli/progress_bar.h"
#include "cli/refusals.h"
#include "ist/base/parallel.h"
#include "ist/models/models.h"
#include "simd/dispatch.h"

namespace ist::cli {
namespace {

constexpr double kJawVoxels = 0.2;  // mm

struct BenchArguments {
  BodyFiles files;
  std::filesystem::path poses;
  std::vector<std::string> against;
  double seconds = 6;
  bool json = false;

  [[nodiscard]] bool own_bodies() const { return !files.fixed.empty(); }
};

std::vector<Rival> rivals_named(const std::vector<std::string>& names) {
  std::vector<Rival> asked;
  for (const Rival& rival : rivals()) {
    if (std::ranges::find(names, rival.name) == names.end()) continue;
    refuse_if(
        !rival.here, "--against",
        fmt::format(
            "this ist was built without {}: install it by ./scripts/setup.sh --peers, "
            "then cmake --preset bench && cmake --build --preset bench --target ist_cli, and run "
            "build/bench/ist bench",
            rival.name));
    asked.push_back(rival);
  }
  return asked;
}

Bodies built_in_jaws(const BodyFiles& options) {
  BuildOptions build;
  build.voxel_size = options.voxel_size.value_or(kJawVoxels);
  build.max_memory = options.max_memory;
  std::vector<std::string> warnings;
  Bodies jaws{build_with_progress("upper jaw", make_jaw(Jaw::kUpper, 1), build, warnings),
              build_with_progress("lower jaw", make_jaw(Jaw::kLower, 1), build, warnings),
              build.spheres};
  print_warnings(warnings);
  return jaws;
}

std::vector<BenchPose> poses_for(const BenchArguments& options, const Bodies& bodies) {
  if (!options.poses.empty()) {
    return poses_among(options.poses, read_poses(options.poses), bodies.fixed, bodies.moving);
  }
  if (!options.own_bodies()) return poses_of_jaws();
  const bool triangles =
      bodies.fixed.triangles() != nullptr && bodies.moving.triangles() != nullptr;
  refuse_if(!triangles, "--poses",
            "needed, because a tree holds no triangles to find a way by: give poses at which the "
            "bodies meet");
  return poses_on_way(bodies.fixed, bodies.moving);
}

std::string bodies_words(const BenchArguments& options, const Bodies& bodies, double seconds) {
  const auto sizes = [](const SphereTree& fixed, const SphereTree& moving) {
    const double a = fixed.voxel_size(), b = moving.voxel_size();
    return a == b ? fmt::format("{:g}", a) : fmt::format("{:g} and {:g}", a, b);
  };
  return fmt::format("{}: voxels of {}, {} and {} of them, loaded in {:.1f} s",
                     options.own_bodies() ? fmt::format("{} and {}", options.files.fixed.string(),
                                                        options.files.moving.string())
                                          : "the built-in jaws",
                     sizes(bodies.fixed, bodies.moving), bodies.fixed.leaf_count(),
                     bodies.moving.leaf_count(), seconds);
}

void run(const BenchArguments& options) {
  const auto begin = std::chrono::steady_clock::now();
  refuse_if(!(options.seconds > 0 && options.seconds <= 3600), "--seconds",
            "give a positive number, 3600 at most");
  refuse_if(options.files.fixed.empty() != options.files.moving.empty(), "FIXED, MOVING",
            "give both bodies, or none for the built-in jaws");
  BenchSetting setting;
  setting.machine = this_machine();
  setting.target = select_kernels({}).target;
  setting.seconds = options.seconds;
  const std::vector<Rival> rivals = rivals_named(options.against);
  const Bodies bodies =
      options.own_bodies() ? load_bodies(options.files) : built_in_jaws(options.files);
  const std::chrono::duration<double> loaded = std::chrono::steady_clock::now() - begin;
  setting.bodies = bodies_words(options, bodies, loaded.count());
  const std::vector<BenchPose> poses = poses_for(options, bodies);

  std::vector<Contestant> contestants = contestants_of(bodies.fixed, bodies.moving, poses);
  if (!rivals.empty()) require_triangles(bodies);
  for (const Rival& rival : rivals) {
    const ScopedThreadLimit one(1);
    for (Contestant& each :
         rival.contestants(*bodies.fixed.triangles(), *bodies.moving.triangles(), poses)) {
      contestants.push_back(std::move(each));
    }
    setting.rivals +=
        fmt::format("{}{} {}", setting.rivals.empty() ? "" : ", ", rival.name, rival.version);
  }
  Contest contest(std::move(contestants), poses);
  {
    ProgressBar progress;
    contest.hold(options.seconds, shown_by(progress, "asking"));
  }
  if (options.json) {
    NamedFiles files;
    if (options.own_bodies())
      files = {{"fixed", options.files.fixed}, {"moving", options.files.moving}};
    print_header("bench", files);
    print_bench_json(setting, contest);
  } else {
    print_bench(setting, contest);
  }
}

}  // namespace

void add_bench(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "bench",
      "Time every way to ask on this machine, in ten seconds, on built-in jaws or two bodies");
  const auto options = std::make_shared<BenchArguments>();
  command
      ->add_option("FIXED", options->files.fixed,
                   "mesh or tree of the body that stays; by default the built-in jaws")
      ->type_name("FILE");
  command->add_option("MOVING", options->files.moving, "mesh or tree of the body that is moved")
      ->type_name("FILE");
  command
      ->add_option("--voxel-size", options->files.voxel_size,
                   "edge of the voxels, mesh units; by default 0.2 of the jaws, 1/500 of the "
                   "smaller body")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--poses", options->poses,
                   "JSON file of poses: those with most and fewest pairs are asked; by default two "
                   "on a straight way that closes the bodies")
      ->type_name("FILE");
  std::vector<std::string> names;
  for (const Rival& rival : rivals()) names.push_back(rival.name);
  command->add_option("--against", options->against, "other libraries to ask too")
      ->delimiter(',')
      ->allow_extra_args(false)  // bodies may come behind it
      ->transform(one_of(names));
  command
      ->add_option("--seconds", options->seconds,
                   "time for all queries; each has three turns at least")
      ->capture_default_str();
  add_units_and_frame(*command, options->files);
  add_max_memory(*command, options->files.max_memory);
  command->add_flag("--json", options->json, "print one JSON object a line");
  add_example(
      *command,
      "All queries take turns, so that other work on the machine affects all of them: ratios "
      "hold, times less.\n"
      "Examples: ist bench\n"
      "          ist bench upper.stl lower.stl --voxel-size 0.4 --json");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
