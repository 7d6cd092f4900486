#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ist/query/relative_pose.h"
#include "simd/pair_cache_step.h"

namespace ist {

struct alignas(64) MemoryLine {
  std::byte bytes[64];
};

/// Leaf pairs that are kept from one pose to the next. No other pair overlaps while the motion
/// stays within the slack. A CachedSearch has two caches: one answers while the other is filled.
///
///              want                settle            take_up
///     kEmpty ---------> kAhead or --------> kReady ----------> kKept
///                       kAtOnce   --------> kFull
///                          |
///                          | forget             settle
///                          +-------> kForgotten ------> kEmpty
///
/// Each state but kForgotten may also become kEmpty at once: a cache is dropped if the body went
/// another way, if it was full, or if it is used up. Only the caller's thread changes the state.
class PairCache {
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
  explicit PairCache(std::size_t pairs);
  PairCache(const PairCache&) = delete;
  PairCache& operator=(const PairCache&) = delete;

  State state = State::kEmpty;
  CacheLanes lanes{};
  RelativePose centre{};
  /// The cache holds every pair of leaves whose bounds are no farther apart than this at `centre`,
  /// mesh units.
  double extent = 0;
  /// An upper bound of the distance between the surfaces at `centre`, mesh units. Infinite if it
  /// was not measured.
  double upper = 0;

  [[nodiscard]] bool empty() const noexcept { return lanes.pair_count == 0; }
  /// Returns the bytes that a cache with room for `pairs` reserves.
  [[nodiscard]] static std::size_t bytes_for(std::size_t pairs) noexcept;

 private:
  std::vector<MemoryLine> memory_;
};

/// The rows of a cache at one pose.
class CacheRowMemory {
 public:
  /// Reserves 64 bytes for each row of a cache with room for `pairs`.
  explicit CacheRowMemory(std::size_t pairs);

  [[nodiscard]] CacheRows& rows() noexcept { return rows_; }
  /// Returns the bytes that the rows of a cache with room for `pairs` reserve.
  [[nodiscard]] static std::size_t bytes_for(std::size_t pairs) noexcept;

 private:
  std::vector<MemoryLine> memory_;
  CacheRows rows_{};
};

}  // namespace ist
