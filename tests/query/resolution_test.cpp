// A result's `resolution`: how far apart the surfaces in its leaf pairs may be.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ist/query/manifold.h"
#include "ist/query/query.h"
#include "ist/tree/tree_parts.h"
#include "query/engines.h"
#include "query/query_cases.h"
#include "query/triangles/mesh_distance.h"
#include "support/effort.h"
#include "support/exact.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Piece = std::array<Eigen::Vector3d, 3>;  // a triangle, which may be a segment or a point

// The triangles of a mesh by leaf, clipped to the leaf's cube with the pad of the build: in
// rational numbers, then rounded.
std::vector<std::vector<Piece>> pieces_in_leaves(const TriangleMesh& mesh, const SphereTree& tree) {
  const auto rounded = [](const ExactPoint& p) {
    return Eigen::Vector3d(p[0].get_d(), p[1].get_d(), p[2].get_d());
  };
  const Lattice& lattice = voxels_of(tree).lattice;
  std::vector<std::vector<Piece>> leaves;
  for (const std::uint64_t code : voxels_of(tree).octree.codes(0)) {
    const ExactBox cube = grown(node_cube(lattice, 0, code), exact_pad(lattice));
    const Eigen::AlignedBox3d box(rounded(cube.low), rounded(cube.high));
    std::vector<Piece>& leaf = leaves.emplace_back();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      Eigen::AlignedBox3d box_of_triangle;
      for (const std::uint32_t v : mesh.triangles[i]) box_of_triangle.extend(mesh.vertices[v]);
      if (!box_of_triangle.intersects(box)) continue;
      std::vector<Eigen::Vector3d> corners;
      for (const ExactPoint& p : clip(exact_triangle(mesh, i), cube)) corners.push_back(rounded(p));
      if (corners.empty()) continue;
      while (corners.size() < 3) corners.push_back(corners.back());
      for (std::size_t k = 2; k < corners.size(); ++k) {
        leaf.push_back({corners[0], corners[k - 1], corners[k]});
      }
    }
    EXPECT_FALSE(leaf.empty()) << "a leaf without a surface";
  }
  return leaves;
}

class Resolution : public ::testing::TestWithParam<Engine> {
 protected:
  // Looks at all leaf pairs of two bodies at poses where they nearly touch.
  void look_at(const TriangleMesh& a, double cells_a, const TriangleMesh& b, double cells_b,
               int poses, Random& random) {
    const SphereTree fixed = tree_of(a, cells_a), moving = tree_of(b, cells_b);
    const auto of_fixed = pieces_in_leaves(a, fixed), of_moving = pieces_in_leaves(b, moving);
    EngineQuery query(fixed, moving, GetParam());
    for (int i = 0; i < poses; ++i) {
      const Eigen::Matrix3d rotation = random.rotation();
      const double gap = random.uniform(-1, 2) * std::max(fixed.voxel_size(), moving.voxel_size());
      const Eigen::Isometry3d pose = near_touch(a, b, rotation, gap, random);
      const FoundPairs found = ask(query, pose);
      ASSERT_EQ(found.result.status, QueryStatus::kDone);
      for (const LeafPair& pair : found.leaf_pairs) {
        const double apart = distance(of_fixed[pair.fixed], of_moving[pair.moving], pose);
        ASSERT_LE(apart, found.result.resolution) << pair.fixed << ", " << pair.moving;
        farthest_ = std::max(farthest_, apart / found.result.resolution);
        ++leaf_pairs_;
      }
    }
  }

  double farthest_ = 0;  // the largest distance of surfaces in a leaf pair, over the resolution
  std::size_t leaf_pairs_ = 0;

 private:
  // The least distance of two pieces, as if none met: no less than it is.
  static double distance(const std::vector<Piece>& fixed, const std::vector<Piece>& moving,
                         const Eigen::Isometry3d& pose) {
    double least = HUGE_VAL;
    for (const Piece& m : moving) {
      const plain::Corners at({pose * m[0], pose * m[1], pose * m[2]});
      for (const Piece& f : fixed) least = std::min(least, plain::distance(plain::Corners(f), at));
    }
    return least;
  }
};

INSTANTIATE_TEST_SUITE_P(Engines, Resolution, ::testing::ValuesIn(engines_of({""})), engine_name);

TEST_P(Resolution, IsNoLessThanTheDistanceOfTheSurfacesInALeafPair) {
  for (std::uint64_t seed = 0; seed < samples(std::uint64_t{40}); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(7000 + seed);
    const TriangleMesh a = random_mesh(random), b = random_mesh(random);
    look_at(a, random.uniform(1, 8), b, random.uniform(1, 8), 6, random);
  }
  EXPECT_GT(leaf_pairs_, least(2000u, 100u));
  // The bound is not idle: around cubes, surfaces come to more than the largest radii.
  const SpherePolicy policy = GetParam().policy;
  const double share = is_implicit(policy) ? 0.8 : policy == SpherePolicy::kTight ? 0.5 : 0.35;
  EXPECT_GT(farthest_, effort() < 1 ? 0.5 * share : share);  // few bodies may not come as near
}

// One leaf each, much larger than the surface in it, and a reach that exceeds both balls.
TEST(ResolutionOfContacts, HoldsTheReachAskedFor) {
  const TriangleMesh mesh = triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const SphereTree tree = build_tree(mesh, {.voxel_size = 100, .spheres = SpherePolicy::kSlab});
  for (const SpherePolicy policy : {SpherePolicy::kTight, SpherePolicy::kSlab}) {
    Query query(tree, tree, options_of(policy));
    ContactManifold manifold(tree, tree, policy, {.reach = 0.5});
    QueryResult result;
    const double last = last_touching(0, 1000, [&](double z) {
      const QueryResult here = query.contacts(shift({0, 0, z}), manifold);
      if (here.leaf_pairs > 0) result = here;
      return here.leaf_pairs > 0;
    });
    EXPECT_GE(last, 50);  // also the distance of the surfaces
    EXPECT_LE(last, result.resolution);
  }
}

}  // namespace
}  // namespace ist::test
