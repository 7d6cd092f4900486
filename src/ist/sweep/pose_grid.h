#pragma once

#include <vector>

#include "ist/sweep/pose_source.h"

namespace ist {

/// Poses on a grid: a motion along or about each axis, in the order of the axes, the first one's
/// last. Pose numbers go by the last axis fastest, as the indices of an array of C do.
class PoseGrid : public PoseSource {
 public:
  struct Axis {
    bool turns = false;
    Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< of any length but 0
    Eigen::Vector3d about = Eigen::Vector3d::Zero();       ///< a point of a turn's axis
    double from = 0, to = 0;                               ///< mesh units, or degrees
    std::uint64_t count = 1;                               ///< values, `from` and `to` among them
  };

  /// Precondition: at least one axis; the product of the counts is less than 2^63.
  explicit PoseGrid(std::vector<Axis> axes);

  [[nodiscard]] std::uint64_t count() const override { return count_; }
  void read(std::uint64_t first, std::span<Eigen::Isometry3d> poses) const override;
  [[nodiscard]] std::string identity() const override;

  /// Returns value `step` of an axis: the last is `to` itself.
  [[nodiscard]] static double value_of(const Axis& axis, std::uint64_t step) noexcept;

 private:
  [[nodiscard]] Eigen::Isometry3d pose(std::uint64_t index) const;

  std::vector<Axis> axes_;  // directions of unit length
  std::uint64_t count_ = 1;
};

}  // namespace ist
