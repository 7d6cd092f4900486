#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/cli11_fwd.h"
#include "cli/poses/pose_file.h"

namespace ist {
struct ClosingPath;
class SphereTree;
}  // namespace ist

namespace ist::cli {

/// The place of the moving body in the words of a user. If all is empty, the body stays as its file
/// has it.
struct PoseOptions {
  std::string move;              ///< x,y,z
  std::string turn;              ///< axis,degrees[@x,y,z]
  std::filesystem::path matrix;  ///< 4 × 4 numbers, or a transform of ITK
  std::filesystem::path poses;   ///< JSON, many poses

  /// Returns whether any motion is named.
  [[nodiscard]] bool is_named() const;
  /// Returns one pose, or all poses of the file. Throws a Refusal for words that are no motion, and
  /// the errors of read_poses() and read_matrix().
  [[nodiscard]] std::vector<GivenPose> poses_named() const;
};

/// How many poses a command takes.
enum class Poses { kOne, kMany };

/// Adds --move, --turn, --matrix, and of many poses --poses.
void add_pose_options(CLI::App& command, PoseOptions& options, Poses poses);

/// Returns a direction of unit length for x, y, z, -x, -y or -z. Throws a Refusal of `option` for
/// another word.
[[nodiscard]] Eigen::Vector3d axis_named(const std::string& word, const std::string& option);

/// Finds the straight way on which the moving body closes to its stored place, and prints it to
/// stderr. `axis`, x to -z, is the opposite direction. If it is empty, the bounding box of the body
/// leaves soonest in the direction that is taken. Throws a Refusal of --poses
/// for trees without triangles and for bodies that do not meet on that way.
[[nodiscard]] ClosingPath find_closing_way(const SphereTree& fixed, const SphereTree& moving,
                                           const std::string& axis);

/// Prints a pose to stderr as four lines of four numbers, if a motion is named.
void echo_pose(const PoseOptions& options, const Eigen::Isometry3d& pose);

}  // namespace ist::cli
