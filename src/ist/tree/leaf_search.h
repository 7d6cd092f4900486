#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "ist/tree/bound_blocks.h"
#include "ist/tree/bounds.h"
#include "ist/tree/linear_octree.h"

namespace ist {

/// A bound inflated by a partner radius: the points x with |x - c| <= radius + partner radius and
/// |n · (x - c) - offset| <= half + partner radius, which hold the centre of any such partner.
class InflatedBound {
 public:
  InflatedBound() = default;
  InflatedBound(const Ball& ball, const Slab& slab, double partner_radius) noexcept;

  /// Returns the greatest value of `normal` · (x - from). `length` is the normal's. Exact to a few
  /// roundings, for parallel normals too, because products of packed normals are exact.
  [[nodiscard]] double support(const Eigen::Vector3d& normal, double length,
                               const Eigen::Vector3d& from) const noexcept;
  /// Returns a point at which that value is reached.
  [[nodiscard]] Eigen::Vector3d support_point(const Eigen::Vector3d& normal,
                                              double length) const noexcept;

 private:
  // The disc in which a face of the slab cuts the ball, times the normal's length.
  struct Cut {
    double height = std::numeric_limits<double>::infinity();  // of a face beyond the ball
    double radius2 = 0;                                       // square of the radius
  };
  [[nodiscard]] Cut cut(double height) const noexcept;

  Eigen::Vector3d centre_, normal_;
  double radius_ = 0, square_ = 0, inverse_ = 0;  // square_ is the normal's, 1 / inverse_
  Cut above_, below_;
};

/// The leaf with the greatest value.
template <typename Bound>
struct Greatest {
  double value = -std::numeric_limits<double>::infinity();
  Bound bound;
};

/// Searches the leaves below a node by branch and bound: down the bounds of the levels between,
/// which are nested. Lattice units, from the root cube's centre. One object belongs to one thread.
class LeafSearch {
 public:
  /// Both must outlive the search. The levels below `level` must be fitted.
  LeafSearch(const LinearOctree& octree, const BoundBlocks& bounds, int level) noexcept
      : octree_(octree), bounds_(bounds), level_(level) {}

  /// Begins with a node at the level.
  void set_node(std::uint32_t node) noexcept;

  /// Returns the bounds of a child.
  [[nodiscard]] Ball child_ball(int slot) const noexcept { return saved_ball(level_, node_, slot); }
  [[nodiscard]] Slab child_slab(int slot) const noexcept { return saved_slab(level_, node_, slot); }

  /// Returns the leaf ball that extends farthest from a point, and how far.
  [[nodiscard]] Greatest<Ball> farthest(const Eigen::Vector3d& from) const noexcept;

  /// Raises `greatest` to the leaf that extends farthest along a normal with kPartnerRadius, from a
  /// point, less the partner radius times the normal's length: no smaller partner radius extends
  /// farther than that. `length` is the normal's.
  void raise_support(const Eigen::Vector3d& normal, double length, const Eigen::Vector3d& from,
                     Greatest<InflatedBound>& greatest) const noexcept;

 private:
  [[nodiscard]] Ball saved_ball(int level, std::uint32_t node, int slot) const noexcept;
  [[nodiscard]] Slab saved_slab(int level, std::uint32_t node, int slot) const noexcept;
  void read(int level, std::uint32_t node, Ball (&children)[8]) const noexcept;
  void read(int level, std::uint32_t node, InflatedBound (&children)[8]) const noexcept;
  template <typename Bound, typename Value>
  void raise(int level, std::uint32_t node, const Bound (&children)[8], const Value& value,
             Greatest<Bound>& greatest) const noexcept;

  const LinearOctree& octree_;
  const BoundBlocks& bounds_;
  int level_;
  std::uint32_t node_ = 0;
  Ball balls_[8];  // the node's children
  InflatedBound reached_[8];
};

/// Returns the value of a leaf in LeafSearch::raise_support(). `length` is the normal's.
[[nodiscard]] double height_of(const InflatedBound& bound, const Eigen::Vector3d& normal,
                               double length, const Eigen::Vector3d& from) noexcept;

/// The normal of a packed slab, exact.
[[nodiscard]] Eigen::Vector3d normal_of(const PackedSlab& slab) noexcept;

}  // namespace ist
