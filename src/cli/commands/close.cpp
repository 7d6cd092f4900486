#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands/commands.h"
#include "cli/progress_bar.h"
#include "cli/query_options.h"
#include "cli/query_run.h"
#include "ist/measure/first_contact.h"

namespace ist::cli {
namespace {

constexpr double kMostSteps = 1e6;

struct CloseArguments {
  QueryOptions query;
  std::string axis;
  double from = 0, to = 0, step = 0;
  std::optional<double> first_contact;  // tolerance, mesh units
};

std::vector<Eigen::Isometry3d> straight_path(const CloseArguments& options) {
  const double length = std::abs(options.to - options.from);
  refuse_if(!std::isfinite(options.from) || !std::isfinite(options.to), "--from, --to",
            "give finite numbers");
  refuse_if(!(options.step > 0) || !(length / options.step <= kMostSteps), "--step",
            fmt::format("give a positive number that makes at most {:.0f} steps", kMostSteps));
  const auto steps = static_cast<int>(std::floor(length / options.step * (1 + 1e-12)));
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i <= steps; ++i) {
    Eigen::Isometry3d& pose = poses.emplace_back(Eigen::Isometry3d::Identity());
    const double distance = i * options.step;
    pose.translation()[options.axis[0] - 'x'] =
        options.to < options.from ? options.from - distance : options.from + distance;
  }
  return poses;
}

Eigen::Isometry3d displaced(const CloseArguments& options, double displacement) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation()[options.axis[0] - 'x'] = displacement;
  return pose;
}

FirstContact find_first_contact(const Bodies& bodies, const CloseArguments& options) {
  Query query(bodies.fixed, bodies.moving);
  ProgressBar progress;
  progress.begin_stage("looking for the first contact", 1000);
  std::uint64_t told = 0;
  return first_contact(query, displaced(options, options.from), displaced(options, options.to),
                       *options.first_contact, {.proceed = [&](double part) {
                         const auto done = static_cast<std::uint64_t>(1000 * part);
                         progress.add(done - told);
                         told = done;
                         return true;
                       }});
}

// Prints where on the way from --from to --to triangles intersect first.
void print_first_contact(const FirstContact& found, const CloseArguments& options) {
  const auto at = [&](double parameter) {
    return options.from + parameter * (options.to - options.from);
  };
  if (options.query.json) {
    nlohmann::ordered_json line{{"first_contact", to_string(found.status)},
                                {"displacement_lower", std::min(at(found.lower), at(found.upper))},
                                {"displacement_upper", std::max(at(found.lower), at(found.upper))},
                                {"grazed", found.grazed}};
    line["triangles"] = nullptr;
    if (found.triangles) line["triangles"] = {found.triangles->fixed, found.triangles->moving};
    line["distances"] = found.distances;
    fmt::print("{}\n", line.dump());
    return;
  }
  switch (found.status) {
    case FirstContact::Status::kNone:
      fmt::print("first contact: none from {:g} to {:g}\n", options.from, options.to);
      return;
    case FirstContact::Status::kTouchesAtStart:
      fmt::print("first contact: at the start, {:g}: triangles intersect there\n", options.from);
      return;
    case FirstContact::Status::kInsideAtStart:
      fmt::print("first contact: at the start, {:g}: one body is inside the other\n", options.from);
      return;
    default:
      fmt::print("first contact: {}displacement {:.9g} to {:.9g}",
                 found.status == FirstContact::Status::kGrazing ? "only grazing, " : "",
                 at(found.lower), at(found.upper));
  }
  if (found.triangles) {
    fmt::print(", triangles {} and {}", found.triangles->fixed, found.triangles->moving);
  }
  fmt::print("\n");
}

}  // namespace

void add_close(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("close", "Find where two bodies touch, along a straight path");
  const auto options = std::make_shared<CloseArguments>();
  add_query_options(*command, options->query);
  command->add_option("--axis", options->axis, "axis along which the moving body is displaced")
      ->required()
      ->check(CLI::IsMember({"x", "y", "z"}));
  command->add_option("--from", options->from, "first displacement, in mesh units")->required();
  command->add_option("--to", options->to, "last displacement, in mesh units")->required();
  command->add_option("--step", options->step, "distance from one pose to the next, in mesh units")
      ->required();
  command
      ->add_option("--first-contact", options->first_contact,
                   "then find where on the way triangles intersect first, to within this tolerance "
                   "in mesh units, whatever the step; needs meshes, or trees built with --exact")
      ->check(CLI::Range(0.0, std::numeric_limits<double>::max()));
  add_example(*command,
              "Line i is the answer i steps from --from towards --to, which is reached if it is a "
              "whole number\n"
              "of steps away.\n"
              "Example: ist close maxilla.stl mandible.stl --voxel-size 0.4 --axis z --from -3 "
              "--to 0 --step 0.1");
  command->callback([options] {
    const QueryOptions& query = options->query;
    query.check();
    refuse_to_overwrite(query.leaf_pairs, {query.files.fixed, query.files.moving});
    const auto poses = straight_path(*options);
    BodyFiles files = query.body_files();
    files.keep_triangles = files.keep_triangles || options->first_contact;
    const Bodies bodies = load_bodies(files);
    if (options->first_contact) require_triangles(bodies);
    run_queries(bodies, poses, query);
    if (options->first_contact) print_first_contact(find_first_contact(bodies, *options), *options);
  });
}

}  // namespace ist::cli
