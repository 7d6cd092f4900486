#pragma once

#include <vector>

#include "answers/bodies.h"
#include "ist/base/progress.h"
#include "viewer/engine/asked.h"
#include "viewer/engine/reply.h"

namespace ist::viewer {

/// Measures the occlusion that a page asks for, and fills in its JSON, bands and maps: Bite of
/// page/protocol.js. Throws as answers::make_bite() does.
void fill_bite(const answers::Bodies& bodies, const Asked& asked, Progress& progress, Reply& reply);

/// Returns both bodies as a GLB, in the colours of the distance map that `asked` names.
[[nodiscard]] std::vector<std::uint8_t> coloured_glb(const answers::Bodies& bodies,
                                                     const Asked& asked, Progress& progress);

}  // namespace ist::viewer
