#include "ist/measure/signed_distance.h"

#include <fmt/format.h>

#include <cmath>

#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/base/rigid_move.h"
#include "ist/measure/distances_of.h"
#include "ist/measure/point_search.h"
#include "ist/measure/require.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

constexpr double kFarthest = 1e30;

void require_reach(double reach) {
  if (reach > 0) return;  // no NaN
  throw Error(ErrorCode::kArgumentInvalid,
              fmt::format("reach: {} is not positive: give the distance beyond which nothing is "
                          "looked for, or infinity",
                          reach));
}

void require_points(std::span<const Vector> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector& p = points[i];
    if (std::abs(p[0]) <= kFarthest && std::abs(p[1]) <= kFarthest && std::abs(p[2]) <= kFarthest) {
      continue;
    }
    throw Error(ErrorCode::kArgumentInvalid,
                fmt::format("point {}: ({}, {}, {}) is not finite, or beyond {:g}: leave it out", i,
                            p[0], p[1], p[2], kFarthest));
  }
}

}  // namespace

std::vector<SurfaceDistance> signed_distance(const SphereTree& tree, std::span<const Vector> points,
                                             double reach, const Proceed& proceed) {
  const ScopedFloatEnvironment environment;
  require_triangles(tree, "tree");
  require_reach(reach);
  require_points(points);
  return distances_of(tree, PointSearch(tree, select_kernels({}).clusters), points, reach, proceed);
}

std::vector<SurfaceDistance> distance_map(const SphereTree& body, const SphereTree& other,
                                          const Eigen::Isometry3d& pose, double reach,
                                          const Proceed& proceed) {
  const ScopedFloatEnvironment environment;
  require_triangles(body, "body");
  require_triangles(other, "other");
  require_reach(reach);
  const RigidMove move(require_rigid(pose, "pose"));
  std::vector<Vector> moved;
  moved.reserve(body.triangles()->vertices.size());
  for (const Vector& vertex : body.triangles()->vertices) moved.push_back(move(vertex));
  require_points(moved);
  return distances_of(other, PointSearch(other, select_kernels({}).clusters), moved, reach,
                      proceed);
}

}  // namespace ist
