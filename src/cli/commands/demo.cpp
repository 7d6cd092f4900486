#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/bodies.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/engine.h"
#include "cli/header_line.h"
#include "cli/refusals.h"
#include "ist/mesh/mesh.h"
#include "ist/models/models.h"
#include "simd/dispatch.h"

namespace ist::cli {
namespace {

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

void print_json(const Engine& engine, SpherePolicy policy, double size, const Rows& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const nlohmann::ordered_json line{{"voxel_size", size},
                                      {"spheres", to_string(policy)},
                                      {"engine", engine.name()},
                                      {"target", engine.target()},
                                      {"workers", engine.workers()},
                                      {"displacement", kClosing[i]},
                                      {"leaf_pairs", rows[i].result.leaf_pairs},
                                      {"sphere_tests", rows[i].result.sphere_tests},
                                      {"microseconds_median", rows[i].microseconds},
                                      {"hertz", 1e6 / rows[i].microseconds}};
    fmt::print("{}\n", line.dump());
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
    if (json) print_json(engine, options.policy, size, rows.back());
  }
  if (json) return;
  fmt::print("{:>6} {:>10} {:>13} {:>10} {:>10} {:>7}\n", "dz", "leaf pairs", "published µs",
             "1 worker", "2 workers", "faster");
  for (std::size_t i = 0; i < kClosing.size(); ++i) {
    const double published = rows[0][i].microseconds, one = rows[1][i].microseconds,
                 two = rows[2][i].microseconds;
    fmt::print("{:>6.1f} {:>10} {:>13.1f} {:>10.1f} {:>10.1f} {:>6.1f}x  {:<36} {:.0f} Hz\n",
               kClosing[i], rows[1][i].result.leaf_pairs, published, one, two, published / one,
               rate_bar(1e6 / one), 1e6 / one);
  }
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
        "one with its lookup table, and the fast one ({} spheres, {}) with one worker\n"
        "and with two. Bars: the rate of one worker, from 10 Hz on, six characters a factor of "
        "ten;\n"
        "| is at 1000 Hz, which a hand needs.\n",
        to_string(BuildOptions{}.spheres), select_kernels({}).target);
  }
  if (!options.keep.empty()) {
    write_stl(upper_mesh, options.keep / "upper_jaw.stl");
    write_stl(lower_mesh, options.keep / "lower_jaw.stl");
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
}

}  // namespace

void add_demo(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("demo", "Make two jaws, close them, and show the time of each query");
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
