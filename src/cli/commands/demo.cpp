#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "answers/engine.h"
#include "answers/occlusion/bite_maker.h"
#include "answers/refusals.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/load_bodies.h"
#include "cli/occlusion/bite_tables.h"
#include "cli/terminal.h"
#include "ist/mesh/mesh.h"
#include "ist/models/models.h"
#include "simd/dispatch.h"

namespace ist::cli {

using namespace answers;

namespace {

constexpr const char *kUpper = "upper_jaw.stl", *kLower = "lower_jaw.stl";

struct DemoArguments {
  std::vector<double> voxel_sizes{0.8, 0.4, 0.2};
  std::uint64_t seed = 1;
  std::filesystem::path keep;
  bool json = false;
};

// Displacements of the lower jaw along z, mm: apart, at first contact, and closed.
constexpr std::array kClosing = {-5.0, -3.0, -2.0, -1.5, -1.0, -0.5, 0.0};

// The least number of rounds over all poses, and their least time, for each engine: no pose is
// repeated at once. Engines run one after the other, because an idle second worker sleeps.
constexpr std::size_t kRounds = 5;
constexpr std::chrono::milliseconds kShortest{100};

struct Row {
  QueryResult result;
  std::vector<double> times;
  double microseconds = 0;  // the median
};
using Rows = std::array<Row, kClosing.size()>;

Rows ask(Engine& engine) {
  Rows rows;
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t round = 0;
       round < kRounds || std::chrono::steady_clock::now() - begin < kShortest; ++round) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation()[2] = kClosing[i];
      const Engine::Answer answer = engine.ask(pose);
      rows[i].result = answer.result;
      rows[i].times.push_back(answer.microseconds);
    }
  }
  for (Row& row : rows) {
    const auto middle = row.times.begin() + static_cast<std::ptrdiff_t>(row.times.size() / 2);
    std::nth_element(row.times.begin(), middle, row.times.end());
    row.microseconds = *middle;
  }
  return rows;
}

void print_rows_json(const Engine& engine, SpherePolicy policy, double size, const Rows& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    print_json({{"voxel_size", size},
                {"spheres", to_string(policy)},
                {"engine", engine.name()},
                {"target", engine.target()},
                {"workers", engine.workers()},
                {"displacement", kClosing[i]},
                {"leaf_pairs", rows[i].result.leaf_pairs},
                {"sphere_tests", rows[i].result.sphere_tests},
                {"microseconds_median", rows[i].microseconds},
                {"hertz", 1e6 / rows[i].microseconds}});
  }
}

// Returns a bar on a logarithmic scale from 10 Hz on, with a mark at the rate that a hand needs.
std::string rate_bar(double hertz) {
  constexpr double kCharactersADecade = 6, kHand = 1000;
  const auto length = [](double rate) {
    return static_cast<std::size_t>(kCharactersADecade * std::log10(std::max(rate, 10.0) / 10));
  };
  std::string bar(length(hertz), '#');
  bar.resize(std::max(bar.size(), length(kHand) + 1), ' ');
  bar[length(kHand)] = '|';
  return bar;
}

// Times the published query, and the fast one with one worker and with two.
void close_jaws(const SphereTree& upper, const SphereTree& lower, bool json) {
  const SpherePolicy policy = std::min(upper.tightest(), lower.tightest());
  const std::pair<const char*, EngineOptions> asked[] = {
      {"reference", {.policy = SpherePolicy::kTable}},
      {"simd", {.policy = policy}},
      {"simd", {.policy = policy, .workers = 2}}};
  const double size = upper.voxel_size();
  std::vector<Rows> rows;
  for (const auto& [name, options] : asked) {
    Engine engine(name, upper, lower, options);
    rows.push_back(ask(engine));
    if (json) print_rows_json(engine, options.policy, size, rows.back());
  }
  if (json) return;
  fmt::print("{:>6} {:>13} {:>10} {:>10} {:>10} {:>10} {:>7}\n", "dz", "published µs", "leaf pairs",
             "1 worker", "2 workers", "leaf pairs", "faster");
  for (std::size_t i = 0; i < kClosing.size(); ++i) {
    const double published = rows[0][i].microseconds, one = rows[1][i].microseconds,
                 two = rows[2][i].microseconds;
    fmt::print("{:>6.1f} {:>13.1f} {:>10} {:>10.1f} {:>10.1f} {:>10} {:>6.1f}x  {:<36} {:.0f} Hz\n",
               kClosing[i], published, rows[0][i].result.leaf_pairs, one, two,
               rows[1][i].result.leaf_pairs, published / one, rate_bar(1e6 / one), 1e6 / one);
  }
}

// Prints where the jaws bite, as `ist occlusion` does, and commands to try.
void print_bite_of(const TriangleMesh& upper, const TriangleMesh& lower,
                   const std::filesystem::path& keep) {
  constexpr double kDown = -0.6;  // mm
  std::vector<std::string> warnings;
  const auto whole = [&](const char* name, const TriangleMesh& mesh) {
    return build_with_progress(name, mesh, {}, warnings);
  };
  Bodies bodies{whole("upper jaw", upper), whole("lower jaw", lower), BuildOptions{}.spheres};
  print_warnings(warnings);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().z() = kDown;
  BiteQuestions questions;
  questions.unit = LengthUnit::kMillimetre;
  questions.preset = &presets().front();
  fmt::print("\nTheir bite at dz = {} mm:\n", kDown);
  Progress unseen;  // a fifth of a second
  print_bite(make_bite(bodies, {}, pose, questions, unseen), {});
  if (keep.empty()) {
    fmt::print("\nTry next: {} demo --keep .    (writes the two jaws; then it names more)\n",
               command_word());
    return;
  }
  const std::string files =
      fmt::format("{} {}", quoted((keep / kUpper).string()), quoted((keep / kLower).string()));
  fmt::print(
      "\nWrote {0}. Try next:\n"
      "  {2} occlusion {0} --move 0,0,{1} -o bite.html\n"
      "  {2} collide {0} --move 0,0,-1.5\n"
      "  {2} approach {0} --axis z --from -3 --to 0\n",
      files, kDown, command_word());
}

void run(const DemoArguments& options) {
  for (const double size : options.voxel_sizes) {
    refuse_if(!(size > 0 && std::isfinite(size)), "--voxel-size",
              "give positive numbers of millimetres");
  }
  const TriangleMesh upper_mesh = make_jaw(Jaw::kUpper, options.seed);
  const TriangleMesh lower_mesh = make_jaw(Jaw::kLower, options.seed);
  if (options.json) {
    print_header("demo", {});
  } else {
    fmt::print("Two jaws made from seed {}, upper {} triangles, lower {} triangles.\n",
               options.seed, upper_mesh.triangles.size(), lower_mesh.triangles.size());
    fmt::print(
        "They close along z; at dz = 0 mm they are closed. Microseconds a query: the published\n"
        "one with spheres of its lookup table, and the fast one ({} spheres, {}) with one\n"
        "worker and with two, each beside the leaf pairs that it lists: tighter spheres list "
        "fewer.\n"
        "'ist bench' compares the same spheres. Bars: the rate of one worker, from 10 Hz on, six\n"
        "characters a factor of ten; | is at 1000 Hz, which a hand needs.\n",
        to_string(BuildOptions{}.spheres), select_kernels({}).target);
  }
  if (!options.keep.empty()) {
    write_stl(upper_mesh, options.keep / kUpper);
    write_stl(lower_mesh, options.keep / kLower);
  }
  for (const double size : options.voxel_sizes) {
    BuildOptions build;
    build.voxel_size = size;
    build.keep_triangles = false;
    std::vector<std::string> warnings;
    const auto begin = std::chrono::steady_clock::now();
    const SphereTree upper = build_with_progress("upper jaw", upper_mesh, build, warnings);
    const SphereTree lower = build_with_progress("lower jaw", lower_mesh, build, warnings);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    print_warnings(warnings);
    if (!options.json) {
      fmt::print("\nvoxels of {} mm: {} and {}, both trees built in {:.2f} s\n", size,
                 upper.leaf_count(), lower.leaf_count(), seconds);
    }
    close_jaws(upper, lower, options.json);
  }
  if (!options.json) print_bite_of(upper_mesh, lower_mesh, options.keep);
}

}  // namespace

void add_demo(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "demo", "Make two jaws, close them, and show the time of each query and their bite");
  const auto options = std::make_shared<DemoArguments>();
  command->add_option("--voxel-size", options->voxel_sizes, "edges of the voxels, mm")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--seed", options->seed, "seed of the jaws: another number makes other jaws")
      ->check(whole_number("a seed"))
      ->capture_default_str();
  command->add_option("--keep", options->keep, "folder to write upper_jaw.stl and lower_jaw.stl to")
      ->type_name("FOLDER")
      ->check(CLI::ExistingDirectory);
  command->add_flag("--json", options->json, "print one JSON object a line");
  add_example(*command, "Example: ist demo --voxel-size 0.4 --keep .");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
