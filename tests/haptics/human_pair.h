#pragma once

#include <memory>
#include <vector>

#include "ist/haptics/bodies/tool_contact_query.h"
#include "ist/haptics/devices/hand_device.h"
#include "ist/haptics/simulation.h"
#include "ist/query/query.h"
#include "ist/tree/sphere_tree.h"

namespace ist::test {

inline constexpr double kPeriod = 1e-3;                      // of a tick, s
inline constexpr int kPressTicks = 3000;                     // of one press: come, slide, rest, go
inline constexpr double kRestBegins = 1.9, kRestEnds = 2.1;  // of a press, s: nothing moves by plan
/// Of the encoders of hand_of, m and rad.
inline constexpr double kResolution = 2e-6, kAngularResolution = 2e-5;
/// Of every simulation of the pair.
inline constexpr SafetySettings kSafety{8, 0.3, 500, 20, 0.5};

/// Two human jaws, of which the lower is held. As stored they stand in full occlusion; the lower
/// opens along -z.
class HumanPair {
 public:
  [[nodiscard]] static bool is_there();
  /// `voxel_size` in mm.
  explicit HumanPair(double voxel_size);

  /// The held jaw as stored, moved by millimetres and turned by a rotation vector.
  [[nodiscard]] Placement moved(const Eigen::Vector3d& millimetres,
                                const Eigen::Vector3d& turn = {0, 0, 0}) const;
  /// Whether the surfaces of both meet, by triangles.
  [[nodiscard]] bool surfaces_meet(const Placement& tool);
  /// Contact, friction and damping, from an open mouth.
  [[nodiscard]] Simulation simulation(const CouplingSettings& coupling) const;

 private:
  SphereTree fixed_, held_;
  BodyFrames frames_;
  Query exact_;
};

/// A plan of presses one after the other, each to another place and with another turn.
[[nodiscard]] std::vector<Waypoint> presses(const HumanPair& pair, int count);

[[nodiscard]] HandSettings hand_of(std::vector<Waypoint> plan);

}  // namespace ist::test
