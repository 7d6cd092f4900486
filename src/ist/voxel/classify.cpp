#include "ist/voxel/classify.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "ist/base/ordered_vector.h"
#include "ist/base/parallel.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/components.h"
#include "ist/mesh/nearest_point.h"
#include "ist/mesh/surface_sides.h"
#include "ist/voxel/triangle_bins.h"

namespace ist {
namespace {

using Eigen::Vector3d;

constexpr double kRange = 2;  // voxel edges
// Squares of distances of cells that differ by less may differ by rounding alone.
constexpr double kTie = 1e-8;

// Returns the arc cosine to 7e-5, without libm, whose bits depend on the processor.
// Source: M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, 4.4.45.
double arc_cosine(double cosine) {
  constexpr double kPi = 3.141592653589793;
  const double x = std::min(1.0, std::abs(cosine));
  const double angle =
      std::sqrt(1 - x) * (1.5707288 + x * (-0.2121144 + x * (0.0742610 - x * 0.0187293)));
  return cosine < 0 ? kPi - angle : angle;
}

Vector3d unit_or_zero(const Vector3d& v) {
  const double length = length_in_order(v);
  return length > 0 ? Vector3d(v / length) : Vector3d(Vector3d::Zero());
}

// The pseudonormals of all corners, edges and faces. Only the signs of dot products are used, so
// only the faces' normals have unit length.
class PseudoNormals {
 public:
  explicit PseudoNormals(const TriangleMesh& mesh)
      : faces_(mesh.triangles.size()),
        vertices_(mesh.vertices.size(), Vector3d::Zero()),
        edges_(mesh.triangles.size()),
        triangles_(mesh.triangles) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& corners = mesh.triangles[t];
      const auto vertex = [&](std::uint32_t i) { return mesh.vertices[corners[i % 3]]; };
      faces_[t] = unit_or_zero((vertex(1) - vertex(0)).cross(vertex(2) - vertex(0)));
      for (std::uint32_t i = 0; i < 3; ++i) {
        const Vector3d to_next = unit_or_zero(vertex(i + 1) - vertex(i));
        const Vector3d to_last = unit_or_zero(vertex(i + 2) - vertex(i));
        vertices_[corners[i]] += arc_cosine(dot_in_order(to_next, to_last)) * faces_[t];
      }
    }
    const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
      Vector3d sum = Vector3d::Zero();
      for (const EdgeUse& use : edge) sum += faces_[use.triangle];
      closed_ = closed_ && is_balanced(edge);
      for (const EdgeUse& use : edge) {
        const Triangle& corners = mesh.triangles[use.triangle];
        std::size_t side = 0;
        while (corners[side] != (use.forward ? use.low : use.high)) ++side;
        edges_[use.triangle][side] = sum;
      }
    });
  }

  [[nodiscard]] const Vector3d& at(std::uint32_t triangle, int feature) const {
    const auto i = static_cast<std::size_t>(feature);
    if (feature == NearestPoint::kInside) return faces_[triangle];
    return i < 3 ? vertices_[triangles_[triangle][i]] : edges_[triangle][i - 3];
  }
  [[nodiscard]] bool is_degenerate(std::uint32_t triangle) const {
    return faces_[triangle].isZero(0);
  }
  // Whether as many triangles traverse each edge one way as the other.
  [[nodiscard]] bool closed() const { return closed_; }

 private:
  std::vector<Vector3d> faces_, vertices_;
  std::vector<std::array<Vector3d, 3>> edges_;
  const std::vector<Triangle>& triangles_;
  bool closed_ = true;
};

// The outer side of a closed surface, by winding numbers.
class ClosedSides {
 public:
  ClosedSides(const TriangleMesh& mesh, const Lattice& lattice)
      : mesh_(mesh),
        lattice_(lattice),
        clusters_(mesh, mesh.vertices[mesh.triangles[0][0]]),
        sides_(mesh, clusters_) {}

  [[nodiscard]] bool is_outside(const Cell& cell, std::uint32_t nearest, bool is_tied) const {
    Vector3d centre;
    for (std::size_t i = 0; i < 3; ++i) {
      centre[static_cast<Eigen::Index>(i)] =
          lattice_.corner[i] + lattice_.voxel_size * (cell[i] + 0.5 - kProximityMargin);
    }
    const Triangle& t = mesh_.triangles[nearest];
    const NearestPoint on = nearest_on_triangle(
        {mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]}, centre);
    const double square = square_in_order(difference(centre, on.point));
    return sides_.of(mesh_, clusters_, centre, {square, nearest, on, is_tied}) == Side::kOutside;
  }

 private:
  const TriangleMesh& mesh_;
  const Lattice& lattice_;
  TriangleClusters clusters_;
  SurfaceSides sides_;
};

// Finds the cells of one block that lie on the outer side of a surface: of a closed one by winding
// numbers, of an open one by the pseudonormal of the nearest triangle.
class BlockClassifier {
 public:
  BlockClassifier(const LatticeMesh& mesh, const PseudoNormals& normals, const ClosedSides* closed,
                  const VoxelSet& surface)
      : mesh_(mesh), normals_(normals), closed_(closed), surface_(surface) {}

  void classify(std::uint64_t code, std::span<const std::uint32_t> triangles,
                std::vector<std::uint64_t>& found) {
    nearest_.fill({std::numeric_limits<double>::infinity(), 0, false, false});
    for (const std::uint32_t t : triangles) {
      if (!normals_.is_degenerate(t)) take_in(t, morton_decode(code));
    }
    for (std::size_t i = 0; i < TriangleBins::kBlockCells; ++i) {
      const std::uint64_t cell_code = code * TriangleBins::kBlockCells + i;
      const Nearest& nearest = nearest_[i];
      if (!(nearest.distance2 <= kRange * kRange)) continue;
      const Cell cell = morton_decode(cell_code);
      if (is_surface(cell)) continue;
      if (closed_ != nullptr ? closed_->is_outside(cell, nearest.triangle, nearest.is_tied)
                             : nearest.outside) {
        found.push_back(cell_code);
      }
    }
  }

 private:
  struct Nearest {
    double distance2;
    std::uint32_t triangle;
    bool outside;
    bool is_tied;  // a triangle as near has the cell on its other side
  };

  void take_in(std::uint32_t t, const Cell& block) {
    const auto corners = mesh_.corners(t);
    const auto& [a, b, c] = corners;
    const Vector3d low = a.cwiseMin(b).cwiseMin(c).array() - kRange - 0.5;
    const Vector3d high = a.cwiseMax(b).cwiseMax(c).array() + kRange - 0.5;
    const auto enter = [](std::uint32_t, std::uint32_t) { return true; };
    for_each_cell(block, low, high, enter, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
      const Vector3d centre(x + 0.5, y + 0.5, z + 0.5);
      const NearestPoint nearest = nearest_on_triangle(corners, centre);
      const Vector3d away = centre - nearest.point;
      Nearest& known = nearest_[morton_encode({x, y, z}) % TriangleBins::kBlockCells];
      const double square = square_in_order(away);
      const bool outside = dot_in_order(away, normals_.at(t, nearest.feature)) > 0;
      if (std::abs(square - known.distance2) <= kTie) known.is_tied |= outside != known.outside;
      if (square >= known.distance2) return;
      const bool is_tied = known.is_tied && known.distance2 - square <= kTie;
      known = {square, t, outside, is_tied};
    });
  }

  [[nodiscard]] bool is_surface(Cell cell) const {
    for (std::uint32_t& index : cell) {
      if (index < kProximityMargin) return false;
      index -= kProximityMargin;
      if (index >= surface_.lattice.cells) return false;
    }
    return std::binary_search(surface_.codes.begin(), surface_.codes.end(), morton_encode(cell));
  }

  const LatticeMesh& mesh_;
  const PseudoNormals& normals_;
  const ClosedSides* closed_;
  const VoxelSet& surface_;
  std::array<Nearest, TriangleBins::kBlockCells> nearest_;
};

}  // namespace

std::vector<std::uint64_t> proximity_voxels(const TriangleMesh& mesh, const VoxelSet& surface) {
  const std::uint32_t cells = surface.lattice.cells + 2 * kProximityMargin;
  if (cells > Lattice::kMaxCells) {
    throw_error(ErrorCode::kVoxelSizeTooSmall,
                "proximity voxels need a margin of {} voxels on each side, {} voxels "
                "an axis, and the limit is {}: use a slightly larger voxel size",
                kProximityMargin, cells, Lattice::kMaxCells);
  }
  const LatticeMesh lattice_mesh(mesh, surface.lattice, kProximityMargin);
  const PseudoNormals normals(mesh);
  std::optional<ClosedSides> closed;
  if (normals.closed()) closed.emplace(mesh, surface.lattice);
  const TriangleBins bins = bin_triangles(lattice_mesh, cells, kRange);
  const std::size_t blocks = bins.codes.size();
  std::vector<std::vector<std::uint64_t>> parts((blocks + TriangleBins::kBlocksARange - 1) /
                                                TriangleBins::kBlocksARange);
  parallel_for(blocks, TriangleBins::kBlocksARange, [&](std::size_t begin, std::size_t end) {
    BlockClassifier classifier(lattice_mesh, normals, closed ? &*closed : nullptr, surface);
    for (std::size_t b = begin; b < end; ++b) {
      classifier.classify(bins.codes[b], bins.triangles[b],
                          parts[begin / TriangleBins::kBlocksARange]);
    }
  });
  std::vector<std::uint64_t> codes;
  for (const auto& part : parts) codes.insert(codes.end(), part.begin(), part.end());
  return codes;
}

}  // namespace ist
