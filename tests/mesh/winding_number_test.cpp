#include "ist/mesh/winding_number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "query/query_cases.h"
#include "support/effort.h"
#include "support/shapes.h"
#include "support/solid_angle.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;

struct Rays {
  explicit Rays(TriangleMesh of)
      : mesh(std::move(of)), clusters(mesh, mesh.vertices[mesh.triangles[0][0]]) {}
  [[nodiscard]] std::optional<int> at(const Vector& p) const {
    return WindingNumber(mesh, clusters).at(p);
  }
  TriangleMesh mesh;
  TriangleClusters clusters;
};

std::vector<TriangleMesh> closed_meshes() {
  return {icosphere(3, 4),
          box({0, 0, 0}, {4, 4, 4}),
          torus(5, 2, 24, 12),
          plate_with_holes(3),
          joined(icosphere(2, 4), inside_out(icosphere(2, 2))),
          joined(icosphere(2, 4), icosphere(2, 2)),
          joined(box({0, 0, 0}, {4, 4, 4}), box({2, 2, 2}, {6, 6, 6})),
          joined(box({0, 0, 0}, {2, 2, 2}), box({2, 0, 0}, {4, 2, 2})),
          inside_out(pipe(6, 2, 3, 8))};
}

TEST(WindingNumber, EqualsTheSumOfSolidAngles) {
  Random random(1);
  for (const TriangleMesh& mesh : closed_meshes()) {
    const Rays rays(mesh);
    for (int k = 0; k < samples(400); ++k) {
      const Vector p(random.uniform(-7, 7), random.uniform(-7, 7), random.uniform(-7, 7));
      EXPECT_EQ(rays.at(p), std::lround(winding_by_angles(mesh, p))) << p.transpose();
    }
  }
}

// The ray then passes through vertices and along edges and faces.
TEST(WindingNumber, IsExactIfThePointIsLevelWithVertices) {
  Random random(2);
  int measured = 0;
  for (const TriangleMesh& mesh : closed_meshes()) {
    const Rays rays(mesh);
    const auto level = [&](Eigen::Index axis) {
      const auto& v = mesh.vertices;
      return v[random.below(v.size())][axis];
    };
    for (int k = 0; k < samples(400); ++k) {
      const Vector p(random.uniform(-7, 7), level(1), level(2));
      const std::optional<int> winding = rays.at(p);
      const double expected = winding_by_angles(mesh, p);
      if (!winding) continue;
      if (std::abs(expected - std::round(expected)) > 1e-6) continue;  // very near the surface
      EXPECT_EQ(*winding, std::lround(expected)) << p.transpose();
      ++measured;
    }
  }
  EXPECT_GT(measured, samples(9 * 400) * 3 / 4);
}

TEST(WindingNumber, IsNoNumberOnTheSurface) {
  for (const TriangleMesh& mesh : closed_meshes()) {
    const Rays rays(mesh);
    for (std::size_t k = 0; k < mesh.vertices.size(); k += 7) {
      EXPECT_EQ(rays.at(mesh.vertices[k]), std::nullopt);
    }
  }
  const Rays cube(box({0, 0, 0}, {4, 4, 4}));
  for (const Vector& p : {Vector(2, 2, 0), Vector(0, 2, 2), Vector(1, 3, 4), Vector(4, 4, 1)}) {
    EXPECT_EQ(cube.at(p), std::nullopt) << p.transpose();
  }
  EXPECT_EQ(cube.at({2, 2, std::nextafter(0, 1)}), 1);
  EXPECT_EQ(cube.at({2, 2, std::nextafter(0, -1)}), 0);
  EXPECT_EQ(cube.at({std::nextafter(4, 3), 2, 2}), 1);
  EXPECT_EQ(cube.at({std::nextafter(4, 5), 2, 2}), 0);
}

TEST(WindingNumber, HoldsAtAnyScaleAndPlace) {
  Random random(3);
  for (const double scale : {1e-12, 1e-9, 1.0, 1e15}) {
    for (const double place : {0.0, 1e6}) {
      TriangleMesh mesh = moved(torus(5, 2, 24, 12), {place, -place, place});
      for (Vector& v : mesh.vertices) v *= scale;
      const Rays rays(mesh);
      for (int k = 0; k < samples(200); ++k) {
        const Vector p(random.uniform(-7, 7), random.uniform(-7, 7), random.uniform(-2, 2));
        const double ring = std::hypot(p[0], p[1]) - 5, tube = std::hypot(ring, p[2]);
        if (std::abs(tube - 2) < 0.1) continue;
        EXPECT_EQ(rays.at(scale * (p + Vector(place, -place, place))), tube < 2 ? 1 : 0);
      }
    }
  }
}

}  // namespace
}  // namespace ist::test
