#include "ist/query/coherent/front_schedule.h"

#include <algorithm>

namespace ist {
namespace {

// The slack of a front, in voxels: at rest, at most, and of one that is made within a tick.
constexpr double kLeastSlack = 0.05, kMostSlack = 0.4, kSlackAtOnce = 0.1;
// The ticks for which a slack should last: of directed motion, and of trembling.
constexpr double kTicksOfSlack = 20, kTicksOfTrembling = 4;
// A front that would last for fewer ticks is not worth its search: by the query's own thread, and
// by the resident worker.
constexpr double kFewestTicks = 8, kFewestTicksHelped = 4;
// A front is wasteful that has so much more slack than is wanted, and so many more pairs than
// overlap.
constexpr double kTooWide = 1.9, kTooMany = 1.25;
// The part of the ticks to a front's centre by which the next one is begun ahead, for a hand that
// moves evenly may yet make a step that is five times the others; and the part of the slack of a
// body whose motion has no direction.
constexpr double kPartAhead = 0.4, kReserve = 0.25;
// The part of the fewest ticks ahead that slices are made for, and the part of a search that is
// added to a tick that searches.
constexpr double kPartOfTicks = 0.6, kPartOfSearch = 0.2;
constexpr double kLeastSlice = 2000;  // tests
// The factors by which the next slack is wider after a front that had room, or after a fresh
// search, and narrower after one that had not.
constexpr double kWider = 1.25, kWiderFresh = 1.02, kNarrower = 0.5;
// The ticks without a front after one that was full: twice as many each time, up to this.
constexpr std::uint32_t kLongestPause = 255;
// The factors by which the next clearance asks for more after one came true, and for less after one
// did not; the part of a known distance that it asks for at most; and the most tests that it makes.
constexpr double kClearer = 2, kLessClear = 0.25, kClearPart = 0.8;
constexpr std::uint64_t kClearTests = 2, kSpareTests = 10'000;

}  // namespace

FrontSchedule::FrontSchedule(double voxel_size, bool helped) noexcept
    : voxel_size_(voxel_size),
      fewest_ticks_(helped ? kFewestTicksHelped : kFewestTicks),
      widest_(kMostSlack * voxel_size),
      clearance_(kMostSlack * voxel_size) {}

void FrontSchedule::forget() noexcept {
  widest_ = clearance_ = kMostSlack * voxel_size_;
  pause_ = wait_ = 0;
}

double FrontSchedule::slack(const Pace& pace) const noexcept {
  const double wanted = std::max(kTicksOfSlack * pace.drift, kTicksOfTrembling * pace.speed);
  return std::min(std::clamp(wanted, kLeastSlack * voxel_size_, kMostSlack * voxel_size_), widest_);
}

double FrontSchedule::slack_at_once() const noexcept {
  return std::min(kSlackAtOnce * voxel_size_, widest_);
}

double FrontSchedule::clearance(double known, double need) const noexcept {
  return std::min(clearance_, kClearPart * known - need);
}

bool FrontSchedule::is_wasteful(double slack, double wanted, std::size_t pairs,
                                std::uint64_t overlapping) noexcept {
  return slack > kTooWide * wanted && overlapping > 0 &&
         static_cast<double>(pairs) > kTooMany * static_cast<double>(overlapping);
}

double FrontSchedule::ticks_to_centre(double slack, const Pace& pace) noexcept {
  return pace.is_directed() ? std::min(slack / pace.drift, kTicksOfSlack) : 0;
}

double FrontSchedule::ticks_ahead(double slack, const Pace& pace) noexcept {
  if (!pace.is_directed()) return 0;
  return pace.is_steady() ? std::max(kTicksAhead, kPartAhead * ticks_to_centre(slack, pace))
                          : kTicksAhead;
}

double FrontSchedule::reserve(double slack, const Pace& pace) noexcept {
  return pace.is_directed() ? 0 : kReserve * slack;
}

std::uint64_t FrontSchedule::slice(std::uint64_t whole, bool searched) noexcept {
  const double part = searched ? kPartOfSearch : 1 / (kPartOfTicks * kTicksAhead);
  return static_cast<std::uint64_t>(std::max(kLeastSlice, part * static_cast<double>(whole)));
}

std::uint64_t FrontSchedule::most_for_clearance(std::uint64_t whole) noexcept {
  return kClearTests * whole + kSpareTests;
}

void FrontSchedule::searched() noexcept { ask_for(kWiderFresh); }

void FrontSchedule::took_up(bool empty, double clear) noexcept {
  ask_for(kWider);
  pause_ = 0;
  if (empty) clearance_ = kClearer * clear;
}

void FrontSchedule::was_full(bool clearance) noexcept {
  if (clearance) {
    clearance_ *= kLessClear;
  } else {
    ask_for(kNarrower);
  }
  wait_ = pause_ = std::min(2 * pause_ + 1, kLongestPause);
}

void FrontSchedule::ask_for(double factor) noexcept {
  widest_ = std::min(factor * widest_, kMostSlack * voxel_size_);
}

}  // namespace ist
