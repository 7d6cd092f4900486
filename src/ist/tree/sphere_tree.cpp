#include "ist/tree/sphere_tree.h"

#include <algorithm>
#include <cmath>

#include "ist/base/assert.h"
#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/throw_error.h"
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

TreeParts measured(TreeParts parts) {
  IST_ASSERT(parts.octree.depth() == parts.lattice.depth);
  IST_ASSERT(parts.normals.size() == parts.octree.leaf_count());
  IST_ASSERT(fit(parts.bounds.balls, parts.octree) && fit(parts.bounds.slabs, parts.octree));
  IST_ASSERT(parts.bounds.slabs.empty() || !parts.bounds.balls.empty());
  IST_ASSERT(source_flaw(parts.source) == nullptr);
  IST_ASSERT(!parts.triangles || parts.triangles->lists.size() == parts.octree.leaf_count());
  parts.bounding_radius = implicit_bounding_radius(parts.lattice);
  if (parts.bounds.balls.empty()) return parts;
  for (int level = 0; level <= parts.octree.depth(); ++level) {
    double largest = 0, farthest2 = 0;
    for (std::uint32_t parent = 0; parent < parts.balls(level).size(); ++parent) {
      for (int slot = 0; slot < parts.octree.child_count(level + 1, parent); ++slot) {
        const Ball ball = parts.saved_ball(level, parent, slot);
        largest = std::max(largest, ball.radius);
        farthest2 = std::max(farthest2, square_in_order(ball.centre));
      }
    }
    if (level == 0) parts.largest_saved_leaf = largest;
    // The largest radius plus the farthest centre of a level: a cheap upper bound.
    parts.bounding_radius =
        std::max(parts.bounding_radius, (std::sqrt(farthest2) + largest) * (1 + 0x1p-50));
  }
  return parts;
}

}  // namespace

const LeafTriangles::Lazy& LeafTriangles::made() const {
  std::call_once(lazy_->once, [this] {
    lazy_->sides.emplace(mesh, clusters);
    for (const Component& component : components_of(mesh)) {
      lazy_->component_points.push_back(mesh.vertices[mesh.triangles[component.triangles[0]][0]]);
    }
  });
  return *lazy_;
}

SphereTree::SphereTree(TreeParts parts)
    : parts_(std::make_shared<const TreeParts>(measured(std::move(parts)))) {}

double SphereTree::voxel_size() const noexcept { return parts_->lattice.voxel_size; }
std::uint32_t SphereTree::leaf_count() const noexcept { return parts_->octree.leaf_count(); }
int SphereTree::depth() const noexcept { return parts_->octree.depth(); }
Orientation SphereTree::orientation() const noexcept { return parts_->orientation; }
const MeshSource& SphereTree::source() const noexcept { return parts_->source; }

PatientFrame SphereTree::frame() const noexcept { return parts_->frame; }
bool SphereTree::has_proximity() const noexcept { return parts_->proximity.has_value(); }
Eigen::Vector3d SphereTree::origin() const noexcept {
  const ScopedFloatEnvironment environment;
  return parts_->lattice.origin();
}
double SphereTree::bounding_radius() const noexcept { return parts_->bounding_radius; }
const TriangleMesh* SphereTree::triangles() const noexcept {
  return parts_->triangles ? &parts_->triangles->mesh : nullptr;
}

std::uint64_t SphereTree::self_intersections() const {
  const ScopedFloatEnvironment environment;
  if (!parts_->triangles) {
    throw Error(ErrorCode::kTrianglesMissing,
                "the tree holds no triangles: build it with keep_triangles");
  }
  return parts_->triangles->sides().self_intersections().pairs.size();
}

std::vector<Eigen::Vector3d> SphereTree::leaf_centres() const {
  const ScopedFloatEnvironment environment;
  std::vector<Eigen::Vector3d> centres;
  centres.reserve(leaf_count());
  for (const std::uint64_t code : parts_->octree.codes(0)) {
    centres.push_back(origin() + voxel_size() * cube_centre(parts_->lattice, 0, code));
  }
  return centres;
}

SpherePolicy SphereTree::tightest() const noexcept {
  if (!parts_->bounds.slabs.empty()) return SpherePolicy::kSlab;
  return parts_->bounds.balls.empty() ? SpherePolicy::kTable : SpherePolicy::kTight;
}

void SphereTree::require(SpherePolicy policy, std::string_view body) const {
  if (has(policy)) return;
  throw_error(ErrorCode::kPolicyMissing,
              "{}: the tree holds no {} spheres: build it with --spheres {}, or ask for "
              "simple or table",
              body, to_string(policy), to_string(policy));
}

double SphereTree::largest_leaf_radius(SpherePolicy policy) const noexcept {
  const ScopedFloatEnvironment environment;
  return is_implicit(policy) ? 0.5 * voxel_size() * kSqrt3 : parts_->largest_saved_leaf;
}

std::uint64_t SphereTree::bytes() const noexcept {
  const auto size = [](const auto& vector) { return vector.capacity() * sizeof(*vector.data()); };
  std::uint64_t bytes = sizeof(*this) + sizeof(*parts_) + parts_->source.name.capacity() +
                        parts_->octree.bytes() + size(parts_->normals);
  for (const auto& level : parts_->bounds.balls) bytes += size(level);
  for (const auto& level : parts_->bounds.slabs) bytes += size(level);
  if (parts_->triangles) {
    bytes += size(parts_->triangles->mesh.vertices) + size(parts_->triangles->mesh.triangles) +
             size(parts_->triangles->lists.first) + size(parts_->triangles->lists.ids) +
             parts_->triangles->clusters.bytes();
  }
  if (parts_->proximity) bytes += parts_->proximity->octree.bytes();
  return bytes;
}

}  // namespace ist
