#pragma once

#include "support/exact.h"

namespace ist::test {

/// Whether two convex polygons in space share a point. Touching counts. Each may be flat to a
/// segment or a point; no corners are the empty set.
[[nodiscard]] bool polygons_meet(const ExactPolygon& a, const ExactPolygon& b);

}  // namespace ist::test
