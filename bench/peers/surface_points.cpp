#include "peers/surface_points.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ist::bench {
namespace {

// Blocks in the order of z, y, x, and so the voxels in each.
std::uint64_t key_of(const Eigen::Vector3d& point, double voxel_size) {
  std::uint64_t blocks = 0, voxels = 0;
  for (Eigen::Index i = 2; i >= 0; --i) {
    const auto at = static_cast<std::uint64_t>(
        static_cast<std::int64_t>(std::floor(point[i] / voxel_size)) + (1 << 20));
    blocks = blocks << 18 | at >> 3;
    voxels = voxels << 3 | (at & 7);
  }
  return blocks << 9 | voxels;
}

}  // namespace

std::vector<Eigen::Vector3d> surface_points(const TriangleMesh& mesh, double voxel_size) {
  std::vector<std::pair<std::uint64_t, Eigen::Vector3d>> points;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    const double longest = std::max({(q - p).norm(), (r - q).norm(), (p - r).norm()});
    const int n = std::max(1, static_cast<int>(std::ceil(longest / voxel_size)));
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n - i; ++j) {
        const Eigen::Vector3d point = p + (i * (q - p) + j * (r - p)) / n;
        points.emplace_back(key_of(point, voxel_size), point);
      }
    }
  }
  const auto key = [](const auto& point) { return point.first; };
  std::ranges::stable_sort(points, {}, key);
  const auto rest = std::ranges::unique(points, {}, key);
  std::vector<Eigen::Vector3d> kept;
  kept.reserve(static_cast<std::size_t>(rest.begin() - points.begin()));
  for (auto i = points.begin(); i != rest.begin(); ++i) kept.push_back(i->second);
  return kept;
}

}  // namespace ist::bench
