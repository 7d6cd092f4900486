#pragma once

#include "answers/bodies.h"
#include "ist/base/progress.h"
#include "viewer/engine/asked.h"
#include "viewer/engine/reply.h"

namespace ist::viewer {

/// Guesses how both bodies face each other at a pose, and fills in Facing of page/protocol.js, by
/// the surfaces that are near each other. A body without triangles faces nothing.
void fill_facing(const answers::Bodies& bodies, const Asked& asked, Progress& progress,
                 Reply& reply);

}  // namespace ist::viewer
