#pragma once

#include "ist/sweep/pose_source.h"

namespace ist {

/// Random poses: a move from a box, and a turn. Pose i depends on the seed and on i alone.
///
/// Its random numbers are those of Philox(seed, i), in this order: three for the move; then those
/// of the turn. A uniform turn is drawn by rejection from two discs (G. Marsaglia, Choosing a point
/// from the surface of a sphere, Ann. Math. Stat. 43(2), 1972). A small one is Cayley's: its vector
/// w is drawn from a box, and its quaternion is 1 + w/2, divided by its length; it turns by
/// 2 atan(|w|/2) about w, which is |w| to a part of |w|²/12.
class PoseBox : public PoseSource {
 public:
  enum class Turns { kNone, kWithin, kAny };
  struct Settings {
    std::uint64_t seed = 0, count = 0;
    Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();  ///< mesh units
    Turns turns = Turns::kNone;
    Eigen::Vector3d within = Eigen::Vector3d::Zero();  ///< of w, degrees, to each side
    Eigen::Vector3d about = Eigen::Vector3d::Zero();   ///< the point that turns leave, fixed
  };

  explicit PoseBox(const Settings& settings) : settings_(settings) {}

  [[nodiscard]] std::uint64_t count() const override { return settings_.count; }
  void read(std::uint64_t first, std::span<Eigen::Isometry3d> poses) const override;
  [[nodiscard]] std::string identity() const override;

 private:
  [[nodiscard]] Eigen::Isometry3d pose(std::uint64_t index) const;

  Settings settings_;
};

}  // namespace ist
