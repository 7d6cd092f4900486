#include "ist/mesh/orientation.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ist/mesh/edges.h"

namespace ist {
namespace {

struct Component {
  std::vector<std::uint32_t> triangles;  // in their order in the mesh
  Eigen::AlignedBox3d box;
  bool closed = true;  // and consistent
  int volume_sign = 0;
};

std::vector<Component> split(const TriangleMesh& mesh) {
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  DisjointSets sets(mesh.triangles.size());
  for_each_edge(uses, [&sets](std::span<const EdgeUse> edge) {
    for (const EdgeUse& use : edge) sets.join(edge[0].triangle, use.triangle);
  });
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> component_of_set(mesh.triangles.size(), kNone);
  std::vector<Component> components;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (has_equal_indices(mesh.triangles[t])) continue;
    const auto triangle = static_cast<std::uint32_t>(t);
    std::uint32_t& component = component_of_set[sets.find(triangle)];
    if (component == kNone) {
      component = static_cast<std::uint32_t>(components.size());
      components.emplace_back();
    }
    components[component].triangles.push_back(triangle);
    for (const std::uint32_t vertex : mesh.triangles[t])
      components[component].box.extend(mesh.vertices[vertex]);
  }
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 2 || edge[0].forward == edge[1].forward)
      components[component_of_set[sets.find(edge[0].triangle)]].closed = false;
  });
  return components;
}

// The sign of the enclosed volume; 0 where rounding could have made it. Relative to the
// component's own vertex and extent, so that neither place nor unit matters.
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
    const double sixfold = a.dot(b.cross(c));
    sum += sixfold;
    size += std::abs(sixfold);
  }
  constexpr double kDoubt = 1e-12;
  if (!(std::abs(sum) > kDoubt * size)) return 0;
  return sum > 0 ? 1 : -1;
}

// How often the ray from the origin along `direction` leaves the triangle's inner side: 1, 0 or
// -1, and nothing where it passes so near to an edge that rounding could decide.
std::optional<int> crossing(const Eigen::Vector3d& direction, const Eigen::Vector3d& a,
                            const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  constexpr double kDoubt = 1e-12;
  const auto side = [&direction](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const double volume = direction.dot(from.cross(to));
    const double doubt = kDoubt * from.cwiseAbs().maxCoeff() * to.cwiseAbs().maxCoeff();
    return volume > doubt ? 1 : volume < -doubt ? -1 : 0;
  };
  const int ab = side(a, b), bc = side(b, c), ca = side(c, a);
  if (ab * bc < 0 || bc * ca < 0 || ca * ab < 0) return 0;
  if (ab == 0 || bc == 0 || ca == 0) return std::nullopt;
  const double height = a.dot((b - a).cross(c - a));  // beyond the origin, along the normal
  return (height > 0) == (ab > 0) ? ab : 0;
}

// How often a closed component winds round a point: what a ray from it crosses, out less in. The
// direction is changed while the ray meets an edge; all of them do only from a point on the
// surface, for which there is no answer.
std::optional<int> winding_number(const TriangleMesh& mesh, const Component& component,
                                  const Eigen::Vector3d& point) {
  static const std::array<Eigen::Vector3d, 8> kDirections = {{{0.5377, 0.2931, 0.7905},
                                                              {-0.6121, 0.7417, 0.2741},
                                                              {0.8693, -0.4243, 0.2537},
                                                              {0.3187, 0.6173, -0.7193},
                                                              {-0.4877, -0.3797, 0.7861},
                                                              {-0.7219, 0.1531, -0.6749},
                                                              {0.1319, -0.9203, -0.3683},
                                                              {-0.2399, -0.5101, -0.8261}}};
  for (const Eigen::Vector3d& direction : kDirections) {
    std::optional<int> winding = 0;
    for (const std::uint32_t t : component.triangles) {
      const Triangle& triangle = mesh.triangles[t];
      const std::optional<int> crossed =
          crossing(direction, mesh.vertices[triangle[0]] - point,
                   mesh.vertices[triangle[1]] - point, mesh.vertices[triangle[2]] - point);
      if (!crossed) {
        winding.reset();
        break;
      }
      *winding += *crossed;
    }
    if (winding) return winding;
  }
  return std::nullopt;
}

// Whether one component lies inside another, by one of its vertices: the first that is not on the
// other's surface, of a few. Components that cross each other are not inside.
bool lies_inside(const TriangleMesh& mesh, const Component& inner, const Component& outer) {
  if (!outer.box.contains(inner.box)) return false;
  constexpr std::size_t kTries = 8;
  const std::size_t step = std::max<std::size_t>(1, inner.triangles.size() / kTries);
  for (std::size_t i = 0; i < inner.triangles.size(); i += step) {
    const Eigen::Vector3d& vertex = mesh.vertices[mesh.triangles[inner.triangles[i]][0]];
    if (const std::optional<int> winding = winding_number(mesh, outer, vertex))
      return *winding != 0;
  }
  return false;
}

// Components that are not closed count as well, as the ray sees them. They often are a skull with a
// few bad edges, and what lies in them its cavities: where in doubt, the file's winding is
// believed.
bool is_outermost(const TriangleMesh& mesh, std::span<const Component> components,
                  const Component& one) {
  for (const Component& other : components)
    if (&other != &one && lies_inside(mesh, one, other)) return false;
  return true;
}

}  // namespace

OrientationResult orient_outward(TriangleMesh& mesh) {
  std::vector<Component> components = split(mesh);
  OrientationResult result;
  result.orientation = components.empty() ? Orientation::kAssumed : Orientation::kOutward;
  for (Component& component : components) {
    if (component.closed) component.volume_sign = volume_sign(mesh, component);
    if (component.volume_sign == 0) result.orientation = Orientation::kAssumed;
  }
  // Whether a point is inside does not depend on which way the component round it is turned.
  for (const Component& component : components) {
    if (component.volume_sign >= 0 || !is_outermost(mesh, components, component)) continue;
    for (const std::uint32_t t : component.triangles)
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    ++result.turned_components;
  }
  return result;
}

}  // namespace ist
