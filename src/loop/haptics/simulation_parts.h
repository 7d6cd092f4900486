#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "ist/base/access.h"
#include "ist/haptics/effects/effect.h"
#include "ist/haptics/simulation.h"
#include "loop/haptics/bodies/hand_bodies.h"
#include "loop/haptics/bodies/pair_queries.h"
#include "loop/haptics/tool.h"
#include "loop/haptics/wall/wall.h"

namespace ist::detail {

/// An attach or a release at a time of the simulation.
struct PlannedChange {
  double time;       ///< from the first tick on, s
  std::size_t body;  ///< by its number
  bool attach;       ///< false: a release
};

/// The parts of a Simulation.
struct SimulationParts {
  HandBodies bodies = {};
  std::optional<Wall> wall = {};            ///< keeps the tool out of fixed bodies
  PairQueries contacts = {},                ///< of leaf pairs; empty if no effect needs them
      proximity = {};                       ///< empty if no effect needs proximity
  std::vector<PlannedChange> changes = {};  ///< by ascending time
  std::vector<std::unique_ptr<Effect>> effects = {};
  CouplingSettings coupling = {};
  SafetySettings safety = {};
  double max_step;       ///< bound on the displacement of a held surface in a tick, m
  Placement start = {};  ///< of the tool
  double dt;             ///< length of a tick, s
};

/// Makes a simulation of its parts.
[[nodiscard]] inline Simulation simulation_from(SimulationParts parts) {
  return Access::made_of<Simulation>(std::move(parts));
}

/// Gives `parts` a fixed and a held body at home, and the query between them.
/// @param radius bound on the distance of the held surface from the tool's origin, m
void add_two_bodies(SimulationParts& parts, const BodyFrames& frames, double radius,
                    std::unique_ptr<ToolContactQuery> contacts,
                    std::unique_ptr<ToolContactQuery> proximity = nullptr);

}  // namespace ist::detail
