// Shapes at the ends of what there may be: no extent, a million times the same, a side that is the
// wrong one.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "query/contacts/contact_cases.h"
#include "query/scenes.h"
#include "stability/hard_pair.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

SphereTree triangle_tree_of(const TriangleMesh& mesh, double voxel_size,
                            BuildReport* report = nullptr,
                            std::uint64_t max_memory = BuildOptions().max_memory) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.keep_triangles = true;
  options.max_memory = max_memory;
  return build_tree(mesh, options, report);
}

TEST(ShapeLimits, AMeshWithoutExtentIsRefused) {
  StabilityCase answers("shapes", "a point", "wrong answers");
  const auto expect = [&](const Vector3d& at, double extent, double voxel_size,
                          const std::string& error) {
    const TriangleMesh mesh =
        triangle(at, at + Vector3d(extent, 0, 0), at + Vector3d(0, 0.5 * extent, 0));
    const std::string found =
        error_name([&] { static_cast<void>(triangle_tree_of(mesh, voxel_size)); });
    answers.sample(found == error ? 0 : 1, 0, found + " where " + error + " was expected");
  };
  const Vector3d origin(0, 0, 0), away(3, 4, 5);
  for (const double voxel_size : {1e-12, 1.0}) {
    expect(origin, 0, voxel_size, "mesh-extent");
    expect(away, 0, voxel_size, "mesh-extent");
    expect(1e6 * away, 1e-12, voxel_size, "mesh-extent");  // as much as there is between doubles
  }
  expect(origin, 0.999e-12, 1e-12, "mesh-extent");
  expect(origin, 1.001e-12, 1e-12, "none");
  expect(origin, 1.001e-12, 1e-9, "none");  // a thousand times as large: one voxel
  expect(origin, 1.001e-12, 1.1e-9, "voxel-size-invalid");
  expect(origin, 0.999e15, 1e13, "none");
  expect(origin, 1.001e15, 1e13, "mesh-extent");
}

// As small as a body may be, in one voxel and in some, everything holds.
TEST(ShapeLimits, TheSmallestBodiesKeepEveryGuarantee) {
  ShapeCases cases("the smallest extent");
  const TriangleMesh ball = icosphere(0, 0.6e-12);
  for (const double voxel_size : {0.4e-12, 1e-9}) {
    HardPair pair(ball, voxel_size, ball, voxel_size);
    check_voxels(pair.fixed(), cases.voxels);
    EXPECT_TRUE(pair.check(Isometry3d::Identity(), cases));
    EXPECT_TRUE(pair.check(shift({0.3e-12, 0.2e-12, 0.7e-12}), cases));
    EXPECT_FALSE(pair.check(shift({0, 0, 2e-12}), cases));
  }
}

// From ten thousand to a million triangles, by the effort. The other body is one triangle: two such
// bodies would have more pairs than can be counted.
TEST(ShapeLimits, HoldWithManyTrianglesInOnePlace) {
  const auto count = std::clamp<std::size_t>(samples(std::size_t{50'000}), 10'000, 1'000'000);
  StabilityCase memory("shapes", "coincident triangles: tree", "bytes"),
      answers("shapes", "coincident triangles by the million", "wrong answers");
  constexpr std::uint64_t kMost = std::uint64_t{1} << 30;
  const TriangleMesh mesh = coincident(count);
  const SphereTree tree = triangle_tree_of(mesh, 1.9, nullptr, kMost);
  memory.sample(static_cast<double>(tree.bytes()), static_cast<double>(kMost));
  EXPECT_EQ(error_name([&] { static_cast<void>(triangle_tree_of(mesh, 1e-4, nullptr, 1 << 22)); }),
            "memory-limit");
  const SphereTree once = triangle_tree_of(coincident(1), 1.9);
  answers.sample(parts_of(tree).octree.codes(0) == parts_of(once).octree.codes(0) ? 0 : 1, 0,
                 "voxels");

  const SphereTree other =
      triangle_tree_of(triangle({0, 0, -0.5}, {0.3, 0.1, 0.9}, {-0.2, 0.2, 0.7}), 0.5);
  std::vector<TrianglePair> first(1000);
  for (const SpherePolicy policy : kSpherePolicies) {
    QueryOptions options;
    options.policy = policy;
    Query query(tree, other, options), plain(once, other, options);
    for (const double z : {0.0, 0.8, 2.0}) {
      const Isometry3d pose = shift({0.1, 0, z});
      answers.sample(ask(query, pose).leaf_pairs == ask(plain, pose).leaf_pairs ? 0 : 1, 0,
                     "leaves");
      const DistanceInterval gap = query.distance(pose, 0).distance,
                             expected = plain.distance(pose, 0).distance;
      answers.sample(gap.lower == expected.lower && gap.upper == expected.upper ? 0 : 1, 0, "gap");
      const bool meet = plain.intersects(pose).answer == ist::Answer::kYes;
      EXPECT_EQ(meet, z == 0.0);
      answers.sample((query.intersects(pose).answer == ist::Answer::kYes) == meet ? 0 : 1, 0,
                     "meet");

      const TrianglePairsResult found = query.triangle_pairs(pose, first);
      bool right = found.triangle_pairs == (meet ? count : 0) && found.truncated == meet;
      for (std::uint32_t i = 0; i < first.size() && meet; ++i) {
        right = right && first[i] == TrianglePair{i, 0};
      }
      answers.sample(right ? 0 : 1, 0, "triangle pairs");
    }
  }
  Query itself(tree, tree);
  answers.sample(itself.intersects(Isometry3d::Identity()).answer == ist::Answer::kYes ? 0 : 1, 0,
                 "on itself");
  answers.sample(itself.distance(Isometry3d::Identity(), 0).distance.upper == 0 ? 0 : 1, 0,
                 "on itself");
}

// Turned outward, and so the same body to the last bit.
TEST(ShapeLimits, InsideOutIsOutsideOut) {
  StabilityCase answers("shapes", "inside-out bodies", "answers that are not the same bits");
  const TriangleMesh meshes[] = {icosphere(2, 1), box({-1, -0.8, -0.9}, {1, 0.7, 0.6}),
                                 moved(plate_with_holes(17), {-4, -3, -1}),
                                 joined(icosphere(1, 0.6), moved(icosphere(1, 0.5), {1, 1, 0}))};
  const SphereTree ball = triangle_tree_of(icosphere(2, 0.7), 0.2);
  Random random(5);
  std::size_t pressed = 0;
  for (const TriangleMesh& mesh : meshes) {
    BuildReport report;
    const SphereTree right = triangle_tree_of(mesh, 0.21),
                     turned = triangle_tree_of(inside_out(mesh), 0.21, &report);
    EXPECT_EQ(report.turned_components, check_mesh(mesh).components);
    for (const SpherePolicy policy : kSpherePolicies) {
      Query a(right, ball, options_of(policy)), b(turned, ball, options_of(policy)),
          c(ball, right, options_of(policy)), d(ball, turned, options_of(policy));
      ContactManifold of_a(right, ball, policy), of_b(turned, ball, policy),
          of_c(ball, right, policy), of_d(ball, turned, policy);
      for (int i = 0; i < samples(3); ++i) {
        const Vector3d on = mesh.vertices[random.below(mesh.vertices.size())];
        const Isometry3d pose =
            pose_of(random.rotation(), on + random.uniform(0.4, 0.9) * random.direction());
        const FoundContacts points = find_contacts(a, of_a, pose);
        pressed += points.sums.weight > 0 ? 1U : 0U;
        answers.sample(same(ask(a, pose), ask(b, pose)) ? 0 : 1, 0, "leaf pairs");
        answers.sample(same(points, find_contacts(b, of_b, pose)) ? 0 : 1, 0, "contact points");
        const Isometry3d back = pose.inverse();
        answers.sample(same(find_contacts(c, of_c, back), find_contacts(d, of_d, back)) ? 0 : 1, 0,
                       "contact points of the moving body");
        const DistanceInterval gap = a.distance(pose, 0).distance,
                               other = b.distance(pose, 0).distance;
        answers.sample(gap.lower == other.lower && gap.upper == other.upper ? 0 : 1, 0, "gap");
      }
    }
  }
  EXPECT_GT(pressed, samples(10u));
}

// What the shapes called so are.
TEST(ShapeLimits, PlatesHaveTheirGenus) {
  for (const int holes : {1, 17, 101}) {
    const MeshReport report = check_mesh(plate_with_holes(holes));
    EXPECT_TRUE(report.closed && report.consistent);
    EXPECT_EQ(report.components, 1u);
    EXPECT_GT(report.signed_volume, 0);
    const auto euler =
        static_cast<int>(report.vertices + report.triangles) - static_cast<int>(report.edges);
    EXPECT_EQ(euler, 2 - 2 * holes);
  }
}

}  // namespace
}  // namespace ist::test
