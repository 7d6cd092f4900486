#pragma once

#include <array>
#include <cstddef>

#include "ist/query/coherent/motion_bound.h"
#include "ist/query/relative_pose.h"

namespace ist {

/// How fast a body moves, mesh units a tick, bounds of the motion of its leaves.
struct Pace {
  double speed;  ///< of the last tick, or of the mean of the last few, whichever is more
  double drift;  ///< of the mean of the last few; less where the body trembles

  [[nodiscard]] bool is_directed() const noexcept { return 2 * drift >= speed && drift > 0; }
};

/// The last few poses of a moving body, from which the next ones are foreseen.
class PoseTrack {
 public:
  /// The poses that a motion is taken over.
  static constexpr std::size_t kTicks = 4;

  void add(const RelativePose& pose) noexcept;

  /// Returns a bound of the motion of a tick, mesh units: of the last one, or of the mean of the
  /// last kTicks, whichever is more; infinite without two poses.
  [[nodiscard]] double speed(const MotionBound& bound, double reach) const noexcept;
  /// Returns the motion of a tick in the mean of the last kTicks, mesh units: 0 where the body only
  /// trembles.
  [[nodiscard]] double drift(const MotionBound& bound, double reach) const noexcept;
  [[nodiscard]] Pace pace(const MotionBound& bound, double reach) const noexcept {
    return {speed(bound, reach), drift(bound, reach)};
  }
  /// Returns the pose to which the mean motion leads in `ticks`; the last pose where they are 0.
  [[nodiscard]] RelativePose ahead(double ticks) const noexcept;

 private:
  // The poses before the last one.
  [[nodiscard]] std::size_t past() const noexcept { return count_ > 0 ? count_ - 1 : 0; }
  [[nodiscard]] const RelativePose& back(std::size_t ticks) const noexcept {
    return poses_[(next_ + kSize - 1 - ticks) % kSize];
  }

  static constexpr std::size_t kSize = kTicks + 1;
  std::array<RelativePose, kSize> poses_;
  std::size_t next_ = 0, count_ = 0;
};

}  // namespace ist
