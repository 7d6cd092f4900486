// What touches the body of proximity voxels, against each of their cells.

#include "ist/tree/proximity_body.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ist/query/query.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "ist/voxel/morton.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 1, kSize = 0.2, kProbe = 0.0625;

SphereTree ball_with_proximity() {
  BuildOptions options;
  options.voxel_size = kSize;
  options.spheres = SpherePolicy::kTable;
  options.proximity = true;
  return build_tree(moved(icosphere(3, kRadius), {5, -3, 2}), options);
}

// The centre of each proximity cell, from where the lattice says that cells are.
std::vector<Vector3d> cells_of(const SphereTree& tree) {
  std::vector<Vector3d> centres;
  for (const std::uint64_t code : voxels_of(tree).proximity->octree.codes(0)) {
    const auto cell = morton_decode(code);
    Vector3d centre;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      centre[static_cast<Eigen::Index>(axis)] =
          voxels_of(tree).lattice.corner[axis] +
          (cell[axis] - double{ProximityTree::kMargin} + 0.5) * kSize;
    }
    centres.push_back(centre);
  }
  return centres;
}

TEST(ProximityBody, LiesOutsideNearTheSurface) {
  const SphereTree tree = ball_with_proximity();
  const std::vector<Vector3d> cells = cells_of(tree);
  ASSERT_GT(cells.size(), 500u);
  for (const Vector3d& centre : cells) {
    // The facets lie a little inside the ball.
    const double height = (centre - Vector3d(5, -3, 2)).norm() - kRadius;
    EXPECT_GT(height, -0.01);
    EXPECT_LE(height, 2 * kSize);
  }
}

// A probe of one voxel touches a cell if their cubes meet. It touches none if their balls are
// apart.
TEST(ProximityBody, IsTouchedByWhatIsInItsCells) {
  const SphereTree tree = ball_with_proximity();
  const SphereTree body = proximity_body(tree);
  const std::vector<Vector3d> cells = cells_of(tree);
  ASSERT_EQ(body.leaf_count(), cells.size());
  EXPECT_EQ(body.tightest(), SpherePolicy::kTight);
  const SphereTree probe = tree_of(box(Vector3d::Zero(), Vector3d::Constant(kProbe)), 1);
  ASSERT_EQ(probe.leaf_count(), 1u);
  const double balls = 0.5 * std::sqrt(3.0) * (kSize + kProbe);

  Random random(5);
  std::size_t touching = 0, free = 0;
  for (const SpherePolicy policy : {SpherePolicy::kSimple, SpherePolicy::kTable}) {
    QueryOptions options;
    options.policy = policy;
    Query query(body, probe, options);
    for (int i = 0; i < samples(400); ++i) {
      const Vector3d at = Vector3d(5, -3, 2) + random.point(-1.7, 1.7);
      const FoundPairs answer = ask(query, shift(at - Vector3d::Constant(0.5 * kProbe)));
      std::vector<bool> found(cells.size());
      for (const LeafPair& pair : answer.leaf_pairs) found[pair.fixed] = true;
      for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const Vector3d apart = (cells[cell] - at).cwiseAbs();
        if (apart.maxCoeff() <= 0.5 * (kSize + kProbe)) {
          EXPECT_TRUE(found[cell]) << "a cell is missed";
        } else if (apart.norm() > balls + 1e-5) {
          EXPECT_FALSE(found[cell]) << "a cell is far off";
        }
      }
      ++(answer.leaf_pairs.empty() ? free : touching);
    }
  }
  EXPECT_GT(touching, samples(std::size_t{60}));
  EXPECT_GT(free, samples(std::size_t{60}));
}

// The tight bounds of a cell are its centre.
TEST(ProximityBody, IsTouchedAtItsCentresWhereItIsBoundTightly) {
  const SphereTree tree = ball_with_proximity();
  const SphereTree body = proximity_body(tree);
  const std::vector<Vector3d> cells = cells_of(tree);
  const SphereTree probe = tree_of(box(Vector3d::Zero(), Vector3d::Constant(kProbe)), 1);
  QueryOptions options;
  options.policy = SpherePolicy::kTight;
  Query query(body, probe, options);
  const double ball = 0.5 * std::sqrt(3.0) * kProbe;
  // A tight ball is at most 1 % too large. The ball of a point is as large as packing rounds it.
  const double slop = 0.01 * ball + 3 * 0x1p-16 * 2 * (kSize + kProbe) * 4;
  Random random(6);
  std::size_t found = 0;
  for (int i = 0; i < samples(2000); ++i) {
    const Vector3d at =
        cells[static_cast<std::size_t>(i) % cells.size()] + random.point(-0.06, 0.06);
    std::vector<bool> overlapping(cells.size());
    for (const LeafPair& pair :
         ask(query, shift(at - Vector3d::Constant(0.5 * kProbe))).leaf_pairs) {
      overlapping[pair.fixed] = true;
    }
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      const double apart = (cells[cell] - at).norm();
      if (apart <= ball) {
        EXPECT_TRUE(overlapping[cell]) << "a centre is missed";
      }
      if (apart > ball + slop) {
        EXPECT_FALSE(overlapping[cell]) << "a centre is far off";
      }
      found += overlapping[cell] ? 1U : 0U;
    }
  }
  EXPECT_GT(found, samples(std::size_t{500}));
}

// As the surface's own tree is in its mesh's coordinates, so is it, whatever both depths are.
TEST(ProximityBody, KeepsTheMeshCoordinatesWhereItIsDeeper) {
  BuildOptions options;
  options.voxel_size = 0.25;
  options.spheres = SpherePolicy::kTable;
  options.proximity = true;
  // Eight cells and a margin of two on each side: a level more.
  const SphereTree tree = build_tree(box({0, 0, 0}, {2, 2, 2}), options);
  const SphereTree body = proximity_body(tree);
  EXPECT_EQ(tree.depth(), 3);
  EXPECT_EQ(body.depth(), 4);
  EXPECT_EQ(body.voxel_size(), 0.25);
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_EQ(voxels_of(body).lattice.corner[axis], -0.5);
  EXPECT_EQ(voxels_of(body).lattice.cells, voxels_of(tree).lattice.cells + 4);
}

}  // namespace
}  // namespace ist::test
