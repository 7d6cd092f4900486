#include "ist/query/advice/exact_bodies.h"

#include "ist/base/assert.h"
#include "ist/mesh/bounding_box.h"

namespace ist {
namespace {

const TriangleMesh& mesh_of(const SphereTree& tree) {
  IST_ASSERT(tree.triangles().has_value());
  return tree.triangles()->mesh;
}

}  // namespace

ExactBodies::ExactBodies(const SphereTree& fixed, const SphereTree& moving)
    : fixed_(mesh_of(fixed)),
      moving_(mesh_of(moving)),
      fixed_box_(bounding_box(fixed_)),
      moving_box_(bounding_box(moving_)),
      query_(fixed, moving),
      inside_(fixed_, moving_) {}

bool ExactBodies::free(const Eigen::Isometry3d& pose) noexcept {
  return query_.touches(pose) == Touch::kNo && inside_.at(pose) == Inside::kNone;
}

GapInterval ExactBodies::distance(const Eigen::Isometry3d& pose, double tolerance) noexcept {
  return query_.gap(pose, tolerance).gap;
}

}  // namespace ist
