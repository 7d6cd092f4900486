#pragma once

#include <algorithm>
#include <string>

#include "haptics/human_pair.h"
#include "support/stability.h"

namespace ist::test {

/// A press gives a hand of hand_of() no energy, but for what encoders feign: as in PressResult.
class PressEnergy {
 public:
  PressEnergy(const std::string& name, const CouplingSettings& coupling)
      : energy_("long runs", "energy returned by a press" + name, "J"), coupling_(coupling) {}

  /// `returned` is what the hand got in a tick in which something was touched; it went `way`.
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
