#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/measure/occlusion.h"

namespace ist::cli {

/// A place where two bodies touch. All outputs call it by one number.
///
/// Regions that face each other, directly or through others, are one contact: so a region that
/// faces two regions of the other body makes one contact with both. A region that faces none, and
/// that none faces, is a contact on one body alone.
struct BiteContact {
  std::vector<std::uint32_t> fixed, moving;  ///< its regions, by their indices
  /// The mean of both bodies; of the one body if the contact is on one alone.
  double area = 0, penetrating_area = 0, depth_integral = 0;
  double share = 0, share_thinner = 0, share_thicker = 0;  ///< likewise, 0 to 1
  double least_distance = 0;                               ///< signed, of all its regions
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();        ///< of the area of all its regions
  Eigen::Vector3d closest = Eigen::Vector3d::Zero();       ///< the point of the least distance

  [[nodiscard]] bool on_both() const { return !fixed.empty() && !moving.empty(); }
};

/// Returns the contacts in the order of their numbers, which begin at 1: those on both bodies, the
/// largest area first, then those on one body alone, the largest first.
[[nodiscard]] std::vector<BiteContact> contacts_of(std::span<const ContactRegion> fixed,
                                                   std::span<const ContactRegion> moving);

}  // namespace ist::cli
