#include "ist/measure/signed_distance.h"

#include <cmath>

#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/base/rigid_move.h"
#include "ist/base/throw_error.h"
#include "ist/measure/point_search.h"
#include "ist/measure/require.h"
#include "ist/tree/mesh_source.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

constexpr double kFarthestPoint = 1e15;

void require_reach(double reach) {
  if (reach > 0) return;  // no NaN
  throw_error(ErrorCode::kArgumentInvalid,
              "reach: {} is not positive: give the distance beyond which nothing is "
              "looked for, or infinity",
              reach);
}

bool is_fit(const Vector& p) {
  return std::abs(p[0]) <= kFarthestPoint && std::abs(p[1]) <= kFarthestPoint &&
         std::abs(p[2]) <= kFarthestPoint;
}

void require_points(std::span<const Vector> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_fit(points[i])) continue;
    throw_error(ErrorCode::kArgumentInvalid,
                "point {}: ({}, {}, {}) is not finite, or beyond {:g}: leave it out", i,
                points[i][0], points[i][1], points[i][2], kFarthestPoint);
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
  const std::string reason = contradiction(body, "the body", other, "the other body");
  if (!reason.empty()) throw Error(ErrorCode::kArgumentInvalid, "distance map: " + reason);
  require_reach(reach);
  const RigidMove move(require_rigid(pose, "pose"));
  std::vector<Vector> moved;
  moved.reserve(body.triangles()->vertices.size());
  for (const Vector& vertex : body.triangles()->vertices) moved.push_back(move(vertex));
  // A vertex that no triangle uses may lie anywhere.
  std::vector<std::size_t> nowhere;
  for (std::size_t v = 0; v < moved.size(); ++v) {
    if (is_fit(moved[v])) continue;
    nowhere.push_back(v);
    moved[v] = Vector(0, 0, 0);
  }
  std::vector<SurfaceDistance> out =
      distances_of(other, PointSearch(other, select_kernels({}).clusters), moved, reach, proceed);
  for (const std::size_t v : nowhere) {
    if (v < out.size()) out[v] = beyond_reach();
  }
  return out;
}

}  // namespace ist
