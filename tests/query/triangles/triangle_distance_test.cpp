#include "ist/query/triangles/triangle_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "query/query_cases.h"
#include "query/triangles/mesh_distance.h"
#include "support/effort.h"
#include "support/exact_polygon.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr double kPlainDistanceError = 0x1p-40;

// Between the inner points of two edges, where the common perpendicular meets both; else nothing.
void nearest_of_edges(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c,
                      const ExactPoint& d, mpq_class& least) {
  const ExactPoint u = b - a, v = d - c, w = c - a, n = cross(u, v);
  const mpq_class nn = square(n);
  if (nn == 0) return;
  const mpq_class s = dot(cross(w, v), n) / nn, t = dot(cross(w, u), n) / nn;
  if (s < 0 || s > 1 || t < 0 || t > 1) return;
  const mpq_class height = dot(w, n);
  least = std::min<mpq_class>(least, height * height / nn);
}

double exact_distance(const TriangleCorners& a, const TriangleCorners& b) {
  const ExactPolygon p = exact_triangle(a), q = exact_triangle(b);
  mpq_class least = distance_squared(p[0], q);
  for (std::size_t i = 0; i < 3; ++i) {
    least = std::min(least, distance_squared(p[i], q));
    least = std::min(least, distance_squared(q[i], p));
    for (std::size_t j = 0; j < 3; ++j) {
      nearest_of_edges(p[i], p[(i + 1) % 3], q[j], q[(j + 1) % 3], least);
    }
  }
  return std::sqrt(least.get_d());
}

template <class Number>
int expect_near(int times, const Number& number) {
  int apart = 0, farther = 0;
  for (int i = 0; i < times && !::testing::Test::HasFailure(); ++i) {
    TriangleCorners a, b;
    double longest = 0;
    for (TriangleCorners* t : {&a, &b}) {
      for (Eigen::Vector3d& x : *t) x = {number(), number(), number()};
      for (std::size_t k = 0; k < 3; ++k) {
        longest = std::max(longest, ((*t)[k] - (*t)[(k + 1) % 3]).norm());
      }
    }
    if (polygons_meet(exact_triangle(a), exact_triangle(b))) continue;
    ++apart;
    const double wanted = exact_distance(a, b), made = std::sqrt(ist::distance_squared(a, b));
    EXPECT_NEAR(made, wanted, kTriangleDistanceError * std::max(longest, wanted));
    EXPECT_EQ(made, std::sqrt(ist::distance_squared(b, a)));
    // The distance that all other tests compare with: it must be right if this one is not.
    EXPECT_NEAR(mesh_distance(triangle(a[0], a[1], a[2]), triangle(b[0], b[1], b[2]),
                              Eigen::Isometry3d::Identity()),
                wanted, kPlainDistanceError * std::max(longest, wanted));
    EXPECT_LE(std::sqrt(box_distance_squared(a, b)), wanted * (1 + 1e-15));
    EXPECT_FALSE(surely_farther(a, b, wanted * (1 + 1e-15)));
    farther += surely_farther(a, b, 0.9 * wanted) ? 1 : 0;
  }
  EXPECT_GT(farther, apart / 16);
  return apart;
}

TEST(TriangleDistance, OfAnyTriangles) {
  Random random(1);
  EXPECT_GT(expect_near(samples(3'000), [&] { return random.uniform(-1, 1); }), samples(1'500));
}

// Parallel edges and planes, and triangles without area.
TEST(TriangleDistance, OfTrianglesOnAGrid) {
  Random random(2);
  for (const std::size_t size : {2u, 3u, 5u}) {
    const auto number = [&] { return 0.1 * static_cast<double>(random.below(size)); };
    EXPECT_GT(expect_near(samples(1'500), number), samples(100));
  }
}

TEST(TriangleDistance, OfSliversThatAreNearlyParallel) {
  Random random(3);
  for (const double width : {1e-3, 1e-6, 1e-9, 1e-12}) {
    int at = 0;  // long along x, and all but flat elsewhere
    const auto number = [&] {
      return at++ % 3 == 0 ? random.uniform(-1, 1) : width * random.uniform(-1, 1);
    };
    EXPECT_GT(expect_near(samples(800), number), samples(200));
  }
}

}  // namespace
}  // namespace ist::test
