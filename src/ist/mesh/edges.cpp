#include "ist/mesh/edges.h"

#include <algorithm>
#include <tuple>

#include "ist/base/assert.h"

namespace ist {

std::vector<EdgeUse> sorted_edge_uses(const TriangleMesh& mesh) {
  // A counting sort by the lower vertex leaves buckets of a handful, which are then sorted.
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

}  // namespace ist
