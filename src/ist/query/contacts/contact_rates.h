#pragma once

#include "ist/query/contacts/contact_pair.h"

namespace ist {

/// How fast one leaf pair's part of ContactSums can change, at most, while the moving body moves:
/// each a constant by the way that is moved, |change| <= rate · motion. So a sum changes by at most
/// rate · motion · (pairs with a weight before + pairs with a weight after).
///
/// The motion from one pose to another, mesh units, is |how far the origin of the moving tree's
/// frame goes| + lever · |angle in radians|.
///
/// With w = A u b |e|, A the area, u the share of the balls, b the least share of the slabs and of
/// all ancestors' balls and slabs, and e the mean normal, for a motion m:
///  - no bound's centre, and no height over a slab, changes by over m, and e by over m / (2 lever);
///  - u = (ρ² - d²) / reach² changes by 2 ρ m / reach², ρ <= 1.02 reach and the growth; b by m /
///    width; both are at most 1: so A u b changes by g m, g = A (2 ρ / reach² + 1 / width);
///  - w, and w times the direction, which is A u b e: by (g + A / (2 lever)) m;
///  - with x = d + 2s, or what it is over the least depth, |e| x is the clamped e · (pf - pm) plus
///  2 s |e|: it changes by m + (P/2 + s)
///    m / lever, P <= 2.8 s the most that the surface points are apart, and the direction times it
///    by 3/2 s m / lever more; it is at most 3 s. So w x n changes by (3 s g + A (1 + 3.9 s /
///    lever)) m, and w x by no more: with it the sum of w x over contact points, whose depths are
///    means by weight;
///  - where the weight fades with the depth as well, by x / fade while that is below 1: |e| x /
///  fade
///    changes as |e| x does, so w by A (1 + c / lever) m / fade more; and x · min(1, x / fade)
///    has a slope of at most 2, so w x n changes by twice what is said above for x;
///  - a position by m / 2, and it is no farther than `far` from the fixed frame's origin: a torque
///    by far times its force's rate and half the greatest force.
struct ContactRates {
  double lever;  ///< mesh units; the radius, round the moving frame's origin, of all that counts
  double weight, pressure_force, pressure_torque, spring_force, spring_torque;

  ContactRates(const SphereTree& fixed, const SphereTree& moving,
               const ContactScale& scale) noexcept {
    const double s = scale.size;
    // A fixed ancestor's centre is no farther from a leaf of it than its own radius and the leaf's.
    lever = (fixed.reach() + moving.reach()) + (4 * s + scale.grow);
    const double far = fixed.reach() + (2.5 * s + scale.grow);
    const double touching = 1.02 * scale.reach + scale.grow;
    const double share =
        scale.area * (2 * touching / (scale.reach * scale.reach) + 1 / scale.width);
    const double depth = scale.area * (1 + (3.9 * s + 0.5 * scale.grow) / lever);
    weight = share + 0.5 * scale.area / lever + (scale.fade > 0 ? depth / scale.fade : 0);
    pressure_force = weight;
    pressure_torque = far * pressure_force + 0.5 * scale.area;
    spring_force = 3 * s * share + (scale.fade > 0 ? 2 : 1) * depth;
    spring_torque = far * spring_force + 1.5 * s * scale.area;
  }
};

/// How fast the depth of one leaf pair can change, at most, by the way moved: |change| <= rate ·
/// motion, where `mean_normal` is the least length |e| of the mean of the two normals on the way.
///
/// A body that does not turn changes it by no more than it moves. A turn by the angle α changes e
/// by α / 2, so its direction by α / (2 |e|), across at most 2.8 s and the growth between the
/// surface points. There is no rate for a contact point's depth alone, a mean over pairs that come
/// and go; that of w x bounds it by what the point weighs.
[[nodiscard]] inline double depth_rate(const ContactScale& scale, double lever,
                                       double mean_normal) noexcept {
  return 1 + (1.4 * scale.size + 0.5 * scale.grow) / (lever * mean_normal);
}

}  // namespace ist
