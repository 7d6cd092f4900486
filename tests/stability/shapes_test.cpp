#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>

#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "query/contacts/contact_cases.h"
#include "query/query_cases.h"
#include "query/scenes.h"
#include "stability/hard_pair.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/random.h"

namespace ist::test {
namespace {

// Meshes that no one would make on purpose, and that files are full of.

using Eigen::Vector3d;

struct Shape {
  const char* name;
  std::function<TriangleMesh()> mesh;
  double voxel_size;
  bool on_itself = true;  // and not only on a ball, if the oracle is fast enough

  friend void PrintTo(const Shape& shape, std::ostream* out) { *out << shape.name; }
};

// A millionth as wide as they are long.
TriangleMesh slivers() {
  Random random(1);
  TriangleMesh mesh;
  for (int i = 0; i < 12; ++i) {
    const Vector3d a = random.point(-0.7, 0.7), along = random.direction();
    const Vector3d third = a + random.uniform(0, 1) * along + 1e-6 * random.direction();
    mesh = joined(mesh, triangle(a, a + along, third));
  }
  return mesh;
}

// Four triangles with all their corners on the grid's cube, and one across it on planes of voxels.
TriangleMesh spanning() {
  TriangleMesh mesh = triangle({0, 0, 0}, {2, 2, 0.1}, {0.2, 2, 2});
  mesh = joined(mesh, triangle({0, 2, 0}, {2, 0, 0}, {1, 1, 2}));
  mesh = joined(mesh, triangle({2, 2, 2}, {0, 0.3, 2}, {2, 0, 0}));
  mesh = joined(mesh, triangle({0, 0, 2}, {2, 0, 2}, {2, 2, 0}));
  return joined(mesh, triangle({0, 0, 1}, {2, 0, 1}, {0, 2, 1}));
}

// Points, segments, three corners on a line, and two equal indices.
TriangleMesh without_area() {
  Random random(2);
  TriangleMesh mesh;
  for (int i = 0; i < 5; ++i) {
    const Vector3d a = random.point(-1, 1), b = random.point(-1, 1);
    mesh = joined(mesh, triangle(a, a, a));
    mesh = joined(mesh, triangle(a, b, b));
    mesh = joined(mesh, triangle(a, b, 0.5 * (a + b)));
    const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    mesh.triangles.push_back({last, last - 1, last});
  }
  return mesh;
}

// A ball thrice: of the same vertices, and of others in the same places.
TriangleMesh duplicated() {
  TriangleMesh ball = icosphere(0, 1);
  const std::vector<Triangle> once = ball.triangles;
  ball.triangles.insert(ball.triangles.end(), once.begin(), once.end());
  return joined(ball, icosphere(0, 1));
}

TriangleMesh self_intersecting() {
  Random random(3);
  TriangleMesh mesh = joined(box({-1, -0.3, -0.3}, {1, 0.4, 0.4}), icosphere(1, 0.8));
  for (int i = 0; i < 6; ++i) {
    const Vector3d a = random.point(-1, 1), b = random.point(-1, 1);
    mesh = joined(mesh, triangle(a, b, random.point(-1, 1)));
  }
  return mesh;
}

// A square of 2, in the plane z = `height`.
TriangleMesh sheet(double height) {
  TriangleMesh mesh;
  mesh.vertices = {{-1, -1, height}, {1, -1, height}, {1, 1, height}, {-1, 1, height}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}
// The same above a point that its grid begins at.
TriangleMesh sheet_in_a_grid(double height) {
  const Vector3d corner(-1, -1, -1);
  return joined(sheet(height), triangle(corner, corner, corner));
}

const Shape kShapes[] = {
    {"slivers", slivers, 0.4},
    {"triangles across the grid", spanning, 0.5},
    {"triangles without area", without_area, 0.4},
    {"duplicated triangles", duplicated, 0.5},
    {"opposite triangles", [] { return joined(icosphere(0, 1), inside_out(icosphere(0, 1))); },
     0.5},
    {"self-intersecting", self_intersecting, 0.5},
    {"a triangle",
     [] {
       return triangle({-1, -0.9, 0.1}, {1, 0.2, 0}, {-0.3, 1, 0.7});
     },
     0.3},
    {"a sheet on a lattice plane", [] { return sheet(0); }, 0.25},
    {"a sheet on a plane inside its grid", [] { return sheet_in_a_grid(0); }, 0.25},
    {"a sheet off the planes", [] { return sheet_in_a_grid(0.1); }, 0.25},
    {"a speck in a large voxel",
     [] {
       return triangle({1, 1, 1}, {1.001, 1, 1.0003}, {1.0002, 1.0007, 1});
     },
     0.9},
    {"a speck far from the origin",
     [] {
       return moved(icosphere(0, 1e-7), {1e6, -1e6, 1e6});
     },
     6e-8},
    {"coincident triangles", [] { return coincident(16); }, 0.5},
    {"genus 17", [] { return plate_with_holes(17); }, 1.7, false},
    {"genus 101", [] { return plate_with_holes(101); }, 4.3, false},
};

class Shapes : public ::testing::TestWithParam<Shape> {};

INSTANTIATE_TEST_SUITE_P(Hard, Shapes, ::testing::ValuesIn(kShapes), [](const auto& shape) {
  std::string name = shape.param.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
  return name;
});

// A vertex of one on a vertex of the other, moved by `by`.
Eigen::Isometry3d vertices_together(const SphereTree& fixed, const SphereTree& moving,
                                    const Eigen::Matrix3d& rotation, const Vector3d& by,
                                    Random& random) {
  const auto& a = parts_of(fixed).triangles->mesh.vertices;
  const auto& b = parts_of(moving).triangles->mesh.vertices;
  const Vector3d on_a = a[random.below(a.size())], on_b = b[random.below(b.size())];
  return pose_of(rotation, (on_a - rotation * on_b) + by);
}

// As it is on itself; touching in a vertex to the last bit of a double, near, and apart.
TEST_P(Shapes, KeepEveryGuarantee) {
  const Shape& shape = GetParam();
  ShapeCases cases(shape.name);
  Random random(17);
  const TriangleMesh mesh = shape.mesh();
  const double voxel = shape.voxel_size;
  int touching = 0, apart = 0;
  const auto try_with = [&](const TriangleMesh& other, double other_voxel) {
    HardPair pair(mesh, voxel, other, other_voxel);
    if (touching + apart == 0) check_voxels(pair.fixed(), cases.voxels);
    const auto at = [&](const Eigen::Isometry3d& pose) {
      (pair.check(pose, cases) ? touching : apart) += 1;
    };
    const auto together = [&](const Eigen::Matrix3d& rotation, double by) {
      at(vertices_together(pair.fixed(), pair.moving(), rotation, by * voxel * random.direction(),
                           random));
    };
    at(Eigen::Isometry3d::Identity());
    for (int i = 0; i < samples(1); ++i) {
      together(quarter_turns()[random.below(24)], 0);
      together(random.rotation(), random.uniform(0, 0.5));
      together(random.rotation(), 1000);
    }
  };
  if (shape.on_itself) try_with(mesh, voxel);
  EXPECT_GE(touching, shape.on_itself ? 1 : 0);
  try_with(icosphere(0, 1.3 * voxel), 0.8 * voxel);
  EXPECT_GE(touching, 1);
  EXPECT_GE(apart, 1);
}

// Shapes at the ends of what there may be: no extent, a million times the same, a side that is the
// wrong one.

using Eigen::Isometry3d;

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
  answers.sample(voxels_of(tree).octree.codes(0) == voxels_of(once).octree.codes(0) ? 0 : 1, 0,
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

// The shapes have the properties of their names.
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
