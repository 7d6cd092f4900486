#include "ist/tree/bound_builder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"
#include "ist/base/parallel.h"
#include "ist/tree/node_bounds.h"
#include "ist/voxel/nearest_point.h"
#include "ist/voxel/triangle_bins.h"
#include "ist/voxel/triangle_clip.h"

namespace ist {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kNodesARange = 512;
constexpr std::size_t kParentsARange = 128;

// Fits the bounds of one level's nodes, in lattice units.
class LevelBuilder {
 public:
  LevelBuilder(const LatticeMesh& mesh, const VoxelSet& voxels, const LinearOctree& octree,
               int level)
      : mesh_(mesh),
        voxels_(voxels),
        octree_(octree),
        level_(level),
        edge_(static_cast<double>(std::uint64_t{1} << level)) {
    // Lattice coordinates and the corners of clipped pieces err by at most sixteen 2⁻⁵³ of the
    // grid's extent: two roundings for a coordinate, and three or four for each of three cuts.
    payload_.pad = 0x1p-48 * (2 * voxels.lattice.root_centre());
  }

  void build(std::uint32_t parent, const TriangleLists& triangles, BallBlock& balls,
             SlabBlock* slabs) {
    const std::span<const OctreeNode> parents = octree_.nodes(level_ + 1);
    const Vector3d parent_centre = in_grid(parents[parent]);
    const std::uint32_t first = parents[parent].first_child, end = parents[parent + 1].first_child;
    for (std::uint32_t node = first; node < end; ++node) {
      gather(cube_centre(node), triangles[node]);
      const auto slot = static_cast<int>(node - first);
      const PackedBall ball = pack_ball(payload_, parent_centre, 2 * edge_);
      balls.set(slot, ball);
      if (slabs == nullptr) continue;
      slabs->set(slot, pack_slab(payload_, centre_of(ball, parent_centre, 2 * edge_), edge_));
    }
  }

 private:
  [[nodiscard]] Vector3d in_grid(const OctreeNode& node) const noexcept {
    const double root = voxels_.lattice.root_centre();
    return {root + double{node.centre[0]}, root + double{node.centre[1]},
            root + double{node.centre[2]}};
  }
  [[nodiscard]] Vector3d cube_centre(std::uint32_t node) const noexcept {
    if (level_ > 0) return in_grid(octree_.nodes(level_)[node]);
    const Cell cell = morton_decode(voxels_.codes[node]);
    return {cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5};
  }

  // Gathers the triangles' parts in the cube; for a triangle with no such part, its nearest point.
  void gather(const Vector3d& centre, std::span<const std::uint32_t> triangles) {
    const Vector3d reach = Vector3d::Constant(0.5 * edge_ + voxels_.lattice.pad());
    const Vector3d low = centre - reach, high = centre + reach;
    payload_.points.clear();
    payload_.area = Vector3d::Zero();
    for (const std::uint32_t t : triangles) {
      const auto corners = mesh_.corners(t);
      clip_triangle(corners, low, high, clipped_);
      const auto* const piece = clipped_.corners.data();
      payload_.points.insert(payload_.points.end(), piece, piece + clipped_.count);
      for (int i = 2; i < clipped_.count; ++i) {
        payload_.area += (piece[i - 1] - piece[0]).cross(piece[i] - piece[0]);
      }
      if (clipped_.count == 0) {
        payload_.points.push_back(nearest_on_triangle(corners, centre).point);
      }
    }
  }

  const LatticeMesh& mesh_;
  const VoxelSet& voxels_;
  const LinearOctree& octree_;
  int level_;
  double edge_;
  Payload payload_;
  ClippedTriangle clipped_;
};

// Merges the triangle lists of each node's children.
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

BoundBlocks build_bounds(SpherePolicy policy, const TriangleMesh& mesh, const VoxelSet& voxels,
                         const LinearOctree& octree, Progress* progress) {
  const ScopedFloatEnvironment environment;
  IST_ASSERT(!is_implicit(policy));
  Progress unseen;
  Progress& shown = progress != nullptr ? *progress : unseen;
  shown.begin_stage("fitting bounds", octree.node_count());
  const LatticeMesh lattice_mesh(mesh, voxels.lattice);
  const auto levels = static_cast<std::size_t>(octree.depth()) + 1;
  BoundBlocks bounds;
  bounds.balls.resize(levels);
  if (policy == SpherePolicy::kSlab) bounds.slabs.resize(levels);
  TriangleLists merged;
  for (int level = 0; level <= octree.depth(); ++level) {
    if (level > 0) merged = merge_lists(level == 1 ? voxels.triangles : merged, octree, level);
    const TriangleLists& lists = level == 0 ? voxels.triangles : merged;
    const std::span<const OctreeNode> parents = octree.nodes(level + 1);
    const auto index = static_cast<std::size_t>(level);
    bounds.balls[index].resize(parents.size() - 1);
    if (!bounds.slabs.empty()) bounds.slabs[index].resize(parents.size() - 1);
    parallel_for(parents.size() - 1, kParentsARange, [&](std::size_t begin, std::size_t end) {
      LevelBuilder builder(lattice_mesh, voxels, octree, level);
      for (std::size_t parent = begin; parent < end; ++parent) {
        builder.build(static_cast<std::uint32_t>(parent), lists, bounds.balls[index][parent],
                      bounds.slabs.empty() ? nullptr : &bounds.slabs[index][parent]);
      }
      shown.add(parents[end].first_child - parents[begin].first_child);
    });
  }
  return bounds;
}

}  // namespace ist
