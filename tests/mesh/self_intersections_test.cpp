#include "ist/mesh/self_intersections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "ist/base/parallel.h"
#include "ist/mesh/components.h"
#include "ist/mesh/triangles_meet.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/exact.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;
using Pairs = std::vector<std::array<std::uint32_t, 2>>;

SelfIntersections found_in(const TriangleMesh& mesh) {
  return find_self_intersections(mesh, TriangleClusters(mesh, mesh.vertices[mesh.triangles[0][0]]));
}

// Decides a pair in rational numbers. Two triangles that share corners meet beyond these if and
// only if one's edge or corner opposite the shared ones meets the other triangle, except that
// coplanar triangles at an edge are compared by the triangles' own edges.
bool meet_by_rationals(const TriangleMesh& mesh, Triangle a, Triangle b) {
  const auto at = [&](std::uint32_t v) { return mesh.vertices[v]; };
  const auto meet = [](const TriangleCorners& s, const TriangleCorners& t) {
    return polygons_meet(exact_triangle(s), exact_triangle(t));
  };
  std::vector<std::uint32_t> shared, only_a, only_b;
  for (const std::uint32_t v : a) {
    (std::find(b.begin(), b.end(), v) == b.end() ? only_a : shared).push_back(v);
  }
  for (const std::uint32_t v : b) {
    if (std::find(a.begin(), a.end(), v) == a.end()) only_b.push_back(v);
  }
  const TriangleCorners ca = {at(a[0]), at(a[1]), at(a[2])}, cb = {at(b[0]), at(b[1]), at(b[2])};
  switch (shared.size()) {
    case 0:
      return meet(ca, cb);
    case 1:
      return meet({at(only_a[0]), at(only_a[1]), at(only_a[1])}, cb) ||
             meet(ca, {at(only_b[0]), at(only_b[1]), at(only_b[1])});
    case 2: {
      // They meet beyond the edge if the way from its middle to one's corner crosses or ends in the
      // other, or a corner lies in the other.
      const Vector p = at(only_a[0]), q = at(only_b[0]);
      if (meet({p, p, p}, cb) || meet({q, q, q}, ca)) return true;
      const Vector &u = at(shared[0]), &v = at(shared[1]);
      const auto cross = [&](const Vector& s, const Vector& t) {
        return meet({s, p, p}, {t, q, q});
      };
      return cross(u, v) || cross(v, u);
    }
    default:
      return true;
  }
}

Pairs expected_in(const TriangleMesh& mesh) {
  Pairs pairs;
  const auto has_any_area = [&](const Triangle& t) {
    const Vector u = mesh.vertices[t[1]] - mesh.vertices[t[0]],
                 v = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    return !has_equal_indices(t) && u.cross(v).norm() > 0;  // exact on the grids of these tests
  };
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::uint32_t j = i + 1; j < mesh.triangles.size(); ++j) {
      const Triangle &a = mesh.triangles[i], &b = mesh.triangles[j];
      if (has_any_area(a) && has_any_area(b) && meet_by_rationals(mesh, a, b)) {
        pairs.push_back({i, j});
      }
    }
  }
  return pairs;
}

// Few vertices on a small grid, so that triangles share corners, touch, overlap and have no area.
TEST(SelfIntersections, EqualAllPairsInRationalNumbers) {
  Random random(1);
  std::size_t found = 0, none = 0;
  for (int k = 0; k < samples(300); ++k) {
    TriangleMesh mesh;
    const std::size_t size = 2 + random.below(4);
    for (int v = 0; v < 9; ++v) {
      mesh.vertices.emplace_back(0.125 * static_cast<double>(random.below(size)),
                                 0.125 * static_cast<double>(random.below(size)),
                                 0.125 * static_cast<double>(random.below(size)));
    }
    for (int t = 0; t < 12; ++t) {
      const auto v = [&] { return static_cast<std::uint32_t>(random.below(9)); };
      mesh.triangles.push_back({v(), v(), v()});
    }
    const Pairs expected = expected_in(mesh);
    EXPECT_EQ(found_in(mesh).pairs, expected);
    found += expected.size();
    none += 66 - expected.size();
  }
  EXPECT_GT(found, 300u);
  EXPECT_GT(none, 300u);
}

TEST(SelfIntersections, CleanBodiesHaveNone) {
  for (const TriangleMesh& mesh :
       {icosphere(4, 5), box({0, 0, 0}, {1, 2, 3}), torus(5, 2, 60, 30), plate_with_holes(6),
        joined(icosphere(2, 4), inside_out(icosphere(2, 2))), open_strip(20)}) {
    const SelfIntersections found = found_in(mesh);
    EXPECT_TRUE(found.pairs.empty());
    EXPECT_TRUE(found.complete);
  }
}

// All needles of an end share a corner, so that their boxes overlap there.
TEST(SelfIntersections, FansOfNeedlesHaveNone) {
  for (const double height : {100.0, 0.01}) {
    TriangleMesh mesh = cylinder(1000, 1, height);
    EXPECT_TRUE(found_in(mesh).pairs.empty());
    // One more needle of an end, over ten others.
    std::vector<std::size_t> uses(mesh.vertices.size());
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t v : t) ++uses[v];
    }
    const auto hub =
        static_cast<std::uint32_t>(std::max_element(uses.begin(), uses.end()) - uses.begin());
    std::vector<Triangle> needles;
    for (const Triangle& t : mesh.triangles) {
      if (std::find(t.begin(), t.end(), hub) != t.end()) needles.push_back(t);
    }
    ASSERT_GT(needles.size(), 1000u);
    const auto rim = [&](const Triangle& t) { return t[0] == hub ? t[1] : t[0]; };
    mesh.triangles.push_back({hub, rim(needles[0]), rim(needles[10])});
    EXPECT_GE(found_in(mesh).pairs.size(), 9u);
  }
}

// A fan in any plane: its axis may lie along any of the mesh's.
TEST(SelfIntersections, AFanMayHaveAnyAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    TriangleMesh mesh = cylinder(5000, 1, 100);
    for (Vector& v : mesh.vertices) v = Vector(v[axis], v[(axis + 1) % 3], v[(axis + 2) % 3]);
    EXPECT_TRUE(found_in(mesh).pairs.empty());
  }
}

// A triangle at a hub may have a corner at the same place, and then no direction.
TEST(SelfIntersections, AHubWithTrianglesWithoutAreaIsSearched) {
  TriangleMesh mesh = cylinder(100, 1, 1);
  const auto before = found_in(mesh).pairs;
  std::vector<std::size_t> uses(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) ++uses[v];
  }
  const auto hub =
      static_cast<std::uint32_t>(std::max_element(uses.begin(), uses.end()) - uses.begin());
  ASSERT_GT(uses[hub], 64u);
  for (std::uint32_t k = 0; k < 40; ++k) {
    mesh.vertices.push_back(mesh.vertices[hub]);
    mesh.triangles.push_back({hub, static_cast<std::uint32_t>(mesh.vertices.size() - 1), k});
  }
  EXPECT_EQ(found_in(mesh).pairs, before);
}

TEST(SelfIntersections, TouchingCounts) {
  const TriangleMesh cube = box({0, 0, 0}, {1, 1, 1});
  for (const Vector& by : {Vector(1, 1, 1), Vector(1, 1, 0), Vector(1, 0, 0), Vector(0.5, 0, 0),
                           Vector(0, 0, 0), Vector(1, 0.5, 0.25)}) {
    const TriangleMesh two = joined(cube, moved(cube, by));
    const Pairs expected = expected_in(two);
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(found_in(two).pairs, expected) << by.transpose();
  }
  EXPECT_TRUE(found_in(joined(cube, moved(cube, {1 + 0x1p-52, 0, 0}))).pairs.empty());
}

TEST(SelfIntersections, AreTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = joined(icosphere(4, 5), moved(icosphere(4, 5), {1, 2, 3}));
  const Pairs all = found_in(mesh).pairs;
  EXPECT_GT(all.size(), 100u);
  const ScopedThreadLimit one(1);
  EXPECT_EQ(found_in(mesh).pairs, all);
}

TEST(SelfIntersections, EndIfThereAreTooMany) {
  const SelfIntersections found = found_in(coincident(3000));
  EXPECT_FALSE(found.complete);
  EXPECT_LE(found.pairs.size(), SelfIntersections::kMost);
  EXPECT_GT(found.pairs.size(), 0u);
}

}  // namespace
}  // namespace ist::test
