#include "ist/query/inside.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "ist/base/float_environment.h"
#include "ist/base/rigid_move.h"
#include "ist/mesh/clusters/triangle_clusters.h"
#include "ist/mesh/components.h"
#include "ist/mesh/winding_number.h"
#include "ist/query/query_state.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

// A body, and a point of each of its components.
struct Solid {
  const TriangleMesh& mesh;
  const TriangleClusters* clusters;  // null without triangles
  const Eigen::AlignedBox3d& box;
  std::span<const Eigen::Vector3d> points;
};

bool holds(const Solid& outer, const Solid& inner, const RigidMove& to_outer) noexcept {
  const auto inside = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d there = to_outer(point);
    return outer.box.contains(there) &&
           WindingNumber(outer.mesh, *outer.clusters).at(there).value_or(0) != 0;
  };
  return !inner.points.empty() && std::all_of(inner.points.begin(), inner.points.end(), inside);
}

// Returns the one of two bodies that lies inside the other. Their surfaces do not intersect.
Inside inside_of(const Solid& fixed, const Solid& moving, const Eigen::Isometry3d& pose) noexcept {
  if (holds(fixed, moving, RigidMove(pose))) return Inside::kMoving;
  return holds(moving, fixed, RigidMove(inverse_of(pose))) ? Inside::kFixed : Inside::kNone;
}

Solid solid_of(const TreeTriangles& of) {
  return {of.mesh, &of.clusters, of.box(), of.component_points()};
}

}  // namespace

const char* to_string(Inside inside) noexcept {
  constexpr std::array kNames = {"none", "fixed", "moving"};
  const auto at = static_cast<std::size_t>(inside);
  return at < kNames.size() ? kNames[at] : "unknown";
}

InsideResult Query::inside(const Eigen::Isometry3d& pose) {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy};
  if (!s.triangles) return {.status = QueryStatus::kNoTriangles};
  const std::optional<detail::Approach> bodies = s.approach(pose, s.triangle_error(pose));
  const double off = rotation_error(pose);
  if (!bodies) return {.status = QueryStatus::kInvalidPose, .rotation_error = off};
  InsideResult result{.rotation_error = off};
  if (!bodies->roots.overlap) return result;
  const Eigen::Isometry3d rigid = *project_to_rigid(pose);
  if (s.triangles->any({rigid, bodies->relative}, {}).found) return result;
  result.inside = inside_of(solid_of(*parts_of(s.fixed).triangles),
                            solid_of(*parts_of(s.moving).triangles), rigid);
  return result;
}

namespace detail {

struct InsideState {
  struct Body {
    explicit Body(const TriangleMesh& of) : mesh(of) {
      if (!mesh.triangles.empty()) {
        require_valid(mesh);
        clusters.emplace(mesh, mesh.vertices[mesh.triangles[0][0]]);
      }
      for (const Component& component : components_of(mesh)) {
        points.push_back(mesh.vertices[mesh.triangles[component.triangles[0]][0]]);
        box.extend(component.box);
      }
    }
    [[nodiscard]] Solid solid() const noexcept {
      return {mesh, clusters ? &*clusters : nullptr, box, points};
    }

    const TriangleMesh& mesh;
    std::optional<TriangleClusters> clusters;
    std::vector<Eigen::Vector3d> points;  // one a component
    Eigen::AlignedBox3d box;
  };

  Body fixed, moving;
};

}  // namespace detail

InsideTest::InsideTest(const TriangleMesh& fixed, const TriangleMesh& moving) {
  const ScopedFloatEnvironment environment;
  state_.reset(
      new detail::InsideState{detail::InsideState::Body(fixed), detail::InsideState::Body(moving)});
}
InsideTest::~InsideTest() = default;
InsideTest::InsideTest(InsideTest&&) noexcept = default;
InsideTest& InsideTest::operator=(InsideTest&&) noexcept = default;

Inside InsideTest::at(const Eigen::Isometry3d& pose) const noexcept {
  const ScopedFloatEnvironment environment;
  return inside_of(state_->fixed.solid(), state_->moving.solid(), pose);
}

}  // namespace ist
