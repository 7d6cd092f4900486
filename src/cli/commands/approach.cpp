#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "answers/bodies.h"
#include "answers/json_parts.h"
#include "answers/measure_progress.h"
#include "answers/refusals.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/poses/pose_options.h"
#include "cli/progress_bar.h"
#include "cli/query_options.h"
#include "cli/query_run.h"
#include "cli/terminal.h"
#include "ist/measure/first_contact.h"

namespace ist::cli {

using namespace answers;

namespace {

constexpr double kMostSteps = 1e6;
constexpr double kDefaultSteps = 20;
// As sharp as a person reads: a micrometre of a jaw of 100 mm.
constexpr double kContactTolerance = 1e-5;

struct ApproachArguments {
  QuestionOptions query;
  PoseOptions pose;
  std::string axis;
  double from = 0, to = 0;
  std::optional<double> step, first_contact;  // mesh units
};

// The straight way of the moving body: `start` is where it is named to be.
struct Path {
  GivenPose start;
  Eigen::Vector3d axis;
  double from, to;

  [[nodiscard]] Eigen::Isometry3d at(double displacement) const {
    Eigen::Isometry3d pose = start.pose;
    pose.translation() += displacement * axis;
    return pose;
  }
};

Path path_of(const ApproachArguments& options) {
  refuse_if(!std::isfinite(options.from) || !std::isfinite(options.to), "--from, --to",
            "give finite numbers");
  return {options.pose.poses_named().front(), axis_named(options.axis, "--axis"), options.from,
          options.to};
}

std::vector<AskedPose> poses_along(const Path& path, const std::optional<double>& asked) {
  const double length = std::abs(path.to - path.from);
  const double step = asked.value_or(length > 0 ? length / kDefaultSteps : 1);
  refuse_if(!(step > 0) || !(length / step <= kMostSteps), "--step",
            "give a positive number that makes at most {:.0f} steps", kMostSteps);
  const auto steps = static_cast<int>(std::floor(length / step * (1 + 1e-12)));
  std::vector<AskedPose> poses;
  for (int i = 0; i <= steps; ++i) {
    const double displacement = path.from + (path.to < path.from ? -i : i) * step;
    poses.push_back({path.at(displacement), displacement, path.start.rotation_error});
  }
  return poses;
}

FirstContact find_first_contact(const Bodies& bodies, const Path& path, double tolerance) {
  Query query(bodies.fixed, bodies.moving);
  ProgressBar progress;
  return first_contact(query, path.at(path.from), path.at(path.to), tolerance,
                       {.proceed = shown_by(progress, "looking for the first contact")});
}

double displacement_at(const Path& path, double parameter) {
  return path.from + parameter * (path.to - path.from);
}

// A point where the triangles of a contact meet, fixed coordinates. Precondition: there are some.
Eigen::Vector3d contact_point(const FirstContact& found, const Path& path, const Bodies& bodies) {
  return shared_point(bodies, *found.triangles, path.at(displacement_at(path, found.upper)));
}

bool self_intersecting(const Bodies& bodies) {
  return bodies.fixed.self_intersections() > 0 || bodies.moving.self_intersections() > 0;
}

void print_first_contact_json(const FirstContact& found, const Path& path, const Bodies& bodies) {
  const double a = displacement_at(path, found.lower), b = displacement_at(path, found.upper);
  nlohmann::ordered_json line{{"first_contact", to_string(found.status)},
                              {"displacement_lower", std::min(a, b)},
                              {"displacement_upper", std::max(a, b)},
                              {"grazed", found.grazed},
                              {"passes", found.passes},
                              {"triangles", nullptr},
                              {"point", nullptr},
                              {"contact_fixed", nullptr},
                              {"contact_moving", nullptr},
                              {"contact_normal", nullptr},
                              {"self_intersecting", self_intersecting(bodies)},
                              {"distances", found.distances}};
  if (found.triangles) {
    const Eigen::Vector3d point = contact_point(found, path, bodies);
    line["triangles"] = pair_json(found.triangles);
    line["point"] = point_json(point);
  }
  if (found.place) {
    line["contact_fixed"] = point_json(found.place->fixed_point);
    line["contact_moving"] = point_json(found.place->moving_point);
    if (!found.normal.isZero(0)) line["contact_normal"] = point_json(found.normal);
  }
  print_json(line);
}

void print_first_contact(const FirstContact& found, const Path& path, const Bodies& bodies,
                         double tolerance) {
  switch (found.status) {
    case FirstContact::Status::kNone:
      fmt::print("first contact: none from {:g} to {:g}\n", path.from, path.to);
      return;
    case FirstContact::Status::kTouchesAtStart:
      fmt::print("first contact: at the start, {:g}: triangles intersect there\n", path.from);
      return;
    case FirstContact::Status::kInsideAtStart:
      fmt::print("first contact: at the start, {:g}: one body is inside the other{}\n", path.from,
                 self_intersecting(bodies) ? "; a surface intersects itself" : "");
      return;
    default:
      break;
  }
  const double a = displacement_at(path, found.lower), b = displacement_at(path, found.upper);
  // One digit more than the tolerance has.
  const int digits = std::clamp(1 - static_cast<int>(std::floor(std::log10(tolerance))), 0, 17);
  const LengthUnit unit = bodies.unit();
  fmt::print("first contact: {}displacement {:.{}f} to {:.{}f}{}{}",
             found.status == FirstContact::Status::kGrazing ? "only grazing, " : "", std::min(a, b),
             digits, std::max(a, b), digits, unit == LengthUnit::kUnknown ? "" : " ",
             unit == LengthUnit::kUnknown ? "" : to_string(unit));
  if (found.triangles) {
    const Eigen::Vector3d point = contact_point(found, path, bodies);
    fmt::print(", at ({:.5g}, {:.5g}, {:.5g}), triangles {} and {}", point[0], point[1], point[2],
               found.triangles->fixed, found.triangles->moving);
  }
  if (!found.normal.isZero(0)) {
    fmt::print(", normal ({:.3f}, {:.3f}, {:.3f})", found.normal[0], found.normal[1],
               found.normal[2]);
  }
  fmt::print("\n");
}

// Without triangles there is no first contact to tell, unless it was asked by name.
void tell_first_contact(const Bodies& bodies, const Path& path, const ApproachArguments& options) {
  const bool triangles =
      bodies.fixed.triangles() != nullptr && bodies.moving.triangles() != nullptr;
  if (!triangles && !options.first_contact) {
    fmt::print("{}\n", options.query.json ? R"({"first_contact":null})"
                                          : "first contact: not known without triangles");
    return;
  }
  const double tolerance = options.first_contact.value_or(kContactTolerance * bodies.extent());
  const FirstContact found = find_first_contact(bodies, path, tolerance);
  options.query.json ? print_first_contact_json(found, path, bodies)
                     : print_first_contact(found, path, bodies, tolerance);
}

void run(const ApproachArguments& options) {
  const QuestionOptions& query = options.query;
  query.check();
  check_output(query.contacts, {query.files.fixed, query.files.moving, options.pose.matrix});
  const Path path = path_of(options);
  const std::vector<AskedPose> poses = poses_along(path, options.step);
  const Bodies bodies = load_bodies(query.body_files());
  if (!query.json) echo_pose(options.pose, path.start.pose);
  if (options.first_contact) require_triangles(bodies);
  const Meeting meeting = run_queries(bodies, poses, query);
  tell_first_contact(bodies, path, options);
  if (query.fail_if_touching) fail_where_they_meet(meeting);
}

}  // namespace

void add_approach(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "approach",
      "Find where two bodies touch along a straight path, and where on it they first do");
  const auto options = std::make_shared<ApproachArguments>();
  command->add_option("--axis", options->axis, "direction of the path: x, y, z, -x, -y or -z")
      ->type_name("AXIS")
      ->required();
  command->add_option("--from", options->from, "first displacement along it, mesh units")
      ->required();
  command->add_option("--to", options->to, "last displacement, mesh units")->required();
  command->add_option("--step", options->step,
                      "from one pose to the next, mesh units; by default a 20th of the path");
  command
      ->add_option(
          "--first-contact", options->first_contact,
          "how sharp the first contact shall be, mesh units, whatever the step; by default "
          "a 100,000th of the smaller body's largest extent")
      ->check(tolerance());
  add_query_options(*command, options->query);
  add_pose_options(*command, options->pose, Poses::kOne);
  add_example(*command,
              "The pose that is named, or as stored, is displacement 0. Line i is the answer i "
              "steps from --from\n"
              "towards --to, which is reached if it is a whole number of steps away.\n"
              "Example: ist approach upper.stl lower.stl --axis -z --from 3 --to 0");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
