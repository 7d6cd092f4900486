#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "ist/query/contacts/contact_leaf.h"

namespace ist {

/// What the numbers of a pair of leaves are measured in. The same whichever body is the fixed one.
struct ContactScale {
  double size;   ///< the mean of the two voxel sizes, mesh units: s
  double area;   ///< their product: no pair weighs more
  double reach;  ///< of two leaves' circumspheres: √3 s
  double width;  ///< overlap of two bounds over which a weight goes from 0 to what it is: s/2

  ContactScale(const SphereTree& fixed, const SphereTree& moving) noexcept
      : size(0.5 * (fixed.lattice().voxel_size + moving.lattice().voxel_size)),
        area(fixed.lattice().voxel_size * moving.lattice().voxel_size),
        reach(kSqrt3 * size),
        width(0.5 * size) {}

  /// A contact's least depth; the greatest is `size`.
  [[nodiscard]] double least_depth() const noexcept { return -2 * size; }
};

/// What one pair of leaves comes to, in the fixed tree's frame.
struct PairTerms {
  double weight;  ///< 0 where it is none; then nothing else is known
  double depth;
  Eigen::Vector3d position, normal;
};

/// The part of a weight that says how far two leaves' balls overlap, 0 … 1.
[[nodiscard]] inline double ball_share(const NodeBound& a, const NodeBound& b,
                                       const ContactScale& scale) noexcept {
  const Eigen::Vector3d between = difference(b.centre, a.centre);
  const double touching = a.radius + b.radius;
  const double left = touching * touching - dot_in_order(between, between);
  return std::clamp(left / (scale.reach * scale.reach), 0.0, 1.0);
}

/// The rest of a pair of leaves, both in the fixed tree's frame, from `share`, the part of its
/// greatest weight that its bounds and its ancestors' leave it.
///
/// The mean of the fixed normal and of the moving one turned round, each as long as it is coherent,
/// is the direction; its length is a part of the weight, so that a weight is 0 where the direction
/// is none. All is the same, but turned round, where the bodies are swapped.
[[nodiscard]] inline PairTerms pair_terms(const ContactLeaf& fixed, const ContactLeaf& moving,
                                          double share, const ContactScale& scale) noexcept {
  const Eigen::Vector3d mean = scaled(0.5, difference(fixed.normal, moving.normal));
  const double length = std::sqrt(dot_in_order(mean, mean));
  PairTerms terms{0, 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  if (!(length > 0)) return terms;
  terms.weight = (scale.area * share) * length;
  terms.normal = scaled(1 / length, mean);
  terms.depth = std::clamp(dot_in_order(terms.normal, difference(fixed.point, moving.point)),
                           scale.least_depth(), scale.size);
  terms.position = scaled(0.5, sum(fixed.point, moving.point));
  return terms;
}

}  // namespace ist
