#pragma once

#include "ist/base/rigid_move.h"
#include "ist/measure/point_search.h"

namespace ist {

/// A surface, and the body in which it may lie.
struct SurfaceInBody {
  const SphereTree& surface;
  const SphereTree& body;
  const PointSearch& search;  ///< of the body
  RigidMove to_body;          ///< from mesh coordinates of the surface to those of the body
};

/// Returns whether a component of the surface lies inside the body: by one vertex of each.
/// Precondition: the surfaces do not intersect.
[[nodiscard]] bool is_any_inside(const SurfaceInBody& side);

}  // namespace ist
