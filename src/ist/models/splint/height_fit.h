#pragma once

#include <vector>

#include "ist/models/splint/clearance_map.h"
#include "ist/models/splint/horseshoe.h"

namespace ist {

/// Returns heights of the horseshoe's points, at most `highest`, such that its triangles lie below
/// the heights of the map all over: the highest, in that no point can rise while the others stay.
[[nodiscard]] std::vector<double> fit_below(const ClearanceMap& map, const Horseshoe& horseshoe,
                                            double highest);

}  // namespace ist
