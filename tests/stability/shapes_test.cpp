// Meshes that no one would make on purpose, and that files are full of.

#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <ostream>

#include "ist/tree/tree_parts.h"
#include "query/query_cases.h"
#include "stability/hard_pair.h"
#include "support/effort.h"
#include "support/random.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

struct Shape {
  const char* name;
  std::function<TriangleMesh()> mesh;
  double voxel_size;
  bool on_itself = true;  // and not only on a ball: where the oracle affords it

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

}  // namespace
}  // namespace ist::test
