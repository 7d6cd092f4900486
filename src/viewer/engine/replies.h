#pragma once

#include <vector>

#include "answers/bodies.h"
#include "ist/base/progress.h"
#include "viewer/engine/asked.h"
#include "viewer/engine/reply.h"

/// Longer answers to questions of page/protocol.js.
namespace ist::viewer {

/// Measures the occlusion that a page asks for, and fills in its JSON, bands and maps: Bite.
/// Throws as answers::make_bite() does.
void fill_bite(const answers::Bodies& bodies, const Asked& asked, Progress& progress, Reply& reply);

/// Returns both bodies as a GLB, in the colours of the distance map that `asked` names.
[[nodiscard]] std::vector<std::uint8_t> coloured_glb(const answers::Bodies& bodies,
                                                     const Asked& asked, Progress& progress);

/// Guesses how both bodies face each other at a pose, by the surfaces that are near each other,
/// and fills in Facing. A body without triangles faces nothing.
void fill_facing(const answers::Bodies& bodies, const Asked& asked, Progress& progress,
                 Reply& reply);

/// Fills in the balls of one level's nodes, and under `slab` the slabs that cut them, in mesh
/// coordinates and the octree's order: Level. Throws kPolicyMissing, and kArgumentInvalid for a
/// level that the tree lacks.
void fill_level(const SphereTree& tree, SpherePolicy policy, int level, Reply& reply);

}  // namespace ist::viewer
