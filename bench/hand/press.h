#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ist/query/query.h"
#include "ist/scene.h"

namespace ist::bench {

/// Two jaws that a hand presses together. As made they stand in full occlusion. Lengths are in mm.
struct Jaws {
  std::string name;
  SceneBody upper, lower;  // without voxels
  double first_contact;    // the height of the lower jaw
};
/// The built-in jaws, and the human pair if its files are there. Made once.
[[nodiscard]] const std::vector<Jaws>& pairs_of_jaws();

/// What keeps the jaws apart.
struct Keeper {
  /// mm, of `springs`. Empty: `contact`.
  std::optional<double> voxel_size = {};
  int workers = 1;
  bool is_reference = false;  ///< `contact` that is finer: a fifth of the skin, ten steps
};

/// The parts of a press. The device follows the plan whatever the wrench.
enum class Phase : std::uint8_t {
  kComes,    ///< from 1 mm before the first contact to 1 mm behind it
  kRests,    ///< there: the coupling draws with at most 1 N
  kPressed,  ///< on to 5 mm behind the first contact, and held there: at most 5 N
  kAside,    ///< 3 mm to the side, and back
  kTilts,    ///< 3 degrees about the axis from front to back, and back
  kLeaves,
};
inline constexpr int kPhases = 6;
[[nodiscard]] const char* to_string(Phase phase) noexcept;

/// A tick of a press.
struct PressTick {
  Phase phase;
  Placement device, tool;
  Eigen::Vector3d force;  ///< on the hand, N
  double microseconds;    ///< of Simulation::tick
  int steps;
  bool held, halved, searched;
};

/// The forces on the hand at poses of the device at which the tool has come to rest.
struct Converged {
  std::vector<Eigen::Vector3d> forces;  ///< N
  int restless;                         ///< poses at which the tool was still moving at the end
};

/// A press of two jaws, which is the same in each run.
class Press {
 public:
  Press(const Jaws& jaws, const Keeper& keeper);

  /// Makes all ticks. Times each. Once.
  [[nodiscard]] std::vector<PressTick> run();
  /// Follows the device of a run. At each of its poses, makes ticks until the tool rests, at most
  /// 400.
  [[nodiscard]] Converged converge(const std::vector<PressTick>& of);
  /// Returns the pose of the lower jaw in the upper one's coordinates for a pose of the tool, mm.
  [[nodiscard]] Eigen::Isometry3d pose_of(const Placement& tool) const;

 private:
  BuiltScene built_;
  Placement from_tool_;  // from the lower jaw to the tool's frame
};

/// Returns the gap of the jaws at a pose, mm; less than 0 if they intersect: the depth.
[[nodiscard]] double gap_at(const Jaws& jaws, const Eigen::Isometry3d& pose);

}  // namespace ist::bench
