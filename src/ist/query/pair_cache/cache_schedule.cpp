#include "ist/query/pair_cache/cache_schedule.h"

#include <algorithm>

namespace ist {
namespace {

// The slack of a cache for a body at rest, voxels. A thinner cache would not outlast any tremble.
constexpr double kLeastSlack = 0.05;
// The largest slack of a cache, voxels. A wider cache has more pairs to test in each tick.
constexpr double kMostSlack = 0.4;
// The slack of a cache that is made within a tick, voxels. Its search delays the answer of that
// tick, so it is kept small.
constexpr double kSlackAtOnce = 0.1;

// A slack should last for this many ticks of motion in one direction.
constexpr double kTicksOfSlack = 20;
// A slack should last for this many ticks as fast as the fastest one of late: the body may tremble.
constexpr double kTicksOfTrembling = 4;

// A cache must last for this many ticks to be worth its search, if the query's own thread makes it.
constexpr double kFewestTicks = 8;
// The same if the resident worker makes it: then no tick waits for the search.
constexpr double kFewestTicksHelped = 4;

// A cache is wasteful only if its slack exceeds the wanted one by this factor.
constexpr double kTooWide = 1.9;
// And only if its pairs outnumber the overlapping ones by this factor. Else a new one saves little.
constexpr double kTooMany = 1.25;

// The next cache is begun ahead by this part of the ticks to its centre. Even a steady hand makes
// single steps that are five times the mean.
constexpr double kPartAhead = 0.4;
// The next cache is begun with this part of the slack left if the motion has no direction: a device
// may report places in steps, and one step must not lead out of the cache.
constexpr double kReserve = 0.25;

// Slices are made so large that a cache is whole after this part of the fewest ticks ahead. The
// rest is in reserve for ticks without time.
constexpr double kPartOfTicks = 0.6;
// A tick that has made a search adds at most this part of it for the next cache, so that no tick
// takes much longer than its search.
constexpr double kPartOfSearch = 0.2;
// The smallest slice, tests. Smaller ones would cost more in overhead than in tests.
constexpr double kLeastSlice = 2000;

// The widest slack grows by this factor after a cache that had room.
constexpr double kWider = 1.25;
// It grows by this factor after a fresh search: slowly, because nothing shows that a cache has
// room.
constexpr double kWiderFresh = 1.02;
// It shrinks by this factor after a cache that had no room.
constexpr double kNarrower = 0.5;
// The longest pause after a cache that had no room, ticks. The pause doubles each time until then,
// so that hopeless attempts become rare.
constexpr std::uint32_t kLongestPause = 255;

// The next clearance is this many times the last one that was found.
constexpr double kClearer = 2;
// It is this part of the last one if that was not found.
constexpr double kLessClear = 0.25;
// A clearance is at most this part of a known distance: beyond it there would be pairs.
constexpr double kClearPart = 0.8;
// The search for a clearance may make this many times the tests of the last whole search.
constexpr std::uint64_t kClearTests = 2;
// It may make so many tests more, for bodies so far apart that the last search made hardly any.
constexpr std::uint64_t kSpareTests = 10'000;

}  // namespace

CacheSchedule::CacheSchedule(double voxel_size, bool helped) noexcept
    : voxel_size_(voxel_size),
      fewest_ticks_(helped ? kFewestTicksHelped : kFewestTicks),
      widest_(kMostSlack * voxel_size),
      clearance_(kMostSlack * voxel_size) {}

void CacheSchedule::forget() noexcept {
  widest_ = clearance_ = kMostSlack * voxel_size_;
  pause_ = wait_ = 0;
}

double CacheSchedule::slack(const Pace& pace) const noexcept {
  const double wanted = std::max(kTicksOfSlack * pace.drift, kTicksOfTrembling * pace.speed);
  return std::min(std::clamp(wanted, kLeastSlack * voxel_size_, kMostSlack * voxel_size_), widest_);
}

double CacheSchedule::slack_at_once() const noexcept {
  return std::min(kSlackAtOnce * voxel_size_, widest_);
}

double CacheSchedule::clearance(double known, double need) const noexcept {
  return std::min(clearance_, kClearPart * known - need);
}

bool CacheSchedule::is_wasteful(double slack, double wanted, std::size_t pairs,
                                std::uint64_t overlapping) noexcept {
  return slack > kTooWide * wanted && overlapping > 0 &&
         static_cast<double>(pairs) > kTooMany * static_cast<double>(overlapping);
}

double CacheSchedule::ticks_to_centre(double slack, const Pace& pace) noexcept {
  return pace.is_directed() ? std::min(slack / pace.drift, kTicksOfSlack) : 0;
}

double CacheSchedule::ticks_ahead(double slack, const Pace& pace) noexcept {
  if (!pace.is_directed()) return 0;
  return pace.is_steady() ? std::max(kTicksAhead, kPartAhead * ticks_to_centre(slack, pace))
                          : kTicksAhead;
}

double CacheSchedule::reserve(double slack, const Pace& pace) noexcept {
  return pace.is_directed() ? 0 : kReserve * slack;
}

std::uint64_t CacheSchedule::slice(std::uint64_t whole, bool searched) noexcept {
  const double part = searched ? kPartOfSearch : 1 / (kPartOfTicks * kTicksAhead);
  return static_cast<std::uint64_t>(std::max(kLeastSlice, part * static_cast<double>(whole)));
}

std::uint64_t CacheSchedule::most_for_clearance(std::uint64_t whole) noexcept {
  return kClearTests * whole + kSpareTests;
}

void CacheSchedule::searched() noexcept { ask_for(kWiderFresh); }

void CacheSchedule::took_up(bool empty, double clear) noexcept {
  ask_for(kWider);
  pause_ = 0;
  if (empty) clearance_ = kClearer * clear;
}

void CacheSchedule::was_full(bool clearance) noexcept {
  if (clearance) {
    clearance_ *= kLessClear;
  } else {
    ask_for(kNarrower);
  }
  wait_ = pause_ = std::min(2 * pause_ + 1, kLongestPause);
}

void CacheSchedule::ask_for(double factor) noexcept {
  widest_ = std::min(factor * widest_, kMostSlack * voxel_size_);
}

}  // namespace ist
