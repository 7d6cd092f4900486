#include "cli/depth_meter.h"

#include <algorithm>
#include <cmath>

#include "cli/exit_code.h"
#include "ist/base/error.h"
#include "ist/base/pose.h"
#include "ist/measure/signed_distance.h"

namespace ist::cli {
namespace {

// The largest depth of a vertex of `body` inside `other`, where none is deeper than `bound`.
double depth_at_vertices(const SphereTree& body, const SphereTree& other,
                         const Eigen::Isometry3d& pose, double bound) {
  double deepest = 0;
  for (const SurfaceDistance& one : distance_map(body, other, pose, bound)) {
    if (one.distance < -deepest) deepest = -one.distance;  // no NaN
  }
  return deepest;
}

}  // namespace

DepthMeter::DepthMeter(const Bodies& bodies, double tolerance)
    : query_(bodies.fixed, bodies.moving),
      manifold_(bodies.fixed, bodies.moving, query_.policy(), {}),
      tolerance_(tolerance) {
  require_triangles(bodies);
  for (const auto& [tree, name] : {std::pair(&bodies.fixed, "FIXED"), {&bodies.moving, "MOVING"}}) {
    if (tree->orientation() == Orientation::kOutward) continue;
    throw Failure(kBadInput,
                  std::string(name) +
                      ": the mesh is not closed and consistent, so nothing has a depth in it: "
                      "leave out --depth, or mend the mesh; ist info says where it is open");
  }
}

Depth DepthMeter::ask(const Eigen::Isometry3d& pose) {
  const Penetration found = penetration(query_, pose, tolerance_);
  Depth depth{found.lower, found.upper, 0};
  if (found.upper > 0) {
    const double bound = found.upper * (1 + 1e-12);
    depth.at_vertices = std::max(depth_at_vertices(query_.moving(), query_.fixed(), pose, bound),
                                 depth_at_vertices(query_.fixed(), query_.moving(),
                                                   project_to_rigid(pose)->inverse(), bound));
  }
  static_cast<void>(query_.contacts(pose, manifold_));
  for (const Contact& contact : manifold_.points()) {
    depth.of_contact = std::max(depth.of_contact.value_or(contact.depth), contact.depth);
  }
  return depth;
}

}  // namespace ist::cli
