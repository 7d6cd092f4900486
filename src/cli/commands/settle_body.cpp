#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "answers/bodies.h"
#include "answers/measure_progress.h"
#include "answers/refusals.h"
#include "answers/settle_json.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/load_bodies.h"
#include "cli/poses/pose_options.h"
#include "cli/progress_bar.h"
#include "cli/terminal.h"
#include "ist/base/files.h"
#include "ist/base/rigid_move.h"
#include "ist/measure/first_contact.h"
#include "ist/measure/settle.h"
#include "sweep/philox.h"

namespace ist::cli {

using namespace answers;

namespace {

using SettleStatus = Settlement::Status;

constexpr std::array kFreedoms = {"x", "y", "z", "roll", "pitch", "yaw"};
constexpr std::uint64_t kMostStarts = 100'000;
constexpr double kDegree = std::numbers::pi / 180;
// The default box: mm and rad.
constexpr double kLargestWay = 2, kLargestTurn = 3 * kDegree;

struct SettleArguments {
  BodyFiles files;
  PoseOptions pose;
  std::string closing = "0,0,1", at, hold, within;
  std::filesystem::path output;
  std::uint64_t starts = 1, seed = 1;
  bool json = false;
};

SettleOptions options_of(const SettleArguments& arguments) {
  SettleOptions options;
  const auto closing = vector_of(arguments.closing);
  if (closing) {
    options.closing = *closing;
  } else {
    options.closing = axis_named(arguments.closing, "--closing");
  }
  if (!arguments.at.empty()) {
    options.load_point = vector_of(arguments.at);
    refuse_if(!options.load_point, "--at", "{}: give x,y,z in mesh units", arguments.at);
  }
  std::istringstream words(arguments.hold);
  for (std::string word; std::getline(words, word, ',');) {
    const auto found = std::find(kFreedoms.begin(), kFreedoms.end(), word);
    refuse_if(found == kFreedoms.end(), "--hold",
              "{} is no freedom: give some of x, y, z, roll, pitch, yaw", word);
    options.held[static_cast<std::size_t>(found - kFreedoms.begin())] = true;
  }
  if (!arguments.within.empty()) {
    const auto box = numbers_of(arguments.within);
    refuse_if(!box || box->size() != 2 || !((*box)[0] > 0) || !((*box)[1] > 0 && (*box)[1] <= 90),
              "--within", "{}: give a way in mesh units and an angle in degrees, such as 2,3",
              arguments.within);
    options.largest_way = (*box)[0];
    options.largest_turn = (*box)[1] * kDegree;
  }
  return options;
}

// The length of 1 mm.
double millimetre_of(const Bodies& bodies) {
  const double metres = metres_per_unit(bodies.unit());
  return metres > 0 ? 1e-3 / metres : 1;
}

// Poses that are spread over half of the box round one, in every freedom that is not held. The
// first is that one itself.
std::vector<Eigen::Isometry3d> spread(const Eigen::Isometry3d& pose,
                                      const SettleArguments& arguments,
                                      const SettleOptions& options) {
  const double way = 0.5 * options.largest_way, turn = 0.5 * options.largest_turn;
  const Eigen::Vector3d load = RigidMove(pose)(*options.load_point);
  std::vector<Eigen::Isometry3d> poses = {pose};
  for (std::uint64_t i = 1; i < arguments.starts; ++i) {
    Philox random(arguments.seed, i);
    std::array<double, 6> at;
    for (std::size_t k = 0; k < 6; ++k) {
      const double number = 2 * random.uniform() - 1;
      at[k] = options.held[k] ? 0 : number * (k < 3 ? way : turn);
    }
    const Eigen::Vector3d axis(at[3], at[4], at[5]);
    const double angle = axis.norm();
    Eigen::Isometry3d start = angle > 0 ? Motion::screw(pose, load, axis, angle, 0).at(1) : pose;
    start.translation() += Eigen::Vector3d(at[0], at[1], at[2]);
    poses.push_back(start);
  }
  return poses;
}

// A pose as a file that read_matrix() reads: a transform of ITK, or rows of numbers.
void write_pose(const Eigen::Isometry3d& pose, const std::filesystem::path& path) {
  OutputFile file(path);
  std::string text;
  const bool is_itk = path.extension() == ".tfm" || path.extension() == ".txt";
  if (is_itk) {
    const Eigen::Isometry3d back = inverse_of(pose);  // maps fixed to moving points
    text =
        "#Insight Transform File V1.0\n#Transform 0\nTransform: AffineTransform_double_3_3\n"
        "Parameters:";
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index j = 0; j < 3; ++j) text += fmt::format(" {:.17g}", back.linear()(i, j));
    }
    for (Eigen::Index i = 0; i < 3; ++i) text += fmt::format(" {:.17g}", back.translation()[i]);
    text += "\nFixedParameters: 0 0 0\n";
  } else {
    for (Eigen::Index i = 0; i < 4; ++i) {
      for (Eigen::Index j = 0; j < 4; ++j) {
        text += fmt::format("{}{:.17g}", j > 0 ? " " : "", pose.matrix()(i, j));
      }
      text += '\n';
    }
  }
  file.write(text.data(), text.size());
  file.commit();
}

std::string words_of(const Settlement& settled) {
  switch (settled.status) {
    case SettleStatus::kRests:
      return "rests";
    case SettleStatus::kRestsLevel:
      return fmt::format("rests, level in {} direction{}", settled.level.size(),
                         settled.level.size() == 1 ? "" : "s");
    case SettleStatus::kLeftTheBox:
      return "left the box: it still closes at the border; give a larger one by --within";
    case SettleStatus::kStopped:
      return "stopped";
    case SettleStatus::kNoFreePose:
      return "no free pose: the bodies intersect, and opening does not part them within the box";
    case SettleStatus::kInvalidPose:
      return "the pose is no rigid motion";
    default:
      return "unknown: no proof that it rests";
  }
}

void print_settled(const Settlement& settled, const Bodies& bodies) {
  const double um = 1e-3 * millimetre_of(bodies);
  const std::string unit =
      bodies.unit() == LengthUnit::kUnknown ? "" : fmt::format(" {}", to_string(bodies.unit()));
  fmt::print("{}{}\n", words_of(settled), settled.rocks ? ", rocks" : "");
  if (!settled.free) return;
  fmt::print(
      "closed by {:.6g}{}; the load point went ({:.4f}, {:.4f}, {:.4f}){}, and the body "
      "turned by ({:.3f}, {:.3f}, {:.3f}) degrees\n",
      settled.closed, unit, settled.moved[0], settled.moved[1], settled.moved[2], unit,
      settled.moved[3] / kDegree, settled.moved[4] / kDegree, settled.moved[5] / kDegree);
  fmt::print(
      "distance {:.4g} to {:.4g} µm; balance {:.2g} of the load is left; closes no farther "
      "than {:.3g} µm within {:.3g} µm, to first order ({:.3g} µm by curves)\n",
      settled.distance.lower / um, settled.distance.upper / um, settled.residual,
      settled.remaining / um, settled.reach / um, settled.second_order / um);
  fmt::print("the load lies {:.4g}{} {} the contacts' hull\n", std::abs(settled.margin), unit,
             settled.margin > 0 ? "inside" : "outside");
  for (const SettleContact& contact : settled.contacts) {
    if (!(contact.force > 0)) continue;
    fmt::print("  {:6.1f} % of the load at ({:.2f}, {:.2f}, {:.2f}), triangles {} and {}\n",
               100 * contact.force, contact.point[0], contact.point[1], contact.point[2],
               contact.triangles.fixed, contact.triangles.moving);
  }
}

void say_guesses(const Settlement& settled) {
  if (settled.load_guessed) {
    fmt::print(stderr,
               "the load acts at ({:.3f}, {:.3f}, {:.3f}) of the moving body, the middle of what "
               "touches first: --at names another point\n",
               settled.load_point[0], settled.load_point[1], settled.load_point[2]);
  }
  if (settled.unit_guessed) {
    fmt::print(stderr, "lengths are taken as millimetres: --unit names another unit\n");
  }
}

void print_groups(const std::vector<Settlement>& settled, const std::vector<SettleGroup>& groups,
                  const Bodies& bodies, bool json) {
  const double mm = millimetre_of(bodies);
  if (json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const SettleGroup& group : groups) {
      list.push_back({{"starts", group.members},
                      {"height", group.height},
                      {"best", json_of(settled[group.best])}});
    }
    nlohmann::ordered_json others = nlohmann::ordered_json::object();
    for (const Settlement& one : settled) {
      const std::string status = to_string(one.status);
      others[status] = others.value(status, 0) + 1;
    }
    print_json({{"starts", settled.size()}, {"statuses", others}, {"rests", list}});
    return;
  }
  fmt::print(
      "{} of {} starts rest, at {} bite{}\n",
      [&] {
        std::size_t count = 0;
        for (const SettleGroup& group : groups) count += group.members.size();
        return count;
      }(),
      settled.size(), groups.size(), groups.size() == 1 ? "" : "s");
  if (groups.empty()) return;
  fmt::print("  bite  starts  closes, mm  contacts  margin, mm  status\n");
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const Settlement& best = settled[groups[i].best];
    const auto count = std::count_if(best.contacts.begin(), best.contacts.end(),
                                     [](const SettleContact& c) { return c.force > 0; });
    fmt::print("  {:4}  {:6}  {:10.4f}  {:8}  {:10.3f}  {}{}\n", i + 1, groups[i].members.size(),
               (groups[i].height - groups.front().height) / mm, count, best.margin / mm,
               words_of(best), best.rocks ? ", rocks" : "");
  }
}

void run(const SettleArguments& arguments) {
  SettleOptions options = options_of(arguments);
  check_output(arguments.output,
               {arguments.files.fixed, arguments.files.moving, arguments.pose.matrix});
  const GivenPose given = arguments.pose.poses_named().front();
  const Bodies bodies = load_bodies(arguments.files);
  require_triangles(bodies);
  if (!arguments.json) echo_pose(arguments.pose, given.pose);
  Query query(bodies.fixed, bodies.moving);
  ProgressBar progress;
  SettleOptions one = options;
  one.proceed = shown_by(progress, "settling");
  Settlement settled = settle(query, given.pose, one);
  settled.rotation_error = given.rotation_error;
  // A unit that the user told is no guess.
  settled.unit_guessed = settled.unit_guessed && bodies.unit() == LengthUnit::kUnknown;
  if (arguments.json) {
    print_header("settle", {{"fixed", arguments.files.fixed}, {"moving", arguments.files.moving}},
                 bodies);
  } else {
    say_guesses(settled);
  }
  if (arguments.starts == 1) {
    if (arguments.json) {
      print_json(json_of(settled));
    } else {
      print_settled(settled, bodies);
    }
    if (!arguments.output.empty() && settled.free) write_pose(settled.pose(), arguments.output);
    return;
  }
  options.load_point = settled.load_point;
  const double mm = millimetre_of(bodies);
  if (options.largest_way == 0) options.largest_way = kLargestWay * mm;
  if (options.largest_turn == 0) options.largest_turn = kLargestTurn;
  const std::vector<Eigen::Isometry3d> poses = spread(given.pose, arguments, options);
  // A start that is spread goes as far back, and opens first if it is not free.
  options.largest_way *= 2;
  options.largest_turn = std::min(2 * options.largest_turn, 90 * kDegree);
  const std::vector<Settlement> all =
      settle_all(query, poses, options, shown_by(progress, "settling"));
  const std::vector<SettleGroup> groups = group_settled(all, options.closing, mm);
  print_groups(all, groups, bodies, arguments.json);
  if (!arguments.output.empty() && !groups.empty()) {
    write_pose(all[groups.front().best].pose(), arguments.output);
  }
}

}  // namespace

void add_settle(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "settle", "Move a body until it rests on the other one, and prove that it rests");
  const auto options = std::make_shared<SettleArguments>();
  options->files.voxels = BodyFiles::Voxels::kNone;
  add_file(*command, "FIXED", options->files.fixed, "mesh or tree of the body that stays")
      ->required();
  add_file(*command, "MOVING", options->files.moving, "mesh or tree of the body that settles")
      ->required();
  command
      ->add_option("--closing", options->closing,
                   "direction of the load: x,y,z, or x, y, z, -x, -y or -z; fixed axes")
      ->type_name("DIRECTION")
      ->capture_default_str();
  command
      ->add_option(
          "--at", options->at,
          "x,y,z: the point of the moving body on which the load acts, its own coordinates; "
          "by default the middle of what touches first")
      ->type_name("X,Y,Z");
  command
      ->add_option("--hold", options->hold,
                   "freedoms that the body does not have, some of x, y, z, roll, pitch and yaw: "
                   "ways of the load point and turns about it, fixed axes")
      ->type_name("FREEDOMS");
  command
      ->add_option(
          "--within", options->within,
          "way,degrees: the box round the pose in which the body settles, each way and each "
          "turn; by default 2 mm and 3 degrees")
      ->type_name("WAY,DEGREES");
  command
      ->add_option("--starts", options->starts,
                   "settle from so many poses, spread over half of the box, and list the bites")
      ->transform(whole_number("the number of starts"))
      ->check(CLI::Range(std::uint64_t{1}, kMostStarts))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of these poses")
      ->transform(whole_number("the seed"))
      ->capture_default_str();
  add_file(*command, "-o,--output", options->output,
           "write the pose: .tfm or .txt, a transform of ITK, else 4 x 4 numbers; of several bites "
           "the one that closes farthest");
  add_units_and_frame(*command, options->files);
  add_max_memory(*command, options->files.max_memory, "a body's tree of triangles");
  command->add_flag("--json", options->json, "print the answer as JSON");
  add_pose_options(*command, options->pose, Poses::kOne);
  add_example(
      *command,
      "A bite is one of several. It is free and at rest, and not the clinically right one.\n"
      "Examples: ist settle upper.stl lower.stl --move 0,0,-2 -o bite.tfm\n"
      "          ist settle upper.stl lower.stl --move 0,0,-2 --starts 100");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
