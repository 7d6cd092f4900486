#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "ist/query/contacts/contact_leaf.h"

namespace ist {

/// What the numbers of a pair of leaves are measured in. The same whichever body is the fixed one.
struct ContactScale {
  double size;         ///< the mean of the two voxel sizes, mesh units: s
  double area;         ///< their product: no pair weighs more
  double reach;        ///< of two leaves' circumspheres: √3 s
  double width;        ///< overlap of two bounds over which a weight goes from 0 to what it is: s/2
  double least_depth;  ///< a contact's; the greatest is `size`
  double fade;         ///< depth over which a weight grows from 0 at the least; 0: at once
  double grow;         ///< how far apart bounds may be that touch

  /// The least depth and the growth in parts of s. From -2 on all leaf pairs are contacts; with a
  /// greater one only those that are deeper, and they begin with weight 0.
  ContactScale(const SphereTree& fixed, const SphereTree& moving, double least = -2,
               double growth = 0) noexcept
      : size(0.5 * (fixed.lattice().voxel_size + moving.lattice().voxel_size)),
        area(fixed.lattice().voxel_size * moving.lattice().voxel_size),
        reach(kSqrt3 * size),
        width(0.5 * size),
        least_depth(least * size),
        fade(least > -2 ? 0.25 * size : 0),
        grow(growth * size) {}
};

/// What one pair of leaves comes to, in the fixed tree's frame.
struct PairTerms {
  double weight;  ///< 0 where it is none; then nothing else need be known
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

/// The rest of a pair of leaves, both in the fixed tree's frame; its weight is in parts of what its
/// bounds and its ancestors' leave it.
///
/// The mean of the fixed normal and of the moving one turned round, each as long as it is coherent,
/// is the direction; its length is a part of the weight, so that a weight is 0 where the direction
/// is none. All is the same, but turned round, where the bodies are swapped.
[[nodiscard]] inline PairTerms pair_terms(const ContactLeaf& fixed, const ContactLeaf& moving,
                                          const ContactScale& scale) noexcept {
  const Eigen::Vector3d mean = scaled(0.5, difference(fixed.normal, moving.normal));
  const double length = std::sqrt(dot_in_order(mean, mean));
  PairTerms terms{0, 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  if (!(length > 0)) return terms;
  terms.normal = scaled(1 / length, mean);
  const double depth = dot_in_order(terms.normal, difference(fixed.point, moving.point));
  terms.depth = std::clamp(depth, scale.least_depth, scale.size);
  terms.weight = length;
  if (scale.fade > 0) {
    terms.weight *= std::min(1.0, (terms.depth - scale.least_depth) / scale.fade);
  }
  terms.position = scaled(0.5, sum(fixed.point, moving.point));
  return terms;
}

}  // namespace ist
