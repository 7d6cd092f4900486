#include "ist/query/exact/node_triangles.h"

#include <algorithm>
#include <vector>

#include "ist/base/assert.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

// The most nodes that a triangle lies in, on average.
constexpr std::size_t kMostNodes = 12;

constexpr std::uint32_t kNone = ~std::uint32_t{0};

TriangleCorners corners_of(const TriangleMesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

// Merges the lists of a level into those of the level above.
TriangleLists merged(const TriangleLists& below, std::span<const OctreeNode> nodes,
                     std::vector<std::uint32_t>& last_in) {
  TriangleLists lists;
  lists.first.push_back(0);
  for (std::uint32_t node = 0; node + 1 < nodes.size(); ++node) {
    for (std::uint32_t child = nodes[node].first_child; child < nodes[node + 1].first_child;
         ++child) {
      for (const std::uint32_t triangle : below[child]) {
        if (last_in[triangle] == node) continue;
        last_in[triangle] = node;
        lists.ids.push_back(triangle);
      }
    }
    lists.first.push_back(static_cast<std::uint32_t>(lists.ids.size()));
  }
  return lists;
}

}  // namespace

NodeTriangles::NodeTriangles(const SphereTree& tree) {
  IST_ASSERT(tree.triangles() != nullptr);
  const LeafTriangles& leaves = *tree.parts().triangles;
  lists_ = leaves.lists;
  const std::size_t enough = kMostNodes * leaves.mesh.triangles.size();
  while (level_ < tree.depth() && (level_ == 0 || lists_.ids.size() > enough)) {
    std::vector<std::uint32_t> last_in(leaves.mesh.triangles.size(), kNone);
    ++level_;
    lists_ = merged(lists_, tree.parts().octree.nodes(level_), last_in);
  }
  std::vector<std::uint32_t> numbers(leaves.mesh.triangles.size(), kNone);
  for (std::uint32_t& triangle : lists_.ids) {
    std::uint32_t& number = numbers[triangle];
    if (number == kNone) {
      number = count();
      indices_.push_back(triangle);
      corners_.push_back(corners_of(leaves.mesh, triangle));
    }
    triangle = number;
  }
  const Lattice& lattice = tree.parts().lattice;
  nodes_ = tree.parts().octree.nodes(
      std::max(level_, 1));  // a root that is a leaf has its parent's centre
  voxel_size_ = lattice.voxel_size;
  // origin() is rounded by up to half its last bit, and the triangles' boxes are relative to it.
  const double rounding = 0x1p-52 * lattice.origin().cwiseAbs().maxCoeff();
  half_edge_ = 0.5 * lattice.edge(level_) + 4 * lattice.pad() * lattice.voxel_size + rounding;
}

FloatBox NodeTriangles::cube(std::uint32_t node) const noexcept {
  const float(&c)[3] = nodes_[node].centre;
  const Eigen::Vector3d centre(voxel_size_ * c[0], voxel_size_ * c[1], voxel_size_ * c[2]);
  return float_box(centre.array() - half_edge_, centre.array() + half_edge_);
}

}  // namespace ist
