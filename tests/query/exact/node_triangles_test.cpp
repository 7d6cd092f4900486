#include "ist/query/exact/node_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "ist/tree/tree_parts.h"
#include "query/exact/exact_tree.h"
#include "query/exact/float_box.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// Every triangle once, under its own corners; each of its points in the cube of a node that has it.
void expect_whole(const SphereTree& tree) {
  const NodeTriangles nodes(tree);
  const TriangleMesh& mesh = tree.parts().triangles->mesh;
  const std::uint32_t node_count = tree.parts().octree.node_count(nodes.level());
  std::set<std::uint32_t> indices;
  std::vector<std::vector<std::uint32_t>> nodes_of(nodes.count());
  for (std::uint32_t node = 0; node < node_count; ++node) {
    std::set<std::uint32_t> here(nodes[node].begin(), nodes[node].end());
    EXPECT_EQ(here.size(), nodes[node].size());
    for (const std::uint32_t triangle : here) nodes_of[triangle].push_back(node);
  }
  Random random(1);
  for (std::uint32_t i = 0; i < nodes.count(); ++i) {
    indices.insert(nodes.index(i));
    const TriangleCorners& corners = nodes.corners(i);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(corners[k], mesh.vertices[mesh.triangles[nodes.index(i)][k]]);
    }
    for (int sample = 0; sample < 10; ++sample) {
      double u = random.uniform(0, 1), v = random.uniform(0, 1);
      if (sample < 3) u = sample == 1 ? 1 : 0, v = sample == 2 ? 1 : 0;
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Eigen::Vector3d p =
          corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
      EXPECT_TRUE(std::any_of(nodes_of[i].begin(), nodes_of[i].end(), [&](std::uint32_t node) {
        return holds(nodes.cube(node), p - tree.origin());
      }));
    }
  }
  EXPECT_EQ(indices.size(), mesh.triangles.size());
}

TEST(NodeTriangles, AreAllThereAre) {
  for (const double cells : {1.0, 2.0, 7.0, 40.0}) {
    expect_whole(exact_tree(icosphere(2, 1), cells));
    expect_whole(exact_tree(box({0, 0, 0}, {4, 2, 1}), cells));  // faces on the lattice
  }
  expect_whole(exact_tree(moved(icosphere(1, 1), {1e6, -3e5, 7}), 9));
}

// Where triangles are much larger than leaves the nodes are too.
TEST(NodeTriangles, AreInNodesOfTheirSize) {
  EXPECT_EQ(NodeTriangles(exact_tree(icosphere(4, 1), 10)).level(), 1);
  const SphereTree fine = exact_tree(icosphere(1, 1), 100);
  const NodeTriangles nodes(fine);
  EXPECT_GT(nodes.level(), 2);
  EXPECT_LT(nodes.level(), fine.depth());
  EXPECT_EQ(NodeTriangles(exact_tree(icosphere(1, 1), 1)).level(), 0);
}

}  // namespace
}  // namespace ist::test
