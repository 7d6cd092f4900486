#pragma once

#include <vector>

#include "loop/haptics/bodies/hand_bodies.h"
#include "loop/haptics/bodies/pair_queries.h"
#include "loop/scene/load_body.h"
#include "loop/scene/make_effects.h"

namespace ist {

/// The pairs of bodies, by their numbers, of which the one is fixed while the other is held at some
/// time of a run.
[[nodiscard]] std::vector<HandPair> pairs_of(const std::vector<LoadedBody>& bodies);

/// Where the plan of a device leads the tool.
class PlanReach {
 public:
  /// @param plan  in the scene; empty: the device has no plan, and may lead anywhere
  /// @param start of the tool
  PlanReach(const std::vector<Waypoint>& plan, const Placement& start);

  /// Whether the balls round two bodies stay farther apart than `distance`, m, wherever the plan
  /// leads, if the tool lags no farther behind the device than the plan is long. Both rest but for
  /// the tool's motion: neither has a script or is attachable.
  [[nodiscard]] bool keeps_apart(const HandBodies& bodies, const HandPair& pair,
                                 double distance) const;

 private:
  std::vector<Placement> poses_;
  double extent_ = 0;  // between two poses of the plan, at most, m
};

/// The plan of a fixed body's script: the poses of its mesh, in metres, in the scene.
[[nodiscard]] Plan plan_of(const SceneBody& body, const BodyHome& home, double unit);

/// A bound on the displacement of the body's surface in a tick of `dt` seconds, m.
/// @param radius of the surface about the origin of its frame, m
/// @param longest allowed, m: a longer one throws kInputInvalid (fail_at), which names the script
[[nodiscard]] double step_of(const Scene& scene, const LoadedBody& body, double radius, double dt,
                             double longest);

}  // namespace ist
