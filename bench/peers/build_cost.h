#pragma once

#include <vector>

#include "peers/peer.h"
#include "support/latencies.h"

namespace ist::bench {

/// The cost to make a library's structures of both meshes, with all its contestants, in the
/// thread limit that is set.
struct BuildCost {
  Latencies times;     ///< one a build
  double held_mb = 0;  ///< in use by malloc after a build and not before, by mallinfo2
  double grown_mb =
      0;               ///< by which the process is larger in memory, once free pages are given back
  double peak_mb = 0;  ///< by which it is larger at its largest during a build
  int rounds = 0;      ///< as many builds
};

/// Builds `rounds` times, of which the last one is kept.
[[nodiscard]] BuildCost measure_build(const Library& library, int rounds, Peers& built);

}  // namespace ist::bench
