#pragma once

#include <cstdint>
#include <vector>

#include "ist/measure/occlusion.h"
#include "ist/measure/refined_surface.h"

namespace ist {

/// The contact regions of a surface, and what it takes to find their partners.
struct ContactRegions {
  std::vector<ContactRegion> regions;  ///< the largest first; in the body's coordinates
  /// Of each region, the body's triangle that is nearest to its closest vertex.
  std::vector<std::uint32_t> nearest;
};

[[nodiscard]] ContactRegions contact_regions(const RefinedSurface& surface,
                                             const OcclusionOptions& options);

/// Finds the regions that regions face, and the partners.
void pair_regions(ContactRegions& fixed, ContactRegions& moving);

}  // namespace ist
