#include "ist/tree/sphere_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "ist/base/assert.h"
#include "ist/base/error.h"

namespace ist {
namespace {

// In half edges of the root, rounded up. A ball of the table reaches at most (√12 + √96)/6 half
// edges from its node's centre, for three children of which no two share a face; a node's own
// centre is at most √3 half edges of the root from the root's, less √3 of its own. So the root's
// ball reaches farthest.
constexpr double kImplicitReach = 2.21034343104508;

}  // namespace

SphereTree::SphereTree(Parts parts) : parts_(std::move(parts)) {
  IST_ASSERT(parts_.octree.depth() == parts_.lattice.depth);
  IST_ASSERT(parts_.normals.size() == parts_.octree.leaf_count());
  IST_ASSERT(parts_.tight.empty() ||
             parts_.tight.size() == static_cast<std::size_t>(parts_.lattice.depth) + 1);
  IST_ASSERT(!parts_.triangles || parts_.triangles->lists.size() == parts_.octree.leaf_count());
  reach_ = kImplicitReach * 0.5 * parts_.lattice.edge(parts_.lattice.depth);
  for (std::size_t level = 0; level < parts_.tight.size(); ++level) {
    double largest = 0, farthest2 = 0;
    for (const Sphere& s : parts_.tight[level]) {
      const double x = s.x, y = s.y, z = s.z;
      largest = std::max(largest, double{s.r});
      farthest2 = std::max(farthest2, (x * x + y * y) + z * z);
    }
    if (level == 0) largest_tight_leaf_ = largest;
    // Largest radius and farthest centre of a level: no less than the true reach, and cheap.
    reach_ = std::max(reach_, (std::sqrt(farthest2) + largest) * (1 + 0x1p-50));
  }
}

void SphereTree::require(SpherePolicy policy, std::string_view body) const {
  if (has(policy)) return;
  throw Error(
      ErrorCode::kPolicyMissing,
      fmt::format("{}: the tree holds no {} spheres: build it with --spheres {}, or ask for "
                  "simple or table",
                  body, to_string(policy), to_string(policy)));
}

double SphereTree::largest_leaf_radius(SpherePolicy policy) const noexcept {
  return policy == SpherePolicy::kTight ? largest_tight_leaf_
                                        : 0.5 * parts_.lattice.voxel_size * kSqrt3;
}

std::uint64_t SphereTree::bytes() const noexcept {
  const auto size = [](const auto& vector) { return vector.capacity() * sizeof(*vector.data()); };
  std::uint64_t bytes = sizeof(*this) + parts_.octree.bytes() + size(parts_.normals);
  for (const auto& level : parts_.tight) bytes += size(level);
  if (parts_.triangles) {
    bytes += size(parts_.triangles->mesh.vertices) + size(parts_.triangles->mesh.triangles) +
             size(parts_.triangles->lists.first) + size(parts_.triangles->lists.ids);
  }
  if (parts_.proximity) bytes += parts_.proximity->octree.bytes();
  return bytes;
}

}  // namespace ist
