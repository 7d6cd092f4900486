#include "cli/poses/pose_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

#include "advise/closing_path.h"
#include "answers/refusals.h"
#include "cli/common_options.h"
#include "cli/poses/pose_file.h"
#include "cli/progress_bar.h"
#include "ist/base/angles.h"
#include "ist/base/direction.h"
#include "ist/base/pose.h"

namespace ist::cli {

using namespace answers;

namespace {

// Whole quarters of a turn have whole numbers.
SineCosine of_degrees(double degrees) {
  const double turn = std::remainder(degrees, 360.0);
  const double quarters = std::nearbyint(turn / 90);
  const SineCosine rest = sine_cosine((turn - 90 * quarters) * (std::numbers::pi / 180));
  switch ((static_cast<int>(quarters) + 4) % 4) {
    case 1:
      return {rest.cosine, -rest.sine};
    case 2:
      return {-rest.sine, -rest.cosine};
    case 3:
      return {-rest.cosine, rest.sine};
    default:
      return rest;
  }
}

Eigen::Matrix3d rotation(const Eigen::Vector3d& axis, const SineCosine& turn) {
  Eigen::Matrix3d cross;
  cross << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
  return turn.cosine * Eigen::Matrix3d::Identity() + turn.sine * cross +
         (1 - turn.cosine) * (axis * axis.transpose());
}

// axis,degrees or x,y,z,degrees, then perhaps @ and a point.
Eigen::Isometry3d turn_named(const std::string& text) {
  const std::string how =
      "give axis,degrees or axis,degrees@x,y,z, such as z,15 or -x,2.5@0,40,0; an axis is x, y, z, "
      "-x, -y, -z, or three numbers";
  const std::size_t at = text.find('@');
  const auto point = at == std::string::npos ? std::optional(Eigen::Vector3d(0, 0, 0))
                                             : vector_of(text.substr(at + 1));
  const std::string turn = text.substr(0, at);
  const std::size_t comma = turn.rfind(',');
  refuse_if(!point || comma == std::string::npos, "--turn", text + ": " + how);
  const std::string word = turn.substr(0, comma);
  const auto degrees = numbers_of(turn.substr(comma + 1));
  refuse_if(!degrees || degrees->size() != 1, "--turn", text + ": " + how);
  std::optional<Eigen::Vector3d> axis = vector_of(word);
  if (!axis) axis = axis_named(word, "--turn");
  const std::optional<Direction> along = direction_of(*axis);
  refuse_if(!along, "--turn", text + ": the axis has no length");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation(along->unit, of_degrees(degrees->front()));
  pose.translation() = *point - pose.linear() * *point;
  return pose;
}

}  // namespace

Eigen::Vector3d axis_named(const std::string& word, const std::string& option) {
  const bool minus = word.starts_with('-');
  const std::string letter =
      CLI::detail::to_lower(word.substr(minus || word.starts_with('+') ? 1 : 0));
  refuse_if(letter != "x" && letter != "y" && letter != "z", option,
            "{} is no axis: give x, y, z, -x, -y or -z", word);
  Eigen::Vector3d axis(0, 0, 0);
  axis[letter[0] - 'x'] = minus ? -1 : 1;
  return axis;
}

bool PoseOptions::is_named() const {
  return !move.empty() || !turn.empty() || !matrix.empty() || !poses.empty();
}

std::vector<GivenPose> PoseOptions::poses_named() const {
  if (!poses.empty()) {
    std::vector<GivenPose> given;
    for (const Eigen::Isometry3d& pose : read_poses(poses)) {
      given.push_back({pose, rotation_error(pose)});
    }
    return given;
  }
  if (!matrix.empty()) return {read_matrix(matrix)};
  Eigen::Isometry3d pose =
      turn.empty() ? Eigen::Isometry3d(Eigen::Isometry3d::Identity()) : turn_named(turn);
  if (!move.empty()) {
    const auto shift = vector_of(move);
    refuse_if(!shift, "--move", move + ": give x,y,z in mesh units, such as 0,0,-1.5");
    pose.translation() += *shift;
  }
  refuse_if(!project_to_rigid(pose), "--move, --turn", "too far away for a double");
  return {{pose, rotation_error(pose)}};
}

void add_pose_options(CLI::App& command, PoseOptions& options, Poses poses) {
  command.option_defaults()->group("Pose of the moving body; as stored, where none is named");
  CLI::Option* move =
      command.add_option("--move", options.move, "shift it by x,y,z mesh units, after the turn")
          ->type_name("X,Y,Z");
  CLI::Option* turn =
      command
          .add_option("--turn", options.turn,
                      "turn it by axis,degrees[@x,y,z] about a point, by default the origin; an "
                      "axis is x, y, z, -x, -y, -z, or three numbers")
          ->type_name("AXIS,DEGREES");
  CLI::Option* matrix =
      add_file(command, "--matrix", options.matrix,
               "a file of 4 x 4 numbers, row by row: p_fixed = M p_moving; or a rigid transform of "
               "ITK (.tfm), which is inverted, since it maps fixed to moving points");
  matrix->excludes(move)->excludes(turn);
  if (poses == Poses::kMany) {
    add_file(command, "--poses", options.poses,
             "many poses: JSON, an array of objects with \"pose\", 16 numbers, column by column")
        ->excludes(move)
        ->excludes(turn)
        ->excludes(matrix);
  }
  command.option_defaults()->group("Options");
}

ClosingPath find_closing_way(const SphereTree& fixed, const SphereTree& moving,
                             const std::string& axis) {
  refuse_if(fixed.triangles() == nullptr || moving.triangles() == nullptr, "--poses",
            "needed, because a tree holds no triangles to find a way by: give poses at which the "
            "bodies meet");
  const AxisDirection direction = axis.empty()
                                      ? shortest_open_direction(fixed, moving)
                                      : AxisDirection{axis.back() - 'x', axis.size() > 1 ? -1 : +1};
  const auto name = [&](int sign) {
    return fmt::format("{}{}", sign < 0 ? "-" : "", "xyz"[direction.axis]);
  };
  Query exact(fixed, moving);
  const std::optional<ClosingPath> path = find_closing_path(exact, direction);
  refuse_if(!path, "--poses",
            "needed, because the bodies do not touch where they are stored, nor when "
            "the moving one goes from there along {}: give poses at which they do",
            name(-direction.sign));
  print_past_progress_bar(fmt::format(
      "{} poses: opening towards {}, from {:.4g} to {:.4g}; first contact at {:.6g}\n",
      kClosingPoses, name(direction.sign), path->begin, path->end, path->first_contact));
  return *path;
}

void echo_pose(const PoseOptions& options, const Eigen::Isometry3d& pose) {
  if (!options.is_named()) return;
  std::string lines = "pose, moving to fixed coordinates:\n";
  for (Eigen::Index row = 0; row < 4; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      lines += fmt::format(" {:>13.9g}", pose.matrix()(row, column) + 0.0);
    }
    lines += '\n';
  }
  fmt::print(stderr, "{}", lines);
}

}  // namespace ist::cli
