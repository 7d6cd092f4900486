#include "ist/tree/tight_spheres.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "ist/base/parallel.h"
#include "ist/tree/enclosing_ball.h"
#include "ist/voxel/nearest_point.h"
#include "ist/voxel/triangle_bins.h"
#include "ist/voxel/triangle_clip.h"

namespace ist {
namespace {

constexpr std::size_t kNodesARange = 512;
// What is spent of the 1 %: the rest is for the rounding to float.
constexpr double kTolerance = 0.008;

float round_up(double value) noexcept {
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) >= value
             ? nearest
             : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

class LevelBuilder {
 public:
  LevelBuilder(const LatticeMesh& mesh, const Lattice& lattice, int level)
      : mesh_(mesh), lattice_(lattice), edge_(static_cast<double>(std::uint64_t{1} << level)) {}

  Sphere sphere(std::uint64_t code, std::span<const std::uint32_t> triangles) {
    const Cell cell = morton_decode(code);
    const double pad = lattice_.pad();
    Eigen::Vector3d low, high;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      low[axis] = cell[i] * edge_ - pad;
      high[axis] = (cell[i] + 1.0) * edge_ + pad;
    }
    points_.clear();
    for (const std::uint32_t t : triangles) {
      const auto corners = mesh_.corners(t);
      clip_triangle(corners, low, high, clipped_);
      points_.insert(points_.end(), clipped_.corners.begin(),
                     clipped_.corners.begin() + clipped_.count);
      if (clipped_.count == 0) {
        points_.push_back(nearest_on_triangle(corners, 0.5 * (low + high)).point);
      }
    }
    return narrow(enclosing_ball(points_, kTolerance).centre);
  }

 private:
  // To float and mesh units, round the centre that float has.
  Sphere narrow(const Eigen::Vector3d& centre) const {
    const double s = lattice_.voxel_size, root = lattice_.root_centre();
    Sphere sphere{static_cast<float>(s * (centre[0] - root)),
                  static_cast<float>(s * (centre[1] - root)),
                  static_cast<float>(s * (centre[2] - root)), 0};
    double farthest2 = 0;
    for (const Eigen::Vector3d& point : points_) {
      const double dx = s * (point[0] - root) - static_cast<double>(sphere.x);
      const double dy = s * (point[1] - root) - static_cast<double>(sphere.y);
      const double dz = s * (point[2] - root) - static_cast<double>(sphere.z);
      farthest2 = std::max(farthest2, (dx * dx + dy * dy) + dz * dz);
    }
    // Lattice coordinates and clipped corners are right to a few 2⁻⁵² of the grid's extent.
    const double slack = 0x1p-48 * s * (2 * root);
    sphere.r = round_up(std::sqrt(farthest2) * (1 + 0x1p-50) + slack);
    return sphere;
  }

  const LatticeMesh& mesh_;
  const Lattice& lattice_;
  double edge_;
  std::vector<Eigen::Vector3d> points_;
  ClippedTriangle clipped_;
};

// The triangles of each node, from those of its children.
TriangleLists merge_lists(const TriangleLists& children, const LinearOctree& octree, int level) {
  const std::size_t nodes = octree.node_count(level);
  std::vector<std::vector<std::uint32_t>> parts((nodes + kNodesARange - 1) / kNodesARange);
  TriangleLists lists;
  lists.first.resize(nodes + 1);
  parallel_for(nodes, kNodesARange, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t>& part = parts[begin / kNodesARange];
    for (std::size_t n = begin; n < end; ++n) {
      const auto node = static_cast<std::uint32_t>(n);
      const std::uint32_t first = octree.first_child(level, node);
      const auto count = static_cast<std::uint32_t>(std::popcount(octree.mask(level, node)));
      const auto start = static_cast<std::ptrdiff_t>(part.size());
      part.insert(part.end(), children.ids.begin() + children.first[first],
                  children.ids.begin() + children.first[first + count]);
      std::sort(part.begin() + start, part.end());
      part.erase(std::unique(part.begin() + start, part.end()), part.end());
      lists.first[n + 1] =
          static_cast<std::uint32_t>(static_cast<std::ptrdiff_t>(part.size()) - start);
    }
  });
  for (std::size_t n = 0; n < nodes; ++n) lists.first[n + 1] += lists.first[n];
  lists.ids.reserve(lists.first.back());
  for (auto& part : parts) {
    lists.ids.insert(lists.ids.end(), part.begin(), part.end());
    part = {};
  }
  return lists;
}

}  // namespace

SphereLevels make_tight_spheres(const TriangleMesh& mesh, const VoxelSet& voxels,
                                const LinearOctree& octree, Progress* progress) {
  Progress unseen;
  Progress& shown = progress != nullptr ? *progress : unseen;
  shown.begin_stage("making tight spheres", octree.node_count());
  const LatticeMesh lattice_mesh(mesh, voxels.lattice);
  SphereLevels levels(static_cast<std::size_t>(octree.depth()) + 1);
  TriangleLists merged;
  for (int level = 0; level <= octree.depth(); ++level) {
    if (level > 0) merged = merge_lists(level == 1 ? voxels.triangles : merged, octree, level);
    const TriangleLists& lists = level == 0 ? voxels.triangles : merged;
    const std::vector<std::uint64_t> codes = octree.codes(level);
    std::vector<Sphere>& spheres = levels[static_cast<std::size_t>(level)];
    spheres.resize(codes.size());
    parallel_for(codes.size(), kNodesARange, [&](std::size_t begin, std::size_t end) {
      LevelBuilder builder(lattice_mesh, voxels.lattice, level);
      for (std::size_t node = begin; node < end; ++node) {
        spheres[node] = builder.sphere(codes[node], lists[node]);
      }
      shown.add(end - begin);
    });
  }
  return levels;
}

}  // namespace ist
