#include "ist/query/triangles/near_cache.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ist/base/ordered_vector.h"
#include "ist/base/pose.h"
#include "ist/mesh/bounding_box.h"

namespace ist {
namespace {

// A list is worth its search if it answers in so many ticks.
constexpr double kFewestTicks = 6;
// A list that answers in so many ticks is wide enough.
constexpr double kWantedTicks = 14;
// A list is filled in so many ticks, if the last list lasts as long.
constexpr double kFewestSlices = 5, kMostSlices = 32;
// The fewest tests of a slice, 6 µs.
constexpr double kLeastSlice = 2'000;
// With its slice a tick costs at most so many times a fresh search: if a list answers, and if none
// does.
constexpr double kMostByList = 1.1, kMostBySearch = 1.15;
// A list of fewer pairs could be wider, and one of more should be narrower.
constexpr std::uint64_t kFewPairs = 96, kManyPairs = 256;
constexpr double kNarrowest = kFewestTicks / kWantedTicks, kWidest = 16;
// Beyond this a float does not hold a reach.
constexpr double kLargestReach = 0x1p100;
// Blocks between two looks at the clock.
constexpr std::size_t kUnwatchedBlocks = 256;
// Ticks without a list after one that had no room, or after a chain of lists that cost more than it
// saved. Each further such chain makes the pause four times as long. It ends early for a list whose
// slack is less by this factor.
constexpr std::uint64_t kPause = 64, kLongestPause = 4096;
constexpr double kLessSlack = 1.5;
// The tests that take as long as to measure a pair of a list again.
constexpr std::uint64_t kMeasuredTests = 24;

}  // namespace

NearCache::NearCache(const TriangleMesh& fixed, const TriangleMesh& moving,
                     const TriangleClusters& fixed_clusters,
                     const TriangleClusters& moving_clusters, const ClusterKernels& kernels,
                     std::size_t pairs)
    : fixed_(fixed),
      moving_(moving),
      kernels_(kernels),
      box_(bounding_box(moving)),
      walk_(fixed_clusters, moving_clusters, kernels) {
  for (List& list : lists_) list.blocks.resize(pairs / TriangleOctet::kSize + kClasses);
}

std::size_t NearCache::bytes_for(const TriangleClusters& fixed, const TriangleClusters& moving,
                                 std::size_t pairs) noexcept {
  return 2 * (pairs / TriangleOctet::kSize + kClasses) * sizeof(Block) +
         ClusterWalk::bytes_for(fixed, moving);
}

bool NearCache::holds(const List& list, const RelativePose& pose, const Need& need,
                      double spare) const noexcept {
  return need.enough + way(list.centre, pose) + spare + 4 * need.error <= list.reach;
}

RelativePose NearCache::ahead(double ticks) const noexcept {
  const RelativePose& pose = poses_[0];
  const std::size_t first = std::min(ticks_, kTicks) - 1;
  if (first == 0 || 2 * drift_ < speed_) return pose;  // it stands, or trembles
  const RelativePose& before = poses_[first];
  const double part = ticks / static_cast<double>(first);
  Eigen::AngleAxisd turn(Eigen::Matrix3d(pose.rotation * before.rotation.transpose()));
  turn.angle() *= part;
  const Eigen::Vector3d step = difference(pose.translation, before.translation);
  const RelativePose there{turn.toRotationMatrix() * pose.rotation,
                           sum(pose.translation, scaled(part, step))};
  const std::optional<Eigen::Isometry3d> made = project_to_rigid(to_isometry(there));
  return made ? RelativePose{made->linear(), made->translation()} : pose;
}

bool NearCache::find(const Need& need) noexcept {
  std::shift_right(poses_.begin(), poses_.end(), 1);
  const RelativePose pose{need.pose.linear(), need.pose.translation()};
  poses_[0] = pose;
  ticks_ = std::min(ticks_ + 1, kTicks + 1);
  const std::size_t back = std::min(ticks_, kTicks) - 1;
  speed_ = 0;
  for (std::size_t k = 0; k < back; ++k) speed_ = std::max(speed_, way(poses_[k], poses_[k + 1]));
  drift_ = back > 0 ? way(poses_[0], poses_[back]) / static_cast<double>(back) : 0;

  const bool has = kept().state == State::kKept, stays = has && holds(kept(), pose, need);
  if (next().state == State::kReady && holds(next(), pose, need) &&
      (!stays || way(next().centre, pose) < way(kept().centre, pose))) {
    kept().state = State::kEmpty;
    kept_ = 1 - kept_;
    kept().state = State::kKept;
    if (has && saved_ < -static_cast<double>(list_tests_)) end_chain();
  } else if (!stays) {
    kept().state = State::kEmpty;
    if (has && next().state == State::kEmpty) end_chain();
  }
  if (kept().state == State::kEmpty) return false;
  motion_ = way(kept().centre, pose);
  error_ = need.error;
  spent_ = kMeasuredTests * within(need.enough);
  return static_cast<double>(spent_) <= kMostByList * static_cast<double>(fresh_);
}

std::uint64_t NearCache::within(double enough) noexcept {
  const List& list = kept();
  std::uint64_t pairs = 0;
  for (std::size_t k = 0; k < list.used; ++k) {
    const Block& block = list.blocks[k];
    if (!is_far(block, enough)) pairs += block.count;
  }
  return pairs;
}

bool NearCache::answer(NearDecision& decision, std::uint64_t& measured) noexcept {
  const List& list = kept();
  for (std::size_t k = 0; k < list.used; ++k) {
    const Block& block = list.blocks[k];
    const bool far = is_far(block, decision.enough());
    if ((!far || k % kUnwatchedBlocks == 0) && decision.context().budget.is_past()) return false;
    if (far) continue;
    std::uint32_t apart = 0;
    for (std::size_t lane = 0; lane < block.count; ++lane) {
      if (block.distance[lane] > nearer()) apart |= std::uint32_t{1} << lane;
    }
    decision.take(block.corners, {block.ids, block.count}, apart);
    measured += block.count;
  }
  return true;
}

// Ends a chain of lists, each of which was ready in time.
void NearCache::end_chain() noexcept {
  const bool paid = std::exchange(saved_, 0) > 0;
  for (List& list : lists_) list.state = State::kEmpty;
  pause_ = paid ? 0 : std::clamp(4 * last_pause_, kPause, kLongestPause);
  last_pause_ = pause_;
}

// Notes what this tick cost without its slice.
void NearCache::note(const std::optional<std::uint64_t>& tests) noexcept {
  if (tests) {
    spent_ = fresh_ = *tests;
    if (list_tests_ == 0) list_tests_ = fresh_ + fresh_ / 4;
  } else {
    saved_ += static_cast<double>(fresh_) - static_cast<double>(spent_);
  }
  pause_ -= pause_ > 0 ? 1 : 0;
}

// Begins the next list if it is time for it, and if the list is worth it. Returns whether it did.
bool NearCache::want(const Need& need) noexcept {
  const double slack = width_ * std::max(kWantedTicks / 2 * speed_, need.enough / 8);
  if (!(need.enough + slack < kLargestReach)) return false;
  const double ticks = speed_ > 0 ? 2 * slack / speed_ : HUGE_VAL;
  const bool holds_now = kept().state == State::kKept;
  const double spare = holds_now ? kept().reach - need.enough - way(kept().centre, poses_[0]) : 0;
  const double left = !holds_now ? kFewestSlices : speed_ > 0 ? spare / speed_ - 1 : HUGE_VAL;
  const double work = 1.25 * static_cast<double>(list_tests_);
  const double fewest =
      holds_now ? kFewestSlices : std::clamp(work / allowed(), kFewestSlices, kMostSlices);
  const double slices = std::clamp(std::min(ticks / 3, left), fewest, kMostSlices);
  if (next().state != State::kEmpty) {
    // It is dropped if the body does not come to it.
    until_ = std::max(until_ - 1, 2.0);
    if (holds(next(), ahead(until_), need) || holds(next(), poses_[0], need)) return false;
    next().state = State::kEmpty;
    if (!holds_now) end_chain();
  }
  const bool lasts =
      holds_now && holds(kept(), ahead(slices + 2), need, slices * (speed_ - drift_));
  const bool pauses = pause_ > 0 && kLessSlack * slack > slack_;
  if (lasts || pauses || ticks < kFewestTicks || ticks_ < 3) return false;
  List& list = next();
  list.state = State::kFilling;
  list.used = 0;
  list.pairs = 0;
  list.open = {};
  list.enough = need.enough;
  list.reach = need.enough + slack + 4 * need.error;
  list.centre = ahead(slices + (drift_ > 0 ? std::min(0.8 * slack / drift_, kWantedTicks) : 0));
  slice_ = std::max(kLeastSlice, work / slices);
  until_ = slices;
  slack_ = slack;
  return true;
}

// Returns the work of the slices so far, as tests.
std::uint64_t NearCache::done() const noexcept {
  return walk_.tests() + kPairTests * lists_[1 - kept_].pairs;
}

// Returns the tests of a slice that keep this tick about as cheap as a fresh search.
double NearCache::allowed() const noexcept {
  const bool holds_now = lists_[kept_].state == State::kKept;
  const double most = (holds_now ? kMostByList : kMostBySearch) * static_cast<double>(fresh_);
  return std::max(kLeastSlice, most - static_cast<double>(std::min(spent_, fresh_)));
}

void NearCache::advance(const Budget& budget, FoundMemory& memory) noexcept {
  List& list = next();
  if (list.state != State::kFilling) return;
  memory.clear();
  FoundTriangles& found = memory.found;
  Reach reach{rounded_up(list.reach), std::numeric_limits<float>::infinity()};
  const auto visit = [&](const ClusterPairs& clusters) {
    return in_turns(
        clusters,
        [&](const ClusterPairs& rest) {
          return kernels_.near_clusters(walk_.step(), rest, reach, memory.batch, found);
        },
        [&] { return take(found); });
  };
  const std::uint64_t begin = done();
  const std::uint64_t end = begin + static_cast<std::uint64_t>(std::min(slice_, allowed()));
  while (!walk_.is_whole() && done() < end && !budget.is_past()) {
    if (!walk_.advance(visit)) return;
  }
  saved_ -= static_cast<double>(done() - begin);
  if (!walk_.is_whole()) return;
  list.state = State::kReady;
  list_tests_ = done();
  fresh_ = std::min(fresh_, list_tests_);  // which has a smaller reach
  set_width();
}

// A list of so many pairs that they cost more than a search may last less than kWantedTicks.
void NearCache::set_width() noexcept {
  const std::uint64_t pairs = next().pairs, tests = kMeasuredTests * pairs;
  if (pairs < kFewPairs) {
    width_ = std::min(width_ * 1.5, kWidest);
  } else if (tests > fresh_) {
    width_ = std::max(width_ / 1.5, kNarrowest);
  } else if (pairs > kManyPairs && width_ > 1) {
    width_ = std::max(width_ / 1.5, 1.0);
  } else if (3 * tests < fresh_ && width_ < 1) {
    width_ = std::min(width_ * 1.5, 1.0);
  }
}

// Adds the pairs that were found, each with a lower bound of its distance. Returns whether there
// was room.
bool NearCache::take(FoundTriangles& found) noexcept {
  const std::size_t count = std::exchange(found.open.count, 0);
  for (std::size_t k = 0; k < count; ++k) {
    if (add(found.open[k], std::sqrt(double{found.squares[k]}))) continue;
    next().state = State::kEmpty;
    pause_ = kPause;
    width_ = std::max(width_ / 2, kNarrowest);
    return false;
  }
  return true;
}

// Returns whether there is room.
bool NearCache::add(TriangleIds ids, double distance) noexcept {
  List& list = next();
  const double part =
      (distance - list.enough) / (list.reach - list.enough) * static_cast<double>(kClasses);
  const std::size_t of_class = !(part > 0)       ? 0
                               : part < kClasses ? static_cast<std::size_t>(part)
                                                 : kClasses - 1;
  std::size_t& open = list.open[of_class];
  if (open == 0) {
    if (list.used == list.blocks.size()) return false;
    open = ++list.used;
    list.blocks[open - 1].count = 0;
    list.blocks[open - 1].least = distance;
  }
  Block& block = list.blocks[open - 1];
  // The lanes behind the last one hold any numbers: they are computed, and not read.
  const std::size_t lane = block.count++;
  set_lane(block.corners.fixed, lane, fixed_, ids.fixed);
  set_lane(block.corners.moving, lane, moving_, ids.moving);
  block.ids[lane] = ids;
  block.distance[lane] = distance;
  block.least = std::min(block.least, distance);
  if (block.count == TriangleOctet::kSize) open = 0;
  ++list.pairs;
  return true;
}

void NearCache::forget() noexcept {
  for (List& list : lists_) list.state = State::kEmpty;
  ticks_ = 0;
  width_ = 1;
  list_tests_ = fresh_ = spent_ = 0;
  pause_ = last_pause_ = 0;
  saved_ = 0;
}

}  // namespace ist
