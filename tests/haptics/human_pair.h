#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "ist/haptics/simulation.h"
#include "ist/query/query.h"
#include "ist/tree/sphere_tree.h"
#include "loop/haptics/bodies/tool_contact_query.h"
#include "loop/haptics/devices/hand_device.h"
#include "support/stability.h"

namespace ist::test {

inline constexpr double kPeriod = 1e-3;                      // of a tick, s
inline constexpr int kPressTicks = 3000;                     // of one press: come, slide, rest, go
inline constexpr double kRestBegins = 1.9, kRestEnds = 2.1;  // of a press, s: nothing moves by plan
/// The resolution of the encoders of hand_of, m and rad.
inline constexpr double kResolution = 2e-6, kAngularResolution = 2e-5;
/// The limits of every simulation of the pair.
inline constexpr SafetySettings kSafety{8, 0.3, 500, 20, 0.5};

/// Two human jaws. The hand holds the lower one. As stored they stand in full occlusion, and the
/// lower jaw opens along -z.
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
  /// Springs and damping, from an open mouth.
  [[nodiscard]] Simulation simulation(const CouplingSettings& coupling) const;

 private:
  SphereTree fixed_, held_;
  BodyFrames frames_;
  Query exact_;
};

/// A plan of presses one after the other, each to another place and with another turn.
[[nodiscard]] std::vector<Waypoint> presses(const HumanPair& pair, int count);

[[nodiscard]] HandSettings hand_of(std::vector<Waypoint> plan);

/// A press gives a hand of hand_of() no energy, but for what encoders feign: as in PressResult.
class PressEnergy {
 public:
  PressEnergy(const std::string& name, const CouplingSettings& coupling)
      : energy_("long runs", "energy returned by a press" + name, "J"), coupling_(coupling) {}

  /// Adds a tick with contact. `returned` is the energy that the hand got, `way` its motion.
  void touched(double returned, const Vector6& way) {
    returned_ += returned;
    allowance_ += (0.5 * coupling_.stiffness + coupling_.damping / kPeriod) * kResolution *
                      way.head<3>().norm() +
                  (0.5 * coupling_.angular_stiffness + coupling_.angular_damping / kPeriod) *
                      kAngularResolution * way.tail<3>().norm();
  }
  /// Bodies met within a tick in which the hand had this velocity, and are known to touch since.
  void meets(const Vector6& velocity) {
    allowance_ += (coupling_.stiffness * kPeriod + coupling_.damping) * kPeriod *
                      velocity.head<3>().squaredNorm() +
                  (coupling_.angular_stiffness * kPeriod + coupling_.angular_damping) * kPeriod *
                      velocity.tail<3>().squaredNorm();
  }
  void press_ends() {
    energy_.sample(std::max(0.0, returned_), allowance_);
    returned_ = allowance_ = 0;
  }

 private:
  StabilityCase energy_;
  CouplingSettings coupling_;
  double returned_ = 0, allowance_ = 0;
};

}  // namespace ist::test
