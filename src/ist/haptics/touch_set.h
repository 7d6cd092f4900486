#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "ist/haptics/placement.h"

namespace ist {

/// A place where the tool is touched, as effects see it: metres, axes of the scene.
struct TouchPoint {
  Eigen::Vector3d arm;     ///< from the tool's origin
  Eigen::Vector3d normal;  ///< unit, from the fixed body to the tool
  double overlap;          ///< at least 0: how deep, beyond where contacts begin
  /// Part of a contact's stiffness that the point has. A point of one whole leaf pair has 1; where
  /// there are more than 10 such pairs in all, they share what 10 would have, so that a broad
  /// contact is no stiffer than the loop can bear (McNeely et al. 1999, section 4.4).
  double share;

  /// How far the place moves, for a small motion of the tool, metres.
  [[nodiscard]] Eigen::Vector3d moved(const Vector6& motion) const noexcept {
    return motion.head<3>() + motion.tail<3>().cross(arm);
  }
};

/// All that touches the tool at one pose.
class TouchSet {
 public:
  static constexpr std::size_t kMost = 32;

  /// Sum over all leaf pairs, none merged, of share · overlap · normal and its torque: the wrench
  /// of a contact with a stiffness of 1 N/m.
  Vector6 spring = Vector6::Zero();
  /// Leaf pairs by their weight, before any sharing.
  double count = 0;

  [[nodiscard]] std::span<const TouchPoint> points() const noexcept {
    return {points_.data(), size_};
  }
  void clear() noexcept {
    spring.setZero();
    count = 0;
    size_ = 0;
  }
  /// Precondition: fewer than kMost points.
  void add(const TouchPoint& point) noexcept { points_[size_++] = point; }

 private:
  std::array<TouchPoint, kMost> points_;
  std::size_t size_ = 0;
};

}  // namespace ist
