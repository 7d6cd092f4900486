#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "ist/voxel/morton.h"
#include "ist/voxel/triangle_clip.h"

namespace ist {

/// A hash of a tree's leaves by coarse cells: finds the leaves near a point without the tree.
class LeafGrid {
 public:
  /// Hashes the leaves into cells at least as large as balls of `radius`, mesh units. The tree must
  /// outlive the grid. Cost: 20 ns and 8 bytes a leaf, and 40 bytes a cell.
  LeafGrid(const SphereTree& tree, double radius)
      : lattice_(voxels_of(tree).lattice), codes_(voxels_of(tree).octree.codes(0)) {
    while (level_ < lattice_.depth && lattice_.edge(level_) < 2 * radius) ++level_;
    for (std::uint32_t leaf = 0; leaf < codes_.size(); ++leaf) {
      runs_.try_emplace(codes_[leaf] >> 3 * level_, leaf);
    }
  }

  /// Calls `visit` with each leaf whose cube intersects the box of half edge `radius` round
  /// `centre`, which is in the tree's frame; and perhaps with leaves close by.
  template <class Visit>
  void near(const Eigen::Vector3d& centre, double radius, const Visit& visit) const {
    Cells low{}, high{};
    if (!cells_within(centre, radius, low, high)) return;
    Cells c{};
    for (c[0] = low[0] >> level_; c[0] <= high[0] >> level_; ++c[0]) {
      for (c[1] = low[1] >> level_; c[1] <= high[1] >> level_; ++c[1]) {
        for (c[2] = low[2] >> level_; c[2] <= high[2] >> level_; ++c[2]) {
          const auto coarse = runs_.find(
              morton_encode({static_cast<std::uint32_t>(c[0]), static_cast<std::uint32_t>(c[1]),
                             static_cast<std::uint32_t>(c[2])}));
          if (coarse == runs_.end()) continue;
          for (std::uint32_t leaf = coarse->second;
               leaf < codes_.size() && codes_[leaf] >> 3 * level_ == coarse->first; ++leaf) {
            if (is_within(codes_[leaf], low, high)) visit(leaf);
          }
        }
      }
    }
  }

  /// The Morton codes of the leaves.
  [[nodiscard]] const std::vector<std::uint64_t>& codes() const noexcept { return codes_; }

 private:
  using Cells = std::array<std::int64_t, 3>;
  static bool is_within(std::uint64_t code, const Cells& low, const Cells& high) noexcept {
    const Cell cell = morton_decode(code);
    for (std::size_t i = 0; i < 3; ++i) {
      if (cell[i] < low[i] || cell[i] > high[i]) return false;
    }
    return true;
  }
  // Computes the range of cells that the box overlaps, and one more on each side; returns false if
  // it is empty.
  [[nodiscard]] bool cells_within(const Eigen::Vector3d& centre, double radius, Cells& low,
                                  Cells& high) const noexcept {
    const double last = static_cast<double>(lattice_.cells) - 1;
    for (std::size_t i = 0; i < 3; ++i) {
      const double c = centre[static_cast<Eigen::Index>(i)];
      const double first_cell =
          std::floor((c - radius) / lattice_.voxel_size + lattice_.root_centre()) - 1;
      const double last_cell =
          std::floor((c + radius) / lattice_.voxel_size + lattice_.root_centre()) + 1;
      if (!(last_cell >= 0 && first_cell <= last)) return false;
      low[i] = static_cast<std::int64_t>(std::max(first_cell, 0.0));
      high[i] = static_cast<std::int64_t>(std::min(last_cell, last));
    }
    return true;
  }

  const Lattice& lattice_;
  int level_ = 0;
  std::vector<std::uint64_t> codes_;
  std::unordered_map<std::uint64_t, std::uint32_t> runs_;  // first leaf by coarse cell
};

/// The separating axes of a cube of one body and a cube of the other, at one rotation.
class CubeAxes {
 public:
  /// The shrinking of a cube on each side, as a fraction of its edge.
  static constexpr double kShrink = 1e-6;

  /// Computes the axes for both edges, mesh units; `rotation` maps the second body's axes to the
  /// first's. The centres' distance is uncertain by `tolerance`, mesh units.
  CubeAxes(double first_edge, double second_edge, const Eigen::Matrix3d& rotation,
           double tolerance = 0);

  /// Returns whether two cubes surely intersect; `apart` is the vector from the first centre to the
  /// second, mesh units. Misses only pairs that a motion of 4e-6 of both edges, or of twice
  /// the tolerance, would separate.
  [[nodiscard]] bool surely_meet(const Eigen::Vector3d& apart) const noexcept;

 private:
  struct Axis {
    Eigen::Vector3d direction;
    double extent;  // sum of both cubes' half extents along `direction`
  };
  std::vector<Axis> axes_;
};

/// Returns the triangles of a leaf, clipped to its closed cube, in the tree's frame. Precondition:
/// tree.triangles(); `code` is the leaf's Morton code.
[[nodiscard]] std::vector<ClippedTriangle> leaf_polygons(const SphereTree& tree, std::uint32_t leaf,
                                                         std::uint64_t code);

/// Returns whether two convex polygons surely cross: a line in one would still pass through a
/// triangle of the other if each corner moved by `tolerance`. False for polygons that only touch or
/// are coplanar.
[[nodiscard]] bool surely_cross(const ClippedTriangle& a, const ClippedTriangle& b,
                                double tolerance) noexcept;

}  // namespace ist
