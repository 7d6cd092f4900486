#pragma once

#include "peers/peer.h"

namespace ist::bench {

/// This library: both jaws at 0.2 mm with triangles and slabs, one worker. Candidates are asked of
/// it as pairs, which is more.
[[nodiscard]] Library ist_library();

/// `ist`, which is of ist_library(), on another instruction set, over the same trees: `ist_TARGET`.
/// Null where that is its own, or this processor lacks it.
[[nodiscard]] std::unique_ptr<Peer> ist_on(const Peer& ist, const std::string& target);

}  // namespace ist::bench
