#pragma once

#include <cstddef>
#include <cstdint>

#include "ist/query/pair_cache/pose_track.h"

namespace ist {

/// Decides when a cache is worth its search, and how wide it is. No answer depends on it.
///
/// A cache lasts while the motion stays within its slack. If its centre lies ahead of the body, it
/// lasts for twice its slack. A wider cache has more pairs to test, and its search takes longer
/// (perf/NOTES.md, The pair cache).
class CacheSchedule {
 public:
  /// The next cache is made at least this many ticks before the last one is used up, if the body
  /// goes one way.
  static constexpr double kTicksAhead = 4;

  /// @param voxel_size the smaller of two voxel sizes, mesh units
  /// @param helped     whether the resident worker searches
  CacheSchedule(double voxel_size, bool helped) noexcept;

  /// Returns the slack for the next cache, mesh units.
  [[nodiscard]] double slack(const Pace& pace) const noexcept;
  /// Returns the slack for a cache that is made within a tick, mesh units.
  [[nodiscard]] double slack_at_once() const noexcept;
  /// Returns how far beyond `need` to search if there are no pairs, mesh units. Leaves are known to
  /// be `known` apart.
  [[nodiscard]] double clearance(double known, double need) const noexcept;

  /// Returns whether a cache with this slack lasts long enough if it is centred ahead.
  [[nodiscard]] bool is_worth(double slack, double speed) const noexcept {
    return fewest_ticks_ * speed <= 2 * slack;
  }
  /// Returns whether a cache with this slack lasts long enough if it is made within a tick.
  [[nodiscard]] bool is_worth_at_once(double slack, double speed) const noexcept {
    return fewest_ticks_ * speed <= slack;
  }
  /// Returns whether a cache has much more slack than wanted, and many more pairs than overlap.
  [[nodiscard]] static bool is_wasteful(double slack, double wanted, std::size_t pairs,
                                        std::uint64_t overlapping) noexcept;
  /// Returns whether to try a cache with room for `room` pairs, if `overlapping` pairs overlap. It
  /// returns false during the pause after a cache that had no room.
  [[nodiscard]] bool may_fit(std::uint64_t overlapping, std::size_t room) const noexcept {
    return wait_ == 0 && overlapping + overlapping / 8 < room;
  }
  /// Returns how many ticks ahead the centre of a cache with this slack should lie.
  [[nodiscard]] static double ticks_to_centre(double slack, const Pace& pace) noexcept;
  /// Returns how many ticks before the last cache is used up the next one, with this slack, is
  /// begun.
  [[nodiscard]] static double ticks_ahead(double slack, const Pace& pace) noexcept;
  /// Returns the slack at which the next cache is begun if the motion has no direction, mesh units;
  /// 0 if it has one.
  [[nodiscard]] static double reserve(double slack, const Pace& pace) noexcept;
  /// Returns the tests that a tick may spend on the next cache. Its search takes about `whole`
  /// tests. `searched` says that the tick has made a search already.
  [[nodiscard]] static std::uint64_t slice(std::uint64_t whole, bool searched) noexcept;
  /// Returns the most tests of the search for a clearance. The last search made `whole` tests.
  [[nodiscard]] static std::uint64_t most_for_clearance(std::uint64_t whole) noexcept;

  /// Call after a fresh search that answered.
  void searched() noexcept;
  /// Call when a cache is taken up. `clear` is its extent beyond the need, if it is empty.
  void took_up(bool empty, double clear) noexcept;
  /// Call when a cache had no room, or when the search for a clearance took too many tests.
  void was_full(bool clearance) noexcept;
  /// Begins afresh.
  void forget() noexcept;
  /// Call once in each tick that has a complete answer.
  void tick() noexcept { wait_ -= wait_ > 0 ? 1 : 0; }

 private:
  void ask_for(double factor) noexcept;

  double voxel_size_, fewest_ticks_;
  double widest_;            // the slack that memory allows
  double clearance_;         // the next one to search for
  std::uint32_t pause_ = 0;  // ticks without a cache after a full one
  std::uint32_t wait_ = 0;   // ticks of that pause that are left
};

}  // namespace ist
