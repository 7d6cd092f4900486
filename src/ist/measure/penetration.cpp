#include "ist/measure/penetration.h"

#include <array>
#include <cmath>
#include <optional>

#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/pose.h"
#include "ist/base/rigid_move.h"
#include "ist/measure/depth_search.h"
#include "ist/measure/point_search.h"
#include "ist/measure/require.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;
using DepthStatus = Penetration::Status;

double size_of(const SphereTree& tree) {
  return tree.bounding_radius() + tree.origin().cwiseAbs().maxCoeff();
}

// Goes on from the deepest point of an earlier answer, on the surface of this side.
void begin_at(const Penetration& last, DepthSearch& search, const SurfaceInBody& side,
              const RigidMove& from_fixed) {
  const bool there = last.status == DepthStatus::kDone && last.lower > 0 &&
                     last.triangle < side.surface.triangles()->triangles.size();
  if (there) search.begin_at(last.of_moving ? 0 : 1, last.triangle, from_fixed(last.point));
}

}  // namespace

const char* to_string(DepthStatus status) noexcept {
  constexpr std::array kNames = {"done", "invalid-pose", "fixed-not-closed", "moving-not-closed",
                                 "busy"};
  const auto at = static_cast<std::size_t>(status);
  return at < kNames.size() ? kNames[at] : "unknown";
}

Penetration penetration(Query& query, const Eigen::Isometry3d& pose, double tolerance,
                        const PenetrationOptions& options) {
  const ScopedFloatEnvironment environment;
  const SphereTree &fixed = query.fixed(), &moving = query.moving();
  require_triangles(fixed, "fixed");
  require_triangles(moving, "moving");
  require_tolerance(tolerance);
  Penetration result;
  result.rotation_error = rotation_error(pose);
  const std::optional<Eigen::Isometry3d> rigid = project_to_rigid(pose);
  if (!rigid) {
    result.status = DepthStatus::kInvalidPose;
  } else if (fixed.orientation() != Orientation::kOutward) {
    result.status = DepthStatus::kFixedNotClosed;
  } else if (moving.orientation() != Orientation::kOutward) {
    result.status = DepthStatus::kMovingNotClosed;
  }
  if (result.status != DepthStatus::kDone) return result;
  const IntersectionResult surfaces = query.intersects(*rigid);
  if (surfaces.status == QueryStatus::kBusy) {
    result.status = DepthStatus::kBusy;
    return result;
  }

  const ClusterKernels& kernels = select_kernels(query.target()).clusters;
  const PointSearch in_fixed(fixed, kernels), in_moving(moving, kernels);
  const Eigen::Isometry3d back = rigid->inverse();
  const RigidMove to_fixed(*rigid), to_moving(back);
  const std::array<SurfaceInBody, 2> sides = {
      {{moving, fixed, in_fixed, to_fixed}, {fixed, moving, in_moving, to_moving}}};
  const double rounding =
      0x1p-44 * (size_of(fixed) + size_of(moving) + rigid->translation().cwiseAbs().maxCoeff());
  result.complete = true;
  result.narrowest = 4 * rounding;
  result.fixed_self_intersecting = fixed.self_intersections() > 0;
  result.moving_self_intersecting = moving.self_intersections() > 0;
  const bool meet = surfaces.answer == Answer::kYes;
  if (!meet && !is_any_inside(sides[0]) && !is_any_inside(sides[1])) {
    result.upper = 0;
    return result;
  }

  DepthSearch search({sides.begin(), sides.end()}, rounding, options.budget, options.proceed);
  if (options.last != nullptr) {
    const bool of_moving = options.last->of_moving;
    begin_at(*options.last, search, sides[of_moving ? 0 : 1],
             of_moving ? RigidMove(Eigen::Isometry3d::Identity()) : to_moving);
  }
  result.complete = search.run(tolerance);
  result.capped = search.capped();
  result.points = search.points();
  result.upper = search.bound();
  if (const auto& deepest = search.deepest()) {
    result.of_moving = deepest->side == 0;
    result.lower = deepest->depth;
    result.triangle = deepest->triangle;
    const Vector way = difference(deepest->nearest, deepest->at);
    const double length = std::sqrt(dot_in_order(way, way));
    const Vector direction = length > 0 ? scaled(1 / length, way) : Vector(0, 0, 0);
    result.point = result.of_moving ? deepest->at : to_fixed(deepest->at);
    result.direction = result.of_moving ? direction : to_fixed.turned(direction);
  }
  return result;
}

}  // namespace ist
