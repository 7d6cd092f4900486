#pragma once

#include <cstdint>
#include <vector>

#include "loop/haptics/simulation_parts.h"
#include "loop/scene/load_body.h"
#include "loop/scene/scene_pairs.h"
#include "loop/scene/scene_parts.h"

namespace ist {

/// Bodies at their places, and the pairs of them that a hand brings together.
struct PlacedBodies {
  const Scene& scene;
  const std::vector<LoadedBody>& bodies;
  const std::vector<BodyTrees>& trees;
  const HandBodies& placed;
  const std::vector<HandPair>& pairs;
  double period;  ///< of a tick, s
};

/// Gives `parts` a query for each pair that may meet, as the effects need it, and the other pairs
/// as far ones.
/// @param max_memory bytes, for all queries together: before any is made, the one that is too much
///                   throws kInputInvalid (fail_at), which names its pair
void build_queries(const PlacedBodies& of, const EffectNeeds& needs, const PlanReach& reach,
                   std::uint64_t max_memory, BuildNotes& notes, detail::SimulationParts& parts);

}  // namespace ist
