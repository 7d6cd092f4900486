#include "ist/mesh/components.h"

#include <limits>
#include <span>

#include "ist/mesh/edges.h"

namespace ist {

std::vector<Component> components_of(const TriangleMesh& mesh) {
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

}  // namespace ist
