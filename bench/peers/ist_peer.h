#pragma once

#include "peers/peer.h"

namespace ist::bench {

/// This library: both jaws at 0.2 mm with triangles and slabs, one worker. Candidates are asked of
/// it as pairs, which is more.
[[nodiscard]] Library ist_library();

}  // namespace ist::bench
