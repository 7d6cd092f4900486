#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ist/query/relative_pose.h"
#include "simd/front_step.h"

namespace ist {

struct alignas(64) FrontLine {
  std::byte bytes[64];
};

/// Leaf pairs that are kept from one pose to the next. No other pair overlaps while the motion
/// stays within the slack. A CoherentSearch has two fronts: one answers while the other is filled.
///
///              want                settle            take_up
///     kEmpty ---------> kAhead or --------> kReady ----------> kKept
///                       kAtOnce   --------> kFull
///                          |
///                          | forget             settle
///                          +-------> kForgotten ------> kEmpty
///
/// Each state but kForgotten may also become kEmpty at once: a front is dropped if the body went
/// another way, if it was full, or if it is used up. Only the caller's thread changes the state.
class Front {
 public:
  enum class State : std::uint8_t {
    kEmpty,      ///< it holds no pairs that count
    kAhead,      ///< a search fills it for a pose that is expected
    kAtOnce,     ///< a search fills it for the pose of the tick that wanted it
    kForgotten,  ///< the worker still fills it, but nobody wants it any more
    kReady,      ///< it is whole, and is taken up at the first pose within its slack
    kFull,       ///< it had no room for all pairs, or the search took too many tests
    kKept,       ///< it answers
  };

  /// Reserves all memory: 68 bytes each for `pairs`, and 56 for half as many rows.
  explicit Front(std::size_t pairs);
  Front(const Front&) = delete;
  Front& operator=(const Front&) = delete;

  State state = State::kEmpty;
  FrontLanes lanes{};
  RelativePose centre{};
  /// The front holds every pair of leaves whose bounds are no farther apart than this at `centre`,
  /// mesh units.
  double extent = 0;
  /// An upper bound of the distance between the surfaces at `centre`, mesh units. Infinite if it
  /// was not measured.
  double upper = 0;

  [[nodiscard]] bool empty() const noexcept { return lanes.pair_count == 0; }
  /// Returns the bytes that a front with room for `pairs` reserves.
  [[nodiscard]] static std::size_t bytes_for(std::size_t pairs) noexcept;

 private:
  std::vector<FrontLine> memory_;
};

/// The rows of a front at one pose.
class FrontRowMemory {
 public:
  /// Reserves 64 bytes for each row of a front with room for `pairs`.
  explicit FrontRowMemory(std::size_t pairs);

  [[nodiscard]] FrontRows& rows() noexcept { return rows_; }
  /// Returns the bytes that the rows of a front with room for `pairs` reserve.
  [[nodiscard]] static std::size_t bytes_for(std::size_t pairs) noexcept;

 private:
  std::vector<FrontLine> memory_;
  FrontRows rows_{};
};

}  // namespace ist
