#include "ist/query/inside.h"

#include <algorithm>

#include "ist/base/float_environment.h"
#include "ist/mesh/components.h"
#include "ist/mesh/winding_number.h"

namespace ist {

const char* to_string(Inside inside) noexcept {
  switch (inside) {
    case Inside::kFixed:
      return "fixed";
    case Inside::kMoving:
      return "moving";
    case Inside::kNone:
      break;
  }
  return "none";
}

InsideTest::InsideTest(const TriangleMesh& fixed, const TriangleMesh& moving)
    : fixed_(body(fixed)), moving_(body(moving)) {}

InsideTest::Body InsideTest::body(const TriangleMesh& mesh) {
  Body body{mesh, {}, {}, {}};
  for (const Component& component : components_of(mesh)) {
    body.triangles.insert(body.triangles.end(), component.triangles.begin(),
                          component.triangles.end());
    body.points.push_back(mesh.vertices[mesh.triangles[component.triangles[0]][0]]);
    body.box.extend(component.box);
  }
  return body;
}

bool InsideTest::holds(const Body& outer, const Body& inner,
                       const Eigen::Isometry3d& to_outer) noexcept {
  return !inner.points.empty() &&
         std::all_of(inner.points.begin(), inner.points.end(), [&](const Eigen::Vector3d& point) {
           const Eigen::Vector3d there = to_outer * point;
           return outer.box.contains(there) &&
                  winding_number(outer.mesh, outer.triangles, there).value_or(0) != 0;
         });
}

Inside InsideTest::at(const Eigen::Isometry3d& pose) const noexcept {
  const ScopedFloatEnvironment environment;
  if (holds(fixed_, moving_, pose)) return Inside::kMoving;
  return holds(moving_, fixed_, pose.inverse()) ? Inside::kFixed : Inside::kNone;
}

}  // namespace ist
