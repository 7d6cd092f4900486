#include "ist/mesh/components.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "ist/base/assert.h"

namespace ist {

std::vector<EdgeUse> sorted_edge_uses(const TriangleMesh& mesh) {
  // A counting sort by the lower vertex makes buckets of a handful of uses, sorted below.
  std::vector<std::uint32_t> bucket_end(mesh.vertices.size() + 1, 0);
  const auto for_each_side = [&mesh](auto&& body) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& triangle = mesh.triangles[t];
      if (has_equal_indices(triangle)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = triangle[k], to = triangle[(k + 1) % 3];
        IST_ASSERT(from < mesh.vertices.size());
        body(EdgeUse{std::min(from, to), std::max(from, to), static_cast<std::uint32_t>(t),
                     from < to});
      }
    }
  };
  for_each_side([&](const EdgeUse& use) { ++bucket_end[use.low + 1]; });
  std::partial_sum(bucket_end.begin(), bucket_end.end(), bucket_end.begin());
  std::vector<EdgeUse> uses(bucket_end.back());
  for_each_side([&](const EdgeUse& use) { uses[bucket_end[use.low]++] = use; });
  auto begin = uses.begin();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto end = uses.begin() + static_cast<std::ptrdiff_t>(bucket_end[v]);
    std::sort(begin, end, [](const EdgeUse& a, const EdgeUse& b) {
      return std::tie(a.high, a.triangle) < std::tie(b.high, b.triangle);
    });
    begin = end;
  }
  return uses;
}

bool is_balanced(std::span<const EdgeUse> edge) {
  const auto forward =
      std::count_if(edge.begin(), edge.end(), [](const EdgeUse& use) { return use.forward; });
  return 2 * forward == static_cast<std::ptrdiff_t>(edge.size());
}

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
    if (!is_balanced(edge))
      components[component_of_set[sets.find(edge[0].triangle)]].closed = false;
  });
  return components;
}

}  // namespace ist
