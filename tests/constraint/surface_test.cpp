#include "ist/constraint/surface.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "haptics/wall/fine_bodies.h"
#include "query/triangles/mesh_distance.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;
using Kind = SurfacePart::Kind;

constexpr std::array kCorners{TrianglePart::kCorner0, TrianglePart::kCorner1,
                              TrianglePart::kCorner2};
constexpr std::array kEdges{TrianglePart::kEdge0, TrianglePart::kEdge1, TrianglePart::kEdge2};

// The same triangles, each with corners of its own, as an STL file has them.
TriangleMesh unwelded(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    soup = joined(soup, triangle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  }
  return soup;
}

Vector corner(const TriangleMesh& mesh, std::uint32_t triangle, std::size_t k) {
  return mesh.vertices[mesh.triangles[triangle][k % 3]];
}

std::uint32_t count_of(const TriangleMesh& mesh) {
  return static_cast<std::uint32_t>(mesh.triangles.size());
}

// Calls `with(part, triangle, k)` for each vertex and each edge of each triangle.
template <class With>
void for_parts(const Surface& surface, const With& with) {
  for (std::uint32_t t = 0; t < count_of(surface.mesh()); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      with(surface.part(t, kCorners[k]), t, k);
      with(surface.part(t, kEdges[k]), t, k);
    }
  }
}

struct Counts {
  std::size_t vertices, edges, flat_vertices, flat_edges;
  friend bool operator==(const Counts&, const Counts&) = default;
};

Counts counts(const TriangleMesh& mesh) {
  const Surface surface(mesh);
  std::set<std::uint32_t> vertices, edges, flat_vertices, flat_edges;
  for_parts(surface, [&](const SurfacePart& part, std::uint32_t, std::size_t) {
    const bool is_edge = part.kind == Kind::kEdge;
    (is_edge ? edges : vertices).insert(part.index);
    if (surface.is_flat(part)) (is_edge ? flat_edges : flat_vertices).insert(part.index);
  });
  return {vertices.size(), edges.size(), flat_vertices.size(), flat_edges.size()};
}

TEST(Surface, CountsVerticesAtOnePositionAsOne) {
  for (const TriangleMesh& mesh :
       {box({0, 0, 0}, {1, 2, 3}), icosphere(2, 1), plate_with_holes(2)}) {
    EXPECT_EQ(counts(unwelded(mesh)), counts(mesh));
  }
  const TriangleMesh soup = unwelded(icosphere(1, 1));
  const Surface surface(soup);
  std::map<std::array<double, 3>, std::uint32_t> at;
  for_parts(surface, [&](const SurfacePart& part, std::uint32_t t, std::size_t k) {
    if (part.kind != Kind::kVertex) return;
    const Vector p = corner(soup, t, k);
    EXPECT_EQ(soup.vertices[part.index], p);
    EXPECT_EQ(at.try_emplace({p[0], p[1], p[2]}, part.index).first->second, part.index);
  });
  EXPECT_EQ(at.size(), 42u);
  EXPECT_EQ(surface.part(7, TrianglePart::kFace), (SurfacePart{Kind::kFace, 7}));
}

// An edge is the same part for both of its triangles, and for no other.
TEST(Surface, NamesAnEdgeByItsEnds) {
  for (const TriangleMesh& mesh : {icosphere(2, 1), plate_with_holes(3), unwelded(open_strip(4))}) {
    const Surface surface(mesh);
    std::map<std::uint32_t, std::set<std::array<double, 3>>> ends;
    std::set<std::set<std::array<double, 3>>> all;
    for_parts(surface, [&](const SurfacePart& part, std::uint32_t t, std::size_t k) {
      if (part.kind != Kind::kEdge) return;
      const Vector a = corner(mesh, t, k), b = corner(mesh, t, k + 1);
      const std::set<std::array<double, 3>> of{{a[0], a[1], a[2]}, {b[0], b[1], b[2]}};
      EXPECT_EQ(ends.try_emplace(part.index, of).first->second, of);
      all.insert(of);
    });
    EXPECT_EQ(ends.size(), all.size());
  }
}

TEST(Surface, OfABoxIsFlatAcrossItsDiagonalsAlone) {
  EXPECT_EQ(counts(box({0, 0, 0}, {1, 2, 3})), (Counts{8, 18, 0, 6}));
}

// Of n³ squares a face has (n - 1)² inner vertices; every inner edge is flat.
TEST(Surface, OfAFineBoxIsFlatInsideItsFaces) {
  Random random(1);
  for (const std::size_t n : {2u, 5u, 9u}) {
    const Counts wanted{6 * n * n + 2, 18 * n * n, 6 * (n - 1) * (n - 1), 18 * n * n - 12 * n};
    const TriangleMesh mesh = fine_box({3, 2, 1}, static_cast<int>(n));
    EXPECT_EQ(counts(mesh), wanted);
    EXPECT_EQ(counts(turned(mesh, random.rotation())), wanted);
    const Surface surface(mesh);
    for_parts(surface, [&](const SurfacePart& part, std::uint32_t, std::size_t) {
      if (part.kind != Kind::kVertex) return;
      const Vector p = mesh.vertices[part.index].cwiseAbs();
      const int borders = (p[0] == 1.5 ? 1 : 0) + (p[1] == 1 ? 1 : 0) + (p[2] == 0.5 ? 1 : 0);
      EXPECT_EQ(surface.is_flat(part), borders == 1);
    });
  }
}

TEST(Surface, IsNowhereFlatIfItIsRound) {
  EXPECT_EQ(counts(icosphere(3, 1)), (Counts{642, 1920, 0, 0}));
}

// The border of a sheet is no part of a plane region, and leaves to the outside.
TEST(Surface, HasAnOpenBorder) {
  const TriangleMesh strip = open_strip(3);
  EXPECT_EQ(counts(strip), (Counts{8, 13, 0, 5}));
  const Surface surface(strip);
  for_parts(surface, [&](const SurfacePart& part, std::uint32_t t, std::size_t k) {
    if (part.kind != Kind::kEdge || surface.is_flat(part)) return;
    const Vector middle = 0.5 * (corner(strip, t, k) + corner(strip, t, k + 1));
    const Vector inward = (corner(strip, t, k + 2) - middle).normalized();
    EXPECT_FALSE(surface.leaves(part, inward, 0.02));
    EXPECT_TRUE(surface.leaves(part, -inward, 0.02));
    EXPECT_TRUE(surface.leaves(part, Vector::UnitZ(), 0.02));
    EXPECT_TRUE(surface.leaves(part, -Vector::UnitZ(), 0.02));
  });
}

// Three sheets at one edge: only a direction between two of them, or away from all, leaves.
TEST(Surface, HasAnEdgeOfThreeTriangles) {
  const Vector a(0, 0, 0), b(0, 0, 1);
  TriangleMesh fan = triangle(a, b, {1, 0, 0});
  fan = joined(joined(fan, triangle(a, b, {-1, 0, 0.3})), triangle(a, b, {0, 2, 0.5}));
  EXPECT_EQ(counts(fan), (Counts{5, 7, 0, 0}));
  const Surface surface(fan);
  const SurfacePart edge = surface.part(0, TrianglePart::kEdge0);
  EXPECT_EQ(edge, surface.part(1, TrianglePart::kEdge0));
  EXPECT_EQ(edge, surface.part(2, TrianglePart::kEdge0));
  EXPECT_TRUE(surface.leaves(edge, -Vector::UnitY(), 0));
  EXPECT_FALSE(surface.leaves(edge, Vector(0.1, -1, 0).normalized(), 0.02));
  EXPECT_TRUE(surface.leaves(edge, Vector(0.01, -1, 0).normalized(), 0.02));
  EXPECT_FALSE(surface.leaves(edge, Vector(1, 1, 0).normalized(), 0.02));
  // The same two triangles twice, as a file with duplicates has them, are no plane region.
  const TriangleMesh sheet = open_strip(1);
  EXPECT_EQ(counts(joined(sheet, sheet)), (Counts{4, 5, 0, 0}));
}

TEST(Surface, OfTrianglesWithoutAreaIsNotFlat) {
  EXPECT_EQ(counts(triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})), (Counts{3, 3, 0, 0}));
  EXPECT_EQ(counts(triangle({0, 0, 0}, {2, 0, 0}, {1, 0, 0})), (Counts{3, 3, 0, 0}));
  EXPECT_EQ(counts(triangle({1, 2, 3}, {1, 2, 3}, {1, 2, 3})), (Counts{1, 1, 0, 0}));
  const TriangleMesh pin = triangle({0, 0, 0}, {1, 0, 0}, {0, 0, 0});
  const Surface surface(pin);
  const SurfacePart end = surface.part(0, TrianglePart::kCorner1);
  EXPECT_TRUE(surface.leaves(end, Vector::UnitX(), 0));
  EXPECT_FALSE(surface.leaves(end, -Vector::UnitX(), 0.02));
  EXPECT_TRUE(surface.leaves(surface.part(0, TrianglePart::kEdge0), Vector::UnitY(), 0));
}

// By all triangles: a point a little way off has no closer point than the part itself.
TEST(Surface, LeavesWhereNothingIsCloser) {
  Random random(2);
  constexpr double kOff = 1e-4;
  const TriangleMesh meshes[] = {icosphere(1, 1), torus(2, 0.7, 9, 7), plate_with_holes(1),
                                 unwelded(turned(box({-1, -1, -1}, {1, 2, 1}), random.rotation()))};
  std::size_t leaving = 0, asked = 0;
  for (int i = 0; i < samples(2'500) && !HasFailure(); ++i) {
    const TriangleMesh& mesh = meshes[random.below(std::size(meshes))];
    const Surface surface(mesh);
    const std::uint32_t t = static_cast<std::uint32_t>(random.below(mesh.triangles.size()));
    const std::size_t k = random.below(3u);
    const bool is_edge = random.below(2) == 0;
    const Vector a = corner(mesh, t, k), along = (corner(mesh, t, k + 1) - a).normalized();
    const Vector at = is_edge ? Vector(0.5 * (a + corner(mesh, t, k + 1))) : a;
    Vector direction = random.direction();
    if (is_edge) direction = (direction - direction.dot(along) * along).normalized();
    const plain::Vector off = (at + kOff * direction).cast<long double>();
    long double least = HUGE_VALL;
    for (const Triangle& s : mesh.triangles) {
      least = std::min(
          least, plain::from_triangle(off, plain::Corners({mesh.vertices[s[0]], mesh.vertices[s[1]],
                                                           mesh.vertices[s[2]]})));
    }
    // The sine of the ascent: the closest point is nearer by its square. Rounding hides small ones.
    const long double square = 1 - least / static_cast<long double>(kOff * kOff);
    const SurfacePart part = surface.part(t, (is_edge ? kEdges : kCorners)[k]);
    if (square > 1e-10L || square < -1e-10L) {
      EXPECT_FALSE(surface.leaves(part, direction, 0));
    } else {
      EXPECT_TRUE(surface.leaves(part, direction, 1e-4));
      ++leaving;
    }
    // An edge's triangles ascend no steeper than across it.
    if (is_edge && square > 0.021L * 0.021L) {
      EXPECT_FALSE(surface.leaves(part, direction, 0.02));
    } else if (square < 0.019L * 0.019L) {
      EXPECT_TRUE(surface.leaves(part, direction, 0.02));
    }
    ++asked;
  }
  EXPECT_GT(leaving, asked / 20);
}

}  // namespace
}  // namespace ist::test
