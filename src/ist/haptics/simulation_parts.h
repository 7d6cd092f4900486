#pragma once

#include <memory>
#include <vector>

#include "ist/haptics/effects/effect.h"
#include "ist/haptics/simulation.h"
#include "ist/haptics/tool.h"
#include "ist/haptics/tool_contact_query.h"

namespace ist::detail {

/// The parts of a Simulation.
struct SimulationParts {
  std::unique_ptr<ToolContactQuery> contacts = {};   ///< null if no effect needs contacts
  std::unique_ptr<ToolContactQuery> proximity = {};  ///< null if no effect needs proximity
  std::vector<std::unique_ptr<Effect>> effects = {};
  CouplingSettings coupling = {};
  SafetySettings safety = {};
  Tool tool;
  Placement start = {};  ///< of the tool
  double dt;             ///< length of a tick, s
};

}  // namespace ist::detail
