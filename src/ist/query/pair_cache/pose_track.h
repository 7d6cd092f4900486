#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "ist/query/pair_cache/motion_bound.h"
#include "ist/query/relative_pose.h"

namespace ist {

/// How fast a body moves, mesh units a tick, bounds of the motion of its leaves.
struct Pace {
  double speed;   ///< of the fastest of the last few ticks
  double drift;   ///< of the mean of the last few; less where the body trembles
  double course;  ///< of the mean of the last many; less where the body has turned round

  [[nodiscard]] bool is_directed() const noexcept { return 2 * drift >= speed && drift > 0; }
  [[nodiscard]] bool is_steady() const noexcept { return 2 * course >= speed && is_directed(); }
};

/// The last few poses of a moving body, from which the next ones are foreseen.
class PoseTrack {
 public:
  /// The poses that a motion is taken over.
  static constexpr std::size_t kTicks = 4, kManyTicks = 16;

  /// Adds the pose of a tick, and the motion from the last one.
  void add(const RelativePose& pose, const MotionBound& bound, double reach) noexcept;

  /// Returns a bound of the motion of a tick, mesh units: the most of the last kTicks; infinite
  /// without two poses.
  [[nodiscard]] double speed() const noexcept;
  /// Returns the motion of a tick in the mean of the last kTicks, mesh units: 0 where the body only
  /// trembles.
  [[nodiscard]] double drift(const MotionBound& bound, double reach) const noexcept {
    return mean(bound, reach, kTicks);
  }
  [[nodiscard]] Pace pace(const MotionBound& bound, double reach) const noexcept {
    return {speed(), drift(bound, reach), mean(bound, reach, kManyTicks)};
  }
  /// Returns the pose to which the mean motion leads in `ticks`; the last pose where they are 0.
  [[nodiscard]] RelativePose ahead(double ticks) const noexcept;

 private:
  [[nodiscard]] double mean(const MotionBound& bound, double reach,
                            std::size_t ticks) const noexcept;
  // As many ticks back as there are poses, but no more than that.
  [[nodiscard]] std::size_t past(std::size_t ticks) const noexcept {
    return std::min(ticks, count_ > 0 ? count_ - 1 : 0);
  }
  [[nodiscard]] std::size_t place(std::size_t ticks_back) const noexcept {
    return (next_ + kSize - 1 - ticks_back) % kSize;
  }
  [[nodiscard]] const RelativePose& back(std::size_t ticks) const noexcept {
    return poses_[place(ticks)];
  }

  static constexpr std::size_t kSize = kManyTicks + 1;
  std::array<RelativePose, kSize> poses_;
  std::array<double, kSize> steps_{};  // the motion to each pose
  std::size_t next_ = 0, count_ = 0;
};

}  // namespace ist
