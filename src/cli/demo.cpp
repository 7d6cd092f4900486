#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/bodies.h"
#include "cli/commands.h"
#include "cli/query_options.h"
#include "ist/mesh/jaw_model.h"
#include "ist/mesh/mesh_io.h"
#include "ist/query/reference.h"

namespace ist::cli {
namespace {

struct Options {
  std::vector<double> voxel_sizes{0.8, 0.4, 0.2};
  std::uint64_t seed = 1;
  std::filesystem::path keep;
  bool json = false;
};

// Displacements of the lower jaw along z, mm: apart, at first contact, and closed.
constexpr std::array kClosing = {-5.0, -3.0, -2.0, -1.5, -1.0, -0.5, 0.0};
constexpr std::size_t kRepeats = 5;

struct Row {
  double displacement, microseconds;
  QueryResult result;
};

// Times go round the whole closing, so that no pose is asked twice in a row.
std::vector<Row> ask(ReferenceQuery& query, std::vector<Contact>& contacts) {
  std::vector<Row> rows;
  std::vector<std::array<double, kRepeats>> times(kClosing.size());
  for (const double displacement : kClosing) rows.push_back({displacement, 0, {}});
  for (std::size_t round = 0; round < kRepeats; ++round) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation()[2] = rows[i].displacement;
      const auto begin = std::chrono::steady_clock::now();
      rows[i].result = query.collide(pose, contacts);
      const auto end = std::chrono::steady_clock::now();
      times[i][round] = std::chrono::duration<double, std::micro>(end - begin).count();
    }
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::sort(times[i].begin(), times[i].end());
    rows[i].microseconds = times[i][kRepeats / 2];
  }
  return rows;
}

// A bar on a scale of powers of ten, 10 Hz at its left end.
std::string rate_bar(double hertz) {
  constexpr double kCharactersADecade = 8;
  const double length = kCharactersADecade * std::log10(std::max(hertz, 10.0) / 10);
  return std::string(static_cast<std::size_t>(length), '#');
}

void close_jaws(const SphereTree& upper, const SphereTree& lower, SpherePolicy policy,
                const Options& options) {
  ReferenceQuery query(upper, lower, policy);
  std::vector<Contact> contacts(1 << 20);
  const double size = upper.lattice().voxel_size;
  if (!options.json) {
    fmt::print("\n{} spheres, voxels of {} mm ({} and {}), reference query\n", to_string(policy),
               size, upper.octree().leaf_count(), lower.octree().leaf_count());
    fmt::print(
        "{:>8} {:>9} {:>10} {:>9}  rate (10 Hz, then a decade each 8 characters; a hand needs "
        "1000)\n",
        "dz mm", "contacts", "tests", "µs");
  }
  for (const Row& row : ask(query, contacts)) {
    const double hertz = 1e6 / row.microseconds;
    if (options.json) {
      const nlohmann::ordered_json line{{"voxel_size", size},
                                        {"spheres", to_string(policy)},
                                        {"engine", "reference"},
                                        {"displacement", row.displacement},
                                        {"contacts", row.result.contacts},
                                        {"sphere_tests", row.result.sphere_tests},
                                        {"microseconds_median", row.microseconds},
                                        {"hertz", hertz}};
      fmt::print("{}\n", line.dump());
    } else {
      fmt::print("{:>8.1f} {:>9} {:>10} {:>9.1f}  {:<40} {:.0f} Hz\n", row.displacement,
                 row.result.contacts, row.result.sphere_tests, row.microseconds, rate_bar(hertz),
                 hertz);
    }
  }
}

void run(const Options& options) {
  for (const double size : options.voxel_sizes) {
    if (!(size > 0 && std::isfinite(size))) {
      throw CLI::ValidationError("--voxel-size", "give positive numbers of millimetres");
    }
  }
  const TriangleMesh upper_mesh = make_jaw(Jaw::kUpper, options.seed);
  const TriangleMesh lower_mesh = make_jaw(Jaw::kLower, options.seed);
  if (!options.json) {
    fmt::print("two jaws made from seed {}: upper {} triangles, lower {} triangles\n", options.seed,
               upper_mesh.triangles.size(), lower_mesh.triangles.size());
  }
  if (!options.keep.empty()) {
    write_stl(upper_mesh, options.keep / "upper_jaw.stl");
    write_stl(lower_mesh, options.keep / "lower_jaw.stl");
  }
  for (const double size : options.voxel_sizes) {
    BuildOptions build;
    build.voxel_size = size;
    std::vector<std::string> warnings;
    const auto begin = std::chrono::steady_clock::now();
    const SphereTree upper = build_with_progress("upper jaw", upper_mesh, build, warnings);
    const SphereTree lower = build_with_progress("lower jaw", lower_mesh, build, warnings);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    print_warnings(warnings);
    if (!options.json) fmt::print("\nboth trees at {} mm built in {:.2f} s\n", size, seconds);
    for (const SpherePolicy policy : kSpherePolicies) {
      if (upper.has(policy)) close_jaws(upper, lower, policy, options);
    }
  }
}

}  // namespace

void add_demo(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("demo", "Make two jaws, close them, and show how fast each answer comes");
  const auto options = std::make_shared<Options>();
  command->add_option("--voxel-size", options->voxel_sizes, "edges of the voxels, mm")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--seed", options->seed, "another number makes other jaws")
      ->check(no_minus(""))
      ->capture_default_str();
  command->add_option("--keep", options->keep, "folder to write upper_jaw.stl and lower_jaw.stl to")
      ->check(CLI::ExistingDirectory);
  command->add_flag("--json", options->json, "print one JSON object a line");
  add_example(*command, "Example: ist demo --voxel-size 0.4 --keep .");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
