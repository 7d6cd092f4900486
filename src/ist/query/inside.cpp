#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "ist/base/float_environment.h"
#include "ist/base/rigid_move.h"
#include "ist/mesh/clusters/triangle_clusters.h"
#include "ist/mesh/components.h"
#include "ist/mesh/winding_number.h"
#include "ist/query/query.h"

namespace ist {
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
    // Whether all components of the other body lie inside this one.
    [[nodiscard]] bool holds(const Body& inner, const RigidMove& to_this) const noexcept {
      const auto inside = [&](const Eigen::Vector3d& point) {
        const Eigen::Vector3d there = to_this(point);
        return box.contains(there) && WindingNumber(mesh, *clusters).at(there).value_or(0) != 0;
      };
      return !inner.points.empty() && std::all_of(inner.points.begin(), inner.points.end(), inside);
    }

    const TriangleMesh& mesh;
    std::optional<TriangleClusters> clusters;
    std::vector<Eigen::Vector3d> points;  // one a component
    Eigen::AlignedBox3d box;
  };

  Body fixed, moving;
};

}  // namespace detail

const char* to_string(Inside inside) noexcept {
  constexpr std::array kNames = {"none", "fixed", "moving"};
  const auto at = static_cast<std::size_t>(inside);
  return at < kNames.size() ? kNames[at] : "unknown";
}

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
  if (state_->fixed.holds(state_->moving, RigidMove(pose))) return Inside::kMoving;
  return state_->moving.holds(state_->fixed, RigidMove(inverse_of(pose))) ? Inside::kFixed
                                                                          : Inside::kNone;
}

}  // namespace ist
