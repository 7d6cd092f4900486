#pragma once

#include <chrono>

#include "ist/base/api.h"
#include "ist/haptics/touch_set.h"
#include "ist/query/collision_query.h"

namespace ist {

/// Where the bodies' own coordinates are in the scene.
struct IST_API BodyFrames {
  double unit;                  ///< metres in a mesh unit, of both bodies
  Placement fixed;              ///< from the fixed mesh, in metres, to the scene
  Eigen::Vector3d tool_origin;  ///< the tool's origin in the held mesh, mesh units

  /// From held mesh coordinates to fixed ones, mesh units.
  [[nodiscard]] Eigen::Isometry3d query_pose(const Placement& tool) const noexcept;
  /// Of a point and of a direction in fixed mesh coordinates.
  [[nodiscard]] Eigen::Vector3d to_scene(const Eigen::Vector3d& point) const noexcept;
};

struct TouchOptions {
  SpherePolicy policy = SpherePolicy::kTable;
  /// In voxel sizes: from which depth on bodies touch, and to what depth, or height, no leaf pair
  /// is missed; see ContactPointOptions.
  double least_depth = -0.25, growth = 0.375;
  int workers = 1;  ///< 2: the second one helps to look for contacts
  std::chrono::nanoseconds period = std::chrono::milliseconds(1);  ///< from one to the next
};

/// What touches the tool: a collision query and its contact points, in the scene's terms. Holds
/// references to both trees. Memory: that of CollisionQuery and of ContactPoints.
class IST_API TouchQuery {
 public:
  TouchQuery(const SphereTree& fixed, const SphereTree& held, const BodyFrames& frames,
             const TouchOptions& options);

  /// Asks for the tool at this pose. Where the answer is not complete, `touches` is unchanged.
  [[nodiscard]] QueryResult ask(const Placement& tool, const Budget& budget,
                                TouchSet& touches) noexcept;
  /// Where that answer says that nothing is touched: measures the gap by what is left of the
  /// budget. What that takes counts among the tests.
  void measure_gap(const Placement& tool, const Budget& budget, QueryResult& answer) noexcept;

  [[nodiscard]] std::size_t bytes() const noexcept { return query_.bytes() + points_.bytes(); }

 private:
  IST_LOCAL void reduce(const Placement& tool, TouchSet& touches) const noexcept;

  BodyFrames frames_;
  double area_;  // of a whole leaf pair, mesh units squared
  CollisionQuery query_;
  ContactPoints points_;
};

}  // namespace ist
