#include "ist/mesh/clusters/triangle_clusters.h"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "ist/base/parallel.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;

std::vector<TriangleMesh> meshes() {
  Random random(5);
  std::vector<TriangleMesh> all = {triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                                   coincident(40),
                                   open_strip(8),
                                   open_strip(9),
                                   icosphere(3, 10),
                                   moved(icosphere(2, 1e-6), {1e3, -1e3, 5}),
                                   torus(20, 3, 90, 40)};
  for (int i = 0; i < samples(10); ++i) all.push_back(random_mesh(random));
  return all;
}

// A corner in the tree's frame, as exactly as double holds it.
Vector in_frame(const TriangleClusters& clusters, const Vector& p, const Vector& origin) {
  return clusters.axes().transpose() * (p - origin);
}

// The corners of all triangles below a node.
std::vector<Vector> points_of(const TriangleClusters& clusters, const TriangleMesh& mesh,
                              const Vector& origin, int level, std::uint32_t node) {
  std::vector<Vector> points;
  if (level < 0) return points;
  const auto add = [&](std::uint32_t cluster) {
    for (std::uint32_t k = 0; k < clusters.child_count(-1, cluster); ++k) {
      for (const std::uint32_t v : mesh.triangles[clusters.clusters()[cluster].id[k]]) {
        points.push_back(in_frame(clusters, mesh.vertices[v], origin));
      }
    }
  };
  std::uint64_t width = 1;
  for (int i = 0; i < level; ++i) width *= kClusterWidth;
  const std::uint64_t end = std::min<std::uint64_t>((node + 1) * width, clusters.node_count(0));
  for (std::uint64_t cluster = node * width; cluster < end; ++cluster) {
    add(static_cast<std::uint32_t>(cluster));
  }
  return points;
}

TEST(TriangleClusters, HoldEachTriangleOnce) {
  for (const TriangleMesh& mesh : meshes()) {
    const TriangleClusters clusters(mesh, {0.5, 0, 0});
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    ASSERT_EQ(clusters.triangle_count(), count);
    ASSERT_EQ(clusters.node_count(0), (count + 15) / 16);
    ASSERT_EQ(clusters.clusters().size(), clusters.node_count(0));
    ASSERT_GE(clusters.root_level(), 1);
    ASSERT_EQ(clusters.node_count(clusters.root_level()), 1u);
    std::vector<int> seen(count);
    for (std::uint32_t c = 0; c < clusters.node_count(0); ++c) {
      for (std::uint32_t k = 0; k < kClusterWidth; ++k) {
        const std::uint32_t id = clusters.clusters()[c].id[k];
        const std::uint32_t last = clusters.child_count(-1, c) - 1;
        if (k <= last) ++seen[id];
        if (k > last) {
          EXPECT_EQ(id, clusters.clusters()[c].id[last]) << "the last one is repeated";
        }
      }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(count));
  }
}

TEST(TriangleClusters, NodesHoldWhatIsBelowThem) {
  for (const TriangleMesh& mesh : meshes()) {
    const Vector origin = mesh.vertices[0];
    const TriangleClusters clusters(mesh, origin);
    for (int level = 0; level <= clusters.root_level(); ++level) {
      for (std::uint32_t node = 0; node < clusters.node_count(level); ++node) {
        const NodeBlock& block = clusters.bounds(level)[node / kClusterWidth];
        const std::size_t lane = node % kClusterWidth;
        const auto at = [&](const float(&of)[3][kClusterWidth]) {
          return Vector(of[0][lane], of[1][lane], of[2][lane]);
        };
        const Vector centre = at(block.centre), half = at(block.half), normal = at(block.normal);
        for (Eigen::Index i = 0; i < 3; ++i) {
          const double cells = centre[i] / clusters.grid();
          ASSERT_EQ(cells, std::round(cells));
          ASSERT_LE(std::abs(cells), 0x1p22);
        }
        const double rounding = 1e-13 * (1 + centre.cwiseAbs().maxCoeff());
        for (const Vector& p : points_of(clusters, mesh, origin, level, node)) {
          const Vector v = p - centre;
          const double height = normal.dot(v);
          ASSERT_LE((v.cwiseAbs() - half).maxCoeff(), rounding);
          ASSERT_LE(v.norm(), block.radius[lane] + rounding);
          ASSERT_LE(std::abs(height - block.offset[lane]), block.thickness[lane] + rounding);
          // From the line through the centre, along the normal.
          const Vector aside = v - height / normal.squaredNorm() * normal;
          ASSERT_LE(aside.norm(), block.rim[lane] + rounding);
        }
      }
    }
  }
}

TEST(TriangleClusters, CornersAreRoundedOnce) {
  for (const TriangleMesh& mesh : meshes()) {
    const Vector origin = mesh.vertices.back();
    const TriangleClusters clusters(mesh, origin);
    for (std::uint32_t c = 0; c < clusters.node_count(0); ++c) {
      const TriangleCluster& cluster = clusters.clusters()[c];
      const NodeBlock& block = clusters.bounds(0)[c / kClusterWidth];
      const std::size_t lane = c % kClusterWidth;
      const Vector centre(block.centre[0][lane], block.centre[1][lane], block.centre[2][lane]);
      for (std::size_t k = 0; k < kClusterWidth; ++k) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
          const Vector p =
              in_frame(clusters, mesh.vertices[mesh.triangles[cluster.id[k]][corner]], origin);
          for (std::size_t i = 0; i < 3; ++i) {
            const Vector axis(cluster.axis[0][i], cluster.axis[1][i], cluster.axis[2][i]);
            const double wanted = axis.dot(p - centre);
            const float stored = cluster.corner[corner][i][k];
            ASSERT_NEAR(stored, wanted,
                        0x1p-24 * std::abs(wanted) + 1e-14 * (1 + centre.cwiseAbs().maxCoeff()));
            ASSERT_LE(cluster.low[i], stored);
            ASSERT_GE(cluster.high[i], stored);
          }
        }
      }
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          double product = 0;
          for (std::size_t k = 0; k < 3; ++k) product += cluster.axis[k][i] * cluster.axis[k][j];
          ASSERT_NEAR(product, i == j ? 1 : 0, 0x1p-22);
        }
      }
    }
  }
}

bool same(const TriangleClusters& a, const TriangleClusters& b) {
  const auto bytes_of = [](const auto& span) { return span.size_bytes(); };
  if (a.clusters().size() != b.clusters().size() || a.root_level() != b.root_level()) return false;
  for (int level = 0; level <= a.root_level(); ++level) {
    if (std::memcmp(a.bounds(level).data(), b.bounds(level).data(), bytes_of(a.bounds(level)))) {
      return false;
    }
  }
  // But for the padding at a cluster's end.
  constexpr std::size_t kBytes = offsetof(TriangleCluster, high) + sizeof(TriangleCluster::high);
  return std::equal(a.clusters().begin(), a.clusters().end(), b.clusters().begin(),
                    [](const TriangleCluster& x, const TriangleCluster& y) {
                      return std::memcmp(&x, &y, kBytes) == 0;
                    });
}

TEST(TriangleClusters, AreTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = torus(20, 3, 200, 90);
  const TriangleClusters many(mesh, {0, 0, 0});
  const ScopedThreadLimit one(1);
  EXPECT_TRUE(same(many, TriangleClusters(mesh, {0, 0, 0})));
}

// The size of the clusters does not depend on the file's axes.
TEST(TriangleClusters, AreAsSmallInTurnedFrames) {
  const auto sizes = [](const TriangleMesh& mesh) {
    const TriangleClusters clusters(mesh, {0, 0, 0});
    double sum = 0;
    for (std::uint32_t c = 0; c < clusters.node_count(0); ++c) {
      const NodeBlock& block = clusters.bounds(0)[c / kClusterWidth];
      for (const auto& half : block.half) sum += half[c % kClusterWidth];
    }
    return sum;
  };
  const TriangleMesh mesh = torus(20, 3, 200, 90);
  TriangleMesh long_one = mesh;
  for (Vector& v : long_one.vertices) v[0] *= 1.5;
  Random random(3);
  for (int i = 0; i < samples(5); ++i) {
    EXPECT_NEAR(sizes(turned(long_one, random.rotation())) / sizes(long_one), 1, 0.01);
  }
}

TEST(TriangleOrder, KeepsNeighboursTogether) {
  Random random(7);
  std::vector<Vector> corners;
  for (int i = 0; i < 3 * 5000; ++i) corners.push_back(random.point(0, 1));
  const std::vector<std::uint32_t> order = triangle_order(corners);
  std::vector<std::uint32_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (std::uint32_t k = 0; k < sorted.size(); ++k) ASSERT_EQ(sorted[k], k);
  const auto spread = [&](auto index) {
    double sum = 0;
    for (std::size_t first = 0; first + 16 <= order.size(); first += 16) {
      Eigen::AlignedBox3d box;
      for (std::size_t k = first; k < first + 16; ++k) {
        const std::size_t t = index(k);
        box.extend((corners[3 * t] + corners[3 * t + 1] + corners[3 * t + 2]) / 3);
      }
      sum += box.diagonal().norm();
    }
    return sum;
  };
  EXPECT_LT(spread([&](std::size_t k) { return order[k]; }),
            0.3 * spread([](std::size_t k) { return k; }));
}

}  // namespace
}  // namespace ist::test
