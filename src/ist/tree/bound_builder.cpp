#include "ist/tree/bound_builder.h"

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"
#include "ist/base/parallel.h"
#include "ist/mesh/nearest_point.h"
#include "ist/tree/nested_bounds.h"
#include "ist/tree/node_bounds.h"
#include "ist/voxel/morton.h"
#include "ist/voxel/triangle_bins.h"
#include "ist/voxel/triangle_clip.h"

namespace ist {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kParentsARange = 128;

// Fits the bounds of leaves, in lattice units.
class LeafBuilder {
 public:
  LeafBuilder(const LatticeMesh& mesh, const VoxelSet& voxels, const LinearOctree& octree,
              double pad)
      : mesh_(mesh), voxels_(voxels), octree_(octree) {
    payload_.pad = pad;
  }

  void build(std::uint32_t parent, BallBlock& balls, SlabBlock* slabs) {
    const std::span<const OctreeNode> parents = octree_.nodes(1);
    const double root = voxels_.lattice.root_centre();
    const auto& [x, y, z] = parents[parent].centre;
    const Vector3d parent_centre(root + double{x}, root + double{y}, root + double{z});
    const std::uint32_t first = parents[parent].first_child, end = parents[parent + 1].first_child;
    for (std::uint32_t leaf = first; leaf < end; ++leaf) {
      gather(leaf);
      const auto slot = static_cast<int>(leaf - first);
      const PackedBall ball = pack_ball(payload_, parent_centre, 2);
      balls.set(slot, ball);
      if (slabs == nullptr) continue;
      slabs->set(slot, pack_slab(payload_, centre_of(ball, parent_centre, 2), 1));
    }
  }

 private:
  // Gathers the triangles' parts in the cube; for a triangle with no such part, its nearest point.
  void gather(std::uint32_t leaf) {
    const Cell cell = morton_decode(voxels_.codes[leaf]);
    const Vector3d centre(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5);
    const Vector3d reach = Vector3d::Constant(0.5 + voxels_.lattice.pad());
    const Vector3d low = centre - reach, high = centre + reach;
    payload_.points.clear();
    payload_.area = Vector3d::Zero();
    for (const std::uint32_t t : voxels_.triangles[leaf]) {
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
  Payload payload_;
  ClippedTriangle clipped_;
};

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
  const std::span<const OctreeNode> parents = octree.nodes(1);
  BoundBlocks bounds;
  bounds.balls.resize(levels);
  bounds.balls[0].resize(parents.size() - 1);
  if (policy == SpherePolicy::kSlab) {
    bounds.slabs.resize(levels);
    bounds.slabs[0].resize(parents.size() - 1);
  }
  // Lattice coordinates and the corners of clipped pieces err by at most sixteen 2⁻⁵³ of the grid's
  // extent: two roundings for a coordinate, and three or four for each of three cuts.
  const double pad = 0x1p-48 * (2 * voxels.lattice.root_centre());
  parallel_for(parents.size() - 1, kParentsARange, [&](std::size_t begin, std::size_t end) {
    shown.check();
    LeafBuilder builder(lattice_mesh, voxels, octree, pad);
    for (std::size_t parent = begin; parent < end; ++parent) {
      builder.build(static_cast<std::uint32_t>(parent), bounds.balls[0][parent],
                    bounds.slabs.empty() ? nullptr : &bounds.slabs[0][parent]);
    }
    shown.add(parents[end].first_child - parents[begin].first_child);
  });
  nest_bounds(octree, pad, bounds, shown);
  return bounds;
}

}  // namespace ist
