#pragma once

#include "ist/tree/sphere_tree.h"
#include "simd/contact_step.h"
#include "simd/lanes.h"

namespace ist {

/// The units and ranges of a leaf pair's numbers; the same whichever body is the fixed one.
struct ContactScale {
  double size;        ///< the mean of the two voxel sizes, mesh units: s
  double area;        ///< the product of the two sizes, mesh units²: the greatest weight
  double radius_sum;  ///< of two leaves' circumspheres, mesh units: √3 s
  double width;       ///< overlap of two bounds over which a weight fades in, mesh units: s/2
  double margin;      ///< distance at which springs begin, mesh units
  double fade;        ///< depth above the least over which a weight fades in; 0: at once
  double reach;       ///< greatest distance at which bounds count as overlapping, mesh units

  /// Takes the margin and the reach of ManifoldOptions. With a margin of 2 every leaf pair counts;
  /// with a smaller one only pairs that are near enough, and their weight begins at 0.
  ContactScale(const SphereTree& fixed, const SphereTree& moving, double margin_sizes = 0,
               double reach_sizes = 0) noexcept
      : size(0.5 * (fixed.voxel_size() + moving.voxel_size())),
        area(fixed.voxel_size() * moving.voxel_size()),
        radius_sum(kSqrt3 * size),
        width(0.5 * size),
        margin(margin_sizes * size),
        fade(margin_sizes < 2 ? 0.25 * size : 0),
        reach(reach_sizes * size) {}

  /// The least depth of a leaf pair, mesh units; the greatest is `size`.
  [[nodiscard]] double least_depth() const noexcept { return 0 - margin; }
};

/// Returns the rule by which kernels weigh leaf pairs; `lever`, mesh units, is no less than the
/// distance of any contact from the origin of the moving tree's frame.
[[nodiscard]] inline ContactRule contact_rule(const ContactScale& scale, double lever) noexcept {
  const double range = scale.size - scale.least_depth();
  const auto narrow = [](double x) { return static_cast<float>(x); };
  return {.per_ball = narrow(1 / (scale.radius_sum * scale.radius_sum)),
          .per_slab = narrow(1 / scale.width),
          .per_scaled_slab = narrow(1 / scale.width) / kSlabScale,
          .least = narrow(scale.least_depth()),
          .range = narrow(range),
          .per_range = narrow(1 / range),
          .fade_from = scale.fade > 0 ? 0.0F : 1.0F,
          .per_fade = scale.fade > 0 ? narrow(1 / scale.fade) : 0.0F,
          .half_per_lever = narrow(0.5 / lever)};
}

}  // namespace ist
