#pragma once

#include "ist/haptics/effects/effect.h"
#include "ist/haptics/simulation.h"
#include "loop/haptics/bodies/hand_bodies.h"
#include "loop/haptics/coupling.h"
#include "loop/haptics/tool.h"
#include "loop/haptics/wall/wall.h"

namespace ist {

/// Moves a tool towards the hand in steps, each of which ends free. Fixed bodies that follow a
/// script move with it: they wait while the tool cannot make way.
///
/// A step goes by the local minima of the distance first. If its end is not free, it goes by all
/// features, then by halves of that motion. If nothing is free, the tool stays. Fixed bodies that
/// push the tool farther than the trust make a part of their step.
///
/// The coupling's stretch changes in a tick by no more than the device's way and the trust times
/// the steps, in turns by this length over the tool's radius.
class Walk {
 public:
  /// The parts of a simulation. They must outlive the walk.
  struct Parts {
    HandBodies& bodies;
    Wall& wall;
    const Tool& tool;
    TimedEffects& effects;
    const VirtualCoupling& coupling;
    double dt;  // of a tick, s
  };
  /// The input of a walk.
  struct Goal {
    const Placement& device;
    Vector6 device_motion;  // in the tick
    Budget budget;
    int steps;  // the most
    const ToolContacts& proximity;
  };
  /// How a tick's steps ended.
  struct End {
    int steps = 0;
    bool finite = true;   // false: a wrench is not finite, and the tool stays
    bool held = false;    // the budget ended, or no motion is free
    bool halved = false;  // a step was not free, and was shortened
    QueryResult search = {.found = Found::kClear};
  };

  explicit Walk(const Parts& parts) noexcept : parts_(parts) {}

  /// Walks from `tool` at `time`, s. Changes both. `contacts` takes the features that are near.
  [[nodiscard]] End run(Placement& tool, double& time, const Goal& goal,
                        ToolContacts& contacts) noexcept;

 private:
  class Step;

  Parts parts_;
  bool near_ = false;  // something was near in the last step
  int careful_ = 0;    // the next ticks without a distance, after a held one
  double part_ = 1;    // of the trust in use: each tick that is held halves it
};

}  // namespace ist
