#include "ist/tree/sphere_tree.h"

#include <algorithm>
#include <cmath>

#include "ist/base/assert.h"
#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/bounding_box.h"
#include "ist/mesh/components.h"
#include "ist/tree/mesh_source.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

// How far a published table ball extends from its cube's centre at most, in half edges of the cube:
// (√12 + √96)/6, rounded up, with the radius code 3.
constexpr double kTableExtent = 2.21034343104508;
constexpr std::size_t kTableExtentCode = 3;

// Covers the rounding of a length and of a sum.
constexpr double kRoundedUp = 1 + 0x1p-50;

// The bounding radius of implicit balls: a nested root ball of the table extends farthest
// (docs/guarantees.md, Bounding radius).
double implicit_bounding_radius(const Lattice& lattice) {
  return kTableExtent * 0.5 * lattice.edge(lattice.depth) +
         leaf_excess(lattice.depth, kTableExtentCode) * lattice.voxel_size;
}

// Whether `blocks` is empty or has a block for each parent of each level.
template <typename Block>
[[maybe_unused]] bool fit(const std::vector<std::vector<Block>>& blocks,
                          const LinearOctree& octree) {
  bool fit = blocks.empty() || blocks.size() == static_cast<std::size_t>(octree.depth()) + 1;
  for (std::size_t level = 0; fit && level < blocks.size(); ++level) {
    fit = blocks[level].size() + 1 == octree.nodes(static_cast<int>(level) + 1).size();
  }
  return fit;
}

// Completes the voxels of a tree, and returns the bounding radius of all their spheres.
double measured(TreeVoxels& voxels) {
  IST_ASSERT(voxels.octree.depth() == voxels.lattice.depth);
  IST_ASSERT(voxels.normals.size() == voxels.octree.leaf_count());
  IST_ASSERT(fit(voxels.bounds.balls, voxels.octree) && fit(voxels.bounds.slabs, voxels.octree));
  IST_ASSERT(voxels.bounds.slabs.empty() || !voxels.bounds.balls.empty());
  double bounding_radius = implicit_bounding_radius(voxels.lattice);
  if (voxels.bounds.balls.empty()) return bounding_radius;
  for (int level = 0; level <= voxels.octree.depth(); ++level) {
    double largest = 0, farthest2 = 0;
    for (std::uint32_t parent = 0; parent < voxels.balls(level).size(); ++parent) {
      for (int slot = 0; slot < voxels.octree.child_count(level + 1, parent); ++slot) {
        const Ball ball = voxels.saved_ball(level, parent, slot);
        largest = std::max(largest, ball.radius);
        farthest2 = std::max(farthest2, square_in_order(ball.centre));
      }
    }
    if (level == 0) voxels.largest_saved_leaf = largest;
    // The largest radius plus the farthest centre of a level: a cheap upper bound.
    bounding_radius = std::max(bounding_radius, (std::sqrt(farthest2) + largest) * kRoundedUp);
  }
  return bounding_radius;
}

// The bounding radius of all vertices in use.
double measured(const TreeTriangles& triangles) {
  const Eigen::Vector3d& origin = triangles.clusters.origin();
  double farthest2 = 0;
  for (const Triangle& triangle : triangles.mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      const Eigen::Vector3d from = difference(triangles.mesh.vertices[vertex], origin);
      farthest2 = std::max(farthest2, square_in_order(from));
    }
  }
  return std::sqrt(farthest2) * kRoundedUp;
}

TreeParts measured(TreeParts parts) {
  IST_ASSERT(parts.voxels || parts.triangles);
  IST_ASSERT(source_flaw(parts.source) == nullptr);
  IST_ASSERT(!parts.voxels || !parts.triangles ||
             parts.voxels->lists.size() == parts.voxels->octree.leaf_count());
  if (parts.voxels) {
    parts.origin = parts.voxels->lattice;
    parts.bounding_radius = measured(*parts.voxels);
  } else {
    parts.origin = parts.triangles->clusters.origin();
    parts.bounding_radius = measured(*parts.triangles);
  }
  return parts;
}

}  // namespace

const TreeTriangles::Lazy& TreeTriangles::made() const {
  std::call_once(lazy_->once, [this] {
    lazy_->sides.emplace(mesh, clusters);
    for (const Component& component : components_of(mesh)) {
      lazy_->component_points.push_back(mesh.vertices[mesh.triangles[component.triangles[0]][0]]);
    }
  });
  return *lazy_;
}

void TreeTriangles::keep_outer_balls(OuterBalls balls) const {
  std::call_once(lazy_->balls_once, [&] {
    lazy_->kept_balls.emplace(std::move(balls));
    lazy_->balls.store(&*lazy_->kept_balls, std::memory_order_release);
  });
}

void require_voxels(const SphereTree& tree, std::string_view body) {
  if (tree.has_voxels()) return;
  throw_error(ErrorCode::kVoxelsMissing, "{}: the tree holds no voxels: build it with a voxel size",
              body);
}

Eigen::Vector3d middle_of(const TriangleMesh& mesh) noexcept {
  const Eigen::AlignedBox3d box = bounding_box(mesh);
  const Eigen::Vector3d &low = box.min(), &high = box.max();
  return sum(low, scaled(0.5, difference(high, low)));
}

SphereTree::SphereTree(TreeParts parts)
    : parts_(std::make_shared<const TreeParts>(measured(std::move(parts)))) {}

bool SphereTree::has_voxels() const noexcept { return parts_->voxels.has_value(); }
double SphereTree::voxel_size() const noexcept {
  return has_voxels() ? parts_->voxels->lattice.voxel_size : 0;
}
std::uint32_t SphereTree::leaf_count() const noexcept {
  return has_voxels() ? parts_->voxels->octree.leaf_count() : 0;
}
int SphereTree::depth() const noexcept { return has_voxels() ? parts_->voxels->octree.depth() : 0; }
Orientation SphereTree::orientation() const noexcept { return parts_->orientation; }
const MeshSource& SphereTree::source() const noexcept { return parts_->source; }

PatientFrame SphereTree::frame() const noexcept { return parts_->frame; }
bool SphereTree::has_proximity() const noexcept {
  return has_voxels() && parts_->voxels->proximity.has_value();
}
Eigen::Vector3d SphereTree::origin() const noexcept {
  const ScopedFloatEnvironment environment;
  return parts_->origin.rounded();
}
double SphereTree::bounding_radius() const noexcept { return parts_->bounding_radius; }
const TriangleMesh* SphereTree::triangles() const noexcept {
  return parts_->triangles ? &parts_->triangles->mesh : nullptr;
}

std::uint64_t SphereTree::self_intersections() const {
  const ScopedFloatEnvironment environment;
  if (!parts_->triangles) {
    throw Error(ErrorCode::kTrianglesMissing,
                "the tree holds no triangles: build it with its triangles");
  }
  return parts_->triangles->sides().self_intersections().pairs.size();
}

std::vector<Eigen::Vector3d> SphereTree::leaf_centres() const {
  const ScopedFloatEnvironment environment;
  std::vector<Eigen::Vector3d> centres;
  if (!has_voxels()) return centres;
  const TreeVoxels& voxels = *parts_->voxels;
  centres.reserve(leaf_count());
  for (const std::uint64_t code : voxels.octree.codes(0)) {
    centres.push_back(origin() + voxel_size() * cube_centre(voxels.lattice, 0, code));
  }
  return centres;
}

SpherePolicy SphereTree::tightest() const noexcept {
  if (!has_voxels()) return SpherePolicy::kSimple;
  const BoundBlocks& bounds = parts_->voxels->bounds;
  if (!bounds.slabs.empty()) return SpherePolicy::kSlab;
  return bounds.balls.empty() ? SpherePolicy::kTable : SpherePolicy::kTight;
}

void SphereTree::require(SpherePolicy policy, std::string_view body) const {
  if (has(policy)) return;
  if (!has_voxels()) {
    throw_error(
        ErrorCode::kPolicyMissing,
        "{}: the tree holds no voxels, and so no {} spheres: build it with a voxel size, or "
        "name no spheres",
        body, to_string(policy));
  }
  throw_error(ErrorCode::kPolicyMissing,
              "{}: the tree holds no {} spheres: build it with spheres {}, or ask for "
              "simple or table",
              body, to_string(policy), to_string(policy));
}

double SphereTree::largest_leaf_radius(SpherePolicy policy) const noexcept {
  const ScopedFloatEnvironment environment;
  if (is_implicit(policy)) return 0.5 * voxel_size() * kSqrt3;
  return has_voxels() ? parts_->voxels->largest_saved_leaf : 0;
}

std::uint64_t SphereTree::bytes() const noexcept {
  const auto size = [](const auto& vector) { return vector.capacity() * sizeof(*vector.data()); };
  std::uint64_t bytes = sizeof(*this) + sizeof(*parts_) + parts_->source.name.capacity();
  if (parts_->voxels) {
    const TreeVoxels& voxels = *parts_->voxels;
    bytes += voxels.octree.bytes() + size(voxels.normals) + size(voxels.lists.first) +
             size(voxels.lists.ids);
    for (const auto& level : voxels.bounds.balls) bytes += size(level);
    for (const auto& level : voxels.bounds.slabs) bytes += size(level);
    if (voxels.proximity) bytes += voxels.proximity->octree.bytes();
  }
  if (parts_->triangles) {
    bytes += size(parts_->triangles->mesh.vertices) + size(parts_->triangles->mesh.triangles) +
             parts_->triangles->clusters.bytes();
    const OuterBalls* balls = parts_->triangles->outer_balls();
    if (balls != nullptr) bytes += balls->bytes();
  }
  return bytes;
}

}  // namespace ist
