#include "ist/voxel/triangle_bins.h"

#include <Eigen/Geometry>
#include <bit>
#include <limits>
#include <numbers>

#include "ist/base/assert.h"
#include "ist/base/compensated.h"
#include "ist/base/error.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/parallel.h"

namespace ist {
namespace {

// Returns a·d - b·c, right to the last bit but one; a plain difference would lose a sliver's
// normal.
double determinant(double a, double b, double c, double d) noexcept {
  CompensatedSum sum;
  sum.add_product(a, d);
  sum.add_product(-b, c);
  return sum.value();
}

constexpr int kTriangleBits = 28;  // the other 36 hold a block's code: 4,096 blocks an axis
static_assert(kMaxTriangles < std::size_t{1} << kTriangleBits);
constexpr std::size_t kTrianglesARange = 4096;

// Finds the blocks in one octree cube that a triangle intersects. For a triangle that spans the
// grid, the time grows with its area, not with its bounding box.
class BlockFinder {
 public:
  BlockFinder(const TriangleBox& triangle, double pad, std::uint32_t blocks,
              std::vector<std::uint64_t>& found, std::uint64_t id)
      : triangle_(triangle), pad_(pad), blocks_(blocks), found_(found), id_(id) {}

  void visit(const Cell& cube, int level) {
    const std::uint32_t first[3] = {cube[0] << level, cube[1] << level, cube[2] << level};
    if (first[0] >= blocks_ || first[1] >= blocks_ || first[2] >= blocks_) return;
    const double half = 0.5 * TriangleBins::kEdge * static_cast<double>(1u << level);
    const auto centre = [&](int i) { return (2.0 * cube[static_cast<std::size_t>(i)] + 1) * half; };
    if (!triangle_.meets(centre(0), centre(1), centre(2), half + pad_)) return;
    if (level == 0) {
      found_.push_back(morton_encode(cube) << kTriangleBits | id_);
      return;
    }
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      visit({2 * cube[0] + (octant & 1), 2 * cube[1] + (octant >> 1 & 1),
             2 * cube[2] + (octant >> 2)},
            level - 1);
    }
  }

 private:
  const TriangleBox& triangle_;
  double pad_;
  std::uint32_t blocks_;
  std::vector<std::uint64_t>& found_;
  std::uint64_t id_;
};

void find_blocks(const TriangleBox& triangle, std::uint32_t cells, double pad, std::uint64_t id,
                 std::vector<std::uint64_t>& found) {
  const std::uint32_t blocks = (cells + TriangleBins::kEdge - 1) / TriangleBins::kEdge;
  BlockFinder finder(triangle, pad, blocks, found, id);
  // Begins with cubes as large as the triangle, which intersects at most three of them on an axis.
  Cell first, last;
  std::uint32_t widest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const auto block = [&](double x) {
      const double index = std::floor(x / TriangleBins::kEdge);
      return static_cast<std::uint32_t>(std::clamp(index, 0.0, static_cast<double>(blocks - 1)));
    };
    // Blocks are closed: a block that ends at the minimum or begins at the maximum counts, too.
    first[i] = block(triangle.min()[axis] - pad - 0.5);
    last[i] = block(triangle.max()[axis] + pad);
    widest = std::max(widest, last[i] - first[i]);
  }
  const auto level = static_cast<int>(std::bit_width(widest));
  for (std::uint32_t z = first[2] >> level; z <= last[2] >> level; ++z) {
    for (std::uint32_t y = first[1] >> level; y <= last[1] >> level; ++y) {
      for (std::uint32_t x = first[0] >> level; x <= last[0] >> level; ++x) {
        finder.visit({x, y, z}, level);
      }
    }
  }
}

}  // namespace

TriangleBox::TriangleBox(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                         const Eigen::Vector3d& c) noexcept
    : origin_(a) {
  for (int i = 0; i < 3; ++i) {
    min_[i] = std::min({a[i], b[i], c[i]});
    max_[i] = std::max({a[i], b[i], c[i]});
  }
  const Eigen::Vector3d corners[3] = {Eigen::Vector3d::Zero(), b - a, c - a};
  const Eigen::Vector3d sides[3] = {b - a, c - b, a - c};
  const Eigen::Vector3d &s = sides[0], &t = corners[2];
  normal_ = {determinant(s[1], s[2], t[1], t[2]), determinant(s[2], s[0], t[2], t[0]),
             determinant(s[0], s[1], t[0], t[1])};
  normal_reach_ = (std::abs(normal_[0]) + std::abs(normal_[1])) + std::abs(normal_[2]);
  for (int edge = 0; edge < 3; ++edge) {
    const Eigen::Vector3d& side = sides[edge];
    const auto axis = [&](int i, int j) {  // in the plane of coordinates i and j
      Axis result{-side[j], side[i], 0, 0, std::abs(side[i]) + std::abs(side[j])};
      double projections[3];
      for (int k = 0; k < 3; ++k) {
        projections[k] = result.u * corners[k][i] + result.v * corners[k][j];
      }
      result.low = std::min({projections[0], projections[1], projections[2]});
      result.high = std::max({projections[0], projections[1], projections[2]});
      return result;
    };
    edges_[edge] = {axis(1, 2), axis(2, 0), axis(0, 1)};
  }
}

LatticeMesh::LatticeMesh(const TriangleMesh& mesh, const Lattice& lattice, double offset)
    : triangles_(&mesh.triangles), vertices_(mesh.vertices.size()) {
  std::transform(mesh.vertices.begin(), mesh.vertices.end(), vertices_.begin(),
                 [&](const Eigen::Vector3d& vertex) {
                   return Eigen::Vector3d(lattice.to_lattice(vertex).array() + offset);
                 });
}

PairCounts::PairCounts(const TriangleMesh& mesh) noexcept
    : triangles_(static_cast<double>(mesh.triangles.size())) {
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]],
                          &c = mesh.vertices[t[2]];
    const Eigen::Vector3d twice = cross_in_order(difference(b, a), difference(c, a)).cwiseAbs();
    projections_ += 0.5 * sum_in_order(twice);
    sections_ += 0.5 * std::max(length_in_order(twice) / std::numbers::sqrt2, twice.maxCoeff());
    extents_ += sum_in_order(a.cwiseMax(b).cwiseMax(c) - a.cwiseMin(b).cwiseMin(c));
  }
}

TriangleBins bin_triangles(const LatticeMesh& mesh, std::uint32_t cells, double pad) {
  const std::size_t triangles = mesh.triangle_count();
  IST_ASSERT(triangles <= kMaxTriangles);
  std::vector<std::vector<std::uint64_t>> parts((triangles + kTrianglesARange - 1) /
                                                kTrianglesARange);
  parallel_for(triangles, kTrianglesARange, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint64_t>& found = parts[begin / kTrianglesARange];
    for (std::size_t t = begin; t < end; ++t) {
      find_blocks(mesh.box(static_cast<std::uint32_t>(t)), cells, pad, t, found);
    }
  });
  std::size_t count = 0;
  for (const auto& part : parts) count += part.size();
  if (count > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::kMemoryLimit,
                "the mesh has too many triangles for this voxel size: simplify the mesh, or use a "
                "larger voxel size");
  }
  std::vector<std::uint64_t> pairs;
  pairs.reserve(count);
  for (auto& part : parts) {
    pairs.insert(pairs.end(), part.begin(), part.end());
    part = {};
  }
  parallel_sort(pairs);

  TriangleBins bins;
  bins.triangles.ids.reserve(count);
  for (const std::uint64_t pair : pairs) {
    const std::uint64_t code = pair >> kTriangleBits;
    if (bins.codes.empty() || bins.codes.back() != code) {
      bins.codes.push_back(code);
      bins.triangles.first.push_back(static_cast<std::uint32_t>(bins.triangles.ids.size()));
    }
    bins.triangles.ids.push_back(
        static_cast<std::uint32_t>(pair & ((std::uint64_t{1} << kTriangleBits) - 1)));
  }
  bins.triangles.first.push_back(static_cast<std::uint32_t>(count));
  return bins;
}

}  // namespace ist
