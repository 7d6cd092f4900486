#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/mesh/components.h"
#include "ist/mesh/mesh.h"
#include "ist/mesh/winding_number.h"

namespace ist {
namespace {

// Returns the sign of the enclosed volume, or 0 if rounding could have made it. Works relative to
// the component's own vertex and extent, so that neither position nor unit matters.
int volume_sign(const TriangleMesh& mesh, const Component& component) {
  const Eigen::Vector3d origin = mesh.vertices[mesh.triangles[component.triangles[0]][0]];
  const double extent = component.box.sizes().maxCoeff();
  if (!(extent > 0)) return 0;
  double sum = 0, size = 0;
  for (const std::uint32_t t : component.triangles) {
    const Triangle& triangle = mesh.triangles[t];
    const Eigen::Vector3d a = (mesh.vertices[triangle[0]] - origin) / extent;
    const Eigen::Vector3d b = (mesh.vertices[triangle[1]] - origin) / extent;
    const Eigen::Vector3d c = (mesh.vertices[triangle[2]] - origin) / extent;
    const double sixfold = dot_in_order(a, b.cross(c));
    sum += sixfold;
    size += std::abs(sixfold);
  }
  constexpr double kDoubt = 1e-12;
  if (!(std::abs(sum) > kDoubt * size)) return 0;
  return sum > 0 ? 1 : -1;
}

// Whether one component lies inside another, by the winding number of one vertex: the first of a
// few that is not on the other's surface. A component whose box leaves the other's box is not
// inside.
bool lies_inside(const TriangleMesh& mesh, const Component& inner, const Component& outer) {
  if (!outer.box.contains(inner.box)) return false;
  constexpr std::size_t kTries = 8;
  const std::size_t step = std::max<std::size_t>(1, inner.triangles.size() / kTries);
  for (std::size_t i = 0; i < inner.triangles.size(); i += step) {
    const Eigen::Vector3d& vertex = mesh.vertices[mesh.triangles[inner.triangles[i]][0]];
    if (const std::optional<int> winding = winding_number(mesh, outer.triangles, vertex))
      return *winding != 0;
  }
  return false;
}

// Open components count as well, by the crossings of the ray: often such a component is a skull
// with a few bad edges, and the components inside it are its cavities. In doubt the file's winding
// is trusted.
bool is_outermost(const TriangleMesh& mesh, std::span<const Component> components,
                  const Component& one) {
  for (const Component& other : components)
    if (&other != &one && lies_inside(mesh, one, other)) return false;
  return true;
}

}  // namespace

OrientationResult orient_outward(TriangleMesh& mesh) {
  const ScopedFloatEnvironment environment;
  const std::vector<Component> components = components_of(mesh);
  OrientationResult result;
  result.orientation = components.empty() ? Orientation::kAssumed : Orientation::kOutward;
  // The inside test does not depend on the winding of the surrounding component.
  for (const Component& component : components) {
    const int sign = component.closed ? volume_sign(mesh, component) : 0;
    if (sign == 0) result.orientation = Orientation::kAssumed;
    if (sign >= 0 || !is_outermost(mesh, components, component)) continue;
    for (const std::uint32_t t : component.triangles)
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    ++result.turned_components;
  }
  return result;
}

}  // namespace ist
