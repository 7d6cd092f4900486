#pragma once

#include <cstddef>
#include <cstdint>

#include "ist/query/coherent/pose_track.h"

namespace ist {

/// Decides when a front is worth its search and how wide it is to be. No answer hangs on it.
///
/// A front lasts while motion stays within its slack. One that is centred where the body goes lasts
/// for twice its slack; one that has more slack has more pairs to test, and its search takes longer
/// (perf/NOTES.md, A front kept).
class FrontSchedule {
 public:
  /// The ticks before a front is used up in which the next one is made, at least, where the body
  /// goes one way.
  static constexpr double kTicksAhead = 4;

  /// @param voxel_size the lesser of two voxel sizes, mesh units
  /// @param helped     the resident worker searches
  FrontSchedule(double voxel_size, bool helped) noexcept;

  /// Returns the slack that the next front is to have, mesh units.
  [[nodiscard]] double slack(const Pace& pace) const noexcept;
  /// Returns the slack of a front that is made within a tick.
  [[nodiscard]] double slack_at_once() const noexcept;
  /// Returns how far beyond what is needed to look where there are no pairs, mesh units, if leaves
  /// are known to be no farther apart than `known`.
  [[nodiscard]] double clearance(double known, double need) const noexcept;

  /// Returns whether a front with that slack lasts long enough: one that is centred ahead, or one
  /// that is made within a tick.
  [[nodiscard]] bool is_worth(double slack, double speed) const noexcept {
    return fewest_ticks_ * speed <= 2 * slack;
  }
  [[nodiscard]] bool is_worth_at_once(double slack, double speed) const noexcept {
    return fewest_ticks_ * speed <= slack;
  }
  /// Returns whether a front has far more slack than is wanted, and far more pairs than overlap.
  [[nodiscard]] static bool is_wasteful(double slack, double wanted, std::size_t pairs,
                                        std::uint64_t overlapping) noexcept;
  /// Returns whether a front is to be tried: that many pairs overlap, and it has so much room.
  [[nodiscard]] bool may_fit(std::uint64_t overlapping, std::size_t room) const noexcept {
    return wait_ == 0 && overlapping + overlapping / 8 < room;
  }
  /// Returns how many ticks ahead a front with that slack is to be centred.
  [[nodiscard]] static double ticks_to_centre(double slack, const Pace& pace) noexcept;
  /// Returns how many ticks before it is used up a front is followed by one with that slack.
  [[nodiscard]] static double ticks_ahead(double slack, const Pace& pace) noexcept;
  /// Returns how much of its slack a front has left where it is followed by the next one, if
  /// nothing tells where the body goes: a device may tell places in steps.
  [[nodiscard]] static double reserve(double slack, const Pace& pace) noexcept;
  /// Returns the tests to make in a tick for a front, of a search that makes `whole` in all.
  [[nodiscard]] static std::uint64_t slice(std::uint64_t whole, bool searched) noexcept;
  /// Returns the most tests that the search for a clearance is allowed.
  [[nodiscard]] static std::uint64_t most_for_clearance(std::uint64_t whole) noexcept;

  /// To be told of a fresh search that answered; of a front that was taken up, and was empty as far
  /// as `clear` beyond what was needed, or not; and of one that was full, or of a clearance that
  /// took too many tests.
  void searched() noexcept;
  void took_up(bool empty, double clear) noexcept;
  void was_full(bool clearance) noexcept;
  /// Begins afresh.
  void forget() noexcept;
  /// To be called once in each tick that has a complete answer.
  void tick() noexcept { wait_ -= wait_ > 0 ? 1 : 0; }

 private:
  void ask_for(double factor) noexcept;

  double voxel_size_, fewest_ticks_;
  double widest_;                       // slack that memory allows
  double clearance_;                    // to ask for where there are no pairs
  std::uint32_t pause_ = 0, wait_ = 0;  // ticks without a front, after a full one; those left
};

}  // namespace ist
