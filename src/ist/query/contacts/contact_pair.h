#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "ist/query/contacts/contact_leaf.h"
#include "ist/tree/tree_parts.h"

namespace ist {

/// The units and ranges of a leaf pair's numbers; the same whichever body is the fixed one.
struct ContactScale {
  double size;         ///< the mean of the two voxel sizes, mesh units: s
  double area;         ///< the product of the two sizes, mesh units²: the greatest weight
  double radius_sum;   ///< of two leaves' circumspheres, mesh units: √3 s
  double width;        ///< overlap of two bounds over which a weight fades in, mesh units: s/2
  double least_depth;  ///< least depth of a leaf pair, mesh units; the greatest is `size`
  double fade;         ///< depth above the least over which a weight fades in; 0: at once
  double margin;       ///< greatest distance at which bounds count as overlapping, mesh units

  /// Takes the least depth and the margin in parts of s. With a least depth of -2 every leaf pair
  /// counts; with a greater one only deeper pairs, and their weight begins at 0.
  ContactScale(const SphereTree& fixed, const SphereTree& moving, double least = -2,
               double margin_sizes = 0) noexcept
      : size(0.5 * (fixed.voxel_size() + moving.voxel_size())),
        area(fixed.voxel_size() * moving.voxel_size()),
        radius_sum(kSqrt3 * size),
        width(0.5 * size),
        least_depth(least * size),
        fade(least > -2 ? 0.25 * size : 0),
        margin(margin_sizes * size) {}
};

/// The terms of one leaf pair in ContactSums, in the fixed tree's frame, mesh units.
struct PairTerms {
  double weight;  ///< 0 where the pair does not count; then the others are undefined
  double depth;
  Eigen::Vector3d position, normal;
};

/// Returns the factor of a weight, 0 … 1, that comes from the overlap of two leaves' balls.
[[nodiscard]] inline double ball_weight(const NodeBound& a, const NodeBound& b,
                                        const ContactScale& scale) noexcept {
  const Eigen::Vector3d between = difference(b.centre, a.centre);
  const double radii = a.radius + b.radius;
  const double left = radii * radii - dot_in_order(between, between);
  return std::clamp(left / (scale.radius_sum * scale.radius_sum), 0.0, 1.0);
}

/// Computes the terms of a leaf pair, both leaves in the fixed tree's frame. The weight lacks the
/// factors of the bounds, of the ancestors and of the area.
///
/// The direction is the mean of the fixed normal and of the reversed moving normal, each as long as
/// it is coherent. The length of that mean is a factor of the weight, so the weight is 0 where
/// normals cancel. Swapping the bodies reverses the direction and changes nothing else.
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
