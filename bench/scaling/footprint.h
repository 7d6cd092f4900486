#pragma once

#include <cstdint>
#include <utility>

#include "ist/tree/sphere_tree.h"

namespace ist::bench {

/// The memory of both jaws in voxels of a size: to be built one after the other, and to be held.
/// Megabytes are 10^6 bytes.
struct Footprint {
  double leaves;    ///< of both trees
  double trees_mb;  ///< that they keep
  double query_mb;  ///< that a query of one worker reserves
  double peak_mb;   ///< the most in use while they were built, above what was before
  double build_s;   ///< wall time
};

/// Bytes that one tree's building may take here (BuildOptions::max_memory).
inline constexpr std::uint64_t kMaxMemory = std::uint64_t{16} << 30;

/// Both jaws; the last pair that was asked for is kept, and no other.
[[nodiscard]] const std::pair<SphereTree, SphereTree>& jaws(SpherePolicy policy, double voxel_size);
void forget_jaws();

/// Measured when jaws() first builds them. Throws what build_tree does.
[[nodiscard]] const Footprint& footprint(SpherePolicy policy, double voxel_size);

}  // namespace ist::bench
