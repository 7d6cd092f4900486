#include "ist/measure/point_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ist/base/ordered_vector.h"
#include "ist/models/models.h"
#include "query/query_cases.h"
#include "simd/targets.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;

NearestTriangle brute_force(const TriangleMesh& mesh, const Vector& p) {
  NearestTriangle best{HUGE_VAL, 0, {}};
  for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
    const Triangle& t = mesh.triangles[k];
    const auto& v = mesh.vertices;
    const NearestPoint on = nearest_on_triangle({v[t[0]], v[t[1]], v[t[2]]}, p);
    const Vector way = difference(p, on.point);
    const double square = dot_in_order(way, way);
    if (square < best.square) best = {square, k, on};
  }
  return best;
}

SphereTree coarse_tree(const TriangleMesh& mesh) {
  Vector low = mesh.vertices[0], high = low;
  for (const Vector& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return build_tree(mesh, {.voxel_size = (high - low).maxCoeff() / 4});
}

class PointSearchOn : public ::testing::TestWithParam<std::string> {
 protected:
  // The same triangle, and the same bits, as all triangles one by one give.
  void expect_as_by_brute_force(const SphereTree& tree, const std::vector<Vector>& points) {
    const TriangleMesh& mesh = *tree.triangles();
    const PointSearch search(tree, select_kernels(GetParam()).clusters);
    std::optional<std::uint32_t> hint;
    for (const Vector& p : points) {
      const NearestTriangle truth = brute_force(mesh, p);
      for (const double within : {HUGE_VAL, std::sqrt(truth.square) * 1.001 + 1e-300}) {
        for (const auto& start : {std::optional<std::uint32_t>(), hint}) {
          const auto found = search.nearest(p, within, start);
          ASSERT_TRUE(found.has_value()) << p.transpose();
          ASSERT_EQ(found->square, truth.square) << p.transpose();
          ASSERT_EQ(found->triangle, truth.triangle) << p.transpose();
          ASSERT_EQ(found->on.point, truth.on.point);
        }
      }
      if (truth.square > 0) {
        EXPECT_FALSE(search.nearest(p, std::sqrt(truth.square) * 0.999).has_value());
      }
      hint = truth.triangle;
    }
  }
};

TEST_P(PointSearchOn, FindsAmongRandomTrianglesWhatAllOfThemGive) {
  Random random(41);
  for (int i = 0; i < samples(60); ++i) {
    const TriangleMesh mesh = random_mesh(random);
    std::vector<Vector> points;
    for (int k = 0; k < 30; ++k) {
      const Vector& at = mesh.vertices[random.below(mesh.vertices.size())];
      points.push_back(at + std::ldexp(1.0, 4 - static_cast<int>(random.below(50))) *
                                random.direction());
    }
    points.insert(points.end(), mesh.vertices.begin(), mesh.vertices.end());
    expect_as_by_brute_force(coarse_tree(mesh), points);
  }
}

TEST_P(PointSearchOn, FindsOnAJawWhatAllTrianglesGive) {
  const SphereTree tree = coarse_tree(make_jaw(Jaw::kLower, 3));
  Random random(43);
  std::vector<Vector> points;
  for (int k = 0; k < samples(25); ++k) {
    const auto& vertices = tree.triangles()->vertices;
    points.push_back(vertices[random.below(vertices.size())] +
                     random.uniform(0, 3) * random.direction());
    points.push_back(random.uniform(0, 400) * random.direction());
  }
  expect_as_by_brute_force(tree, points);
}

// In a sphere's middle all triangles are nearly as near, and many exactly.
TEST_P(PointSearchOn, TakesTheFirstOfMany) {
  const SphereTree tree = coarse_tree(icosphere(3, 2));
  expect_as_by_brute_force(tree, {{0, 0, 0}, {0, 0, 1e-9}, {1e-6, 0, 0}});
  expect_as_by_brute_force(coarse_tree(coincident(100)), {{0, 0, 0}, {3, 1, 2}});
}

TEST_P(PointSearchOn, HoldsFarFromTheOriginLargeAndSmall) {
  Random random(47);
  for (const double scale : {1e-11, 1e-3, 1e3, 1e14}) {
    for (const double shift : {0.0, 1e4}) {
      TriangleMesh mesh = icosphere(2, 1);
      for (Vector& v : mesh.vertices) v = scale * (v + Vector(shift, -shift, shift));
      std::vector<Vector> points;
      for (int k = 0; k < samples(20); ++k) {
        points.push_back(
            scale * (Vector(shift, -shift, shift) + random.uniform(0, 3) * random.direction()));
      }
      points.push_back(scale * Vector(1e9, 0, 0));
      expect_as_by_brute_force(coarse_tree(mesh), points);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, PointSearchOn, ::testing::ValuesIn(all_targets()), name_of);

}  // namespace
}  // namespace ist::test
