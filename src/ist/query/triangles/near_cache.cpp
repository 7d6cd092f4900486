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

// A list is worth its search if it answers in so many ticks: filled in slices, or at once.
constexpr double kFewestTicks = 4, kFewestAtOnce = 3;
// A list that answers in so many ticks is wide enough.
constexpr double kWantedTicks = 14;
// A list is filled in this part of the ticks in which it answers, if the last list lasts as long.
constexpr double kFilledIn = 0.6, kFewestSlices = 2, kMostSlices = 32;
// The fewest tests of a slice, 8 µs.
constexpr std::uint64_t kLeastSlice = 2'000;
// A list of fewer pairs could be wider, and one of more should be narrower.
constexpr std::uint64_t kFewPairs = 96, kManyPairs = 640;
// The most slack, in margins: a wider list costs more than it saves.
constexpr double kMostMargins = 1.5;
constexpr double kNarrowest = 0.3, kWidest = 16;
// The part of its slack by which the centre of a list that is filled at once lies ahead.
constexpr double kAhead = 0.5;
// Beyond this a float does not hold a reach.
constexpr double kLargestReach = 0x1p100;
// Blocks between two looks at the clock.
constexpr std::size_t kUnwatchedBlocks = 256;
// Ticks without a list after one that had no room.
constexpr std::uint64_t kPause = 64;
// The tests that take as long as a pair of the list.
constexpr std::uint64_t kPairTests = 48;

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

  const bool stays = kept().state == State::kKept && holds(kept(), pose, need);
  if (next().state == State::kReady && holds(next(), pose, need) &&
      (!stays || way(next().centre, pose) < way(kept().centre, pose))) {
    use_next(need);
    return true;
  }
  if (!stays) {
    kept().state = State::kEmpty;
    return false;
  }
  motion_ = way(kept().centre, pose);
  error_ = need.error;
  return true;
}

bool NearCache::answer(NearDecision& decision, std::uint64_t& measured) noexcept {
  const List& list = kept();
  // The distance of a pair is less than at the centre by no more than this.
  const double nearer = motion_ + 4 * error_;
  for (std::size_t k = 0; k < list.used; ++k) {
    const Block& block = list.blocks[k];
    const bool far = block.least - nearer > decision.enough();
    if ((!far || k % kUnwatchedBlocks == 0) && decision.context().budget.is_past()) return false;
    if (far) continue;
    std::uint32_t apart = 0;
    for (std::size_t lane = 0; lane < block.count; ++lane) {
      if (block.distance[lane] > nearer) apart |= std::uint32_t{1} << lane;
    }
    decision.take(block.corners, {block.ids, block.count}, apart);
    measured += block.count;
  }
  return true;
}

double NearCache::slack_of(const Need& need) const noexcept {
  const double wanted = width_ * std::max(kWantedTicks / 2 * speed_, need.enough / 8);
  return std::min(wanted, kMostMargins * need.enough);
}

// Begins a list whose centre lies so many ticks ahead.
void NearCache::begin(const Need& need, double slack, double ticks) noexcept {
  List& list = next();
  list.state = State::kFilling;
  list.used = 0;
  list.pairs = 0;
  list.open = {};
  list.enough = need.enough;
  list.reach = need.enough + slack + 4 * need.error;
  list.centre = ahead(ticks);
}

// Begins a list that is filled at once. Returns whether it is worth its search.
bool NearCache::begin_here(const Need& need) noexcept {
  const double slack = slack_of(need);
  const bool lasts = (1 + kAhead) * slack >= kFewestAtOnce * speed_;
  if (pause_ > 0 || !lasts || !(need.enough + slack < kLargestReach)) return false;
  begin(need, slack, drift_ > 0 ? std::min(kAhead * slack / drift_, kWantedTicks) : 0);
  if (!holds(next(), poses_[0], need)) next().centre = poses_[0];
  return true;
}

// Takes the next list into use.
void NearCache::use_next(const Need& need) noexcept {
  kept().state = State::kEmpty;
  kept_ = 1 - kept_;
  kept().state = State::kKept;
  motion_ = way(kept().centre, poses_[0]);
  error_ = need.error;
}

// Begins the next list if it is time for it, and if the list is worth it. Returns whether it did.
bool NearCache::want(const Need& need, std::uint64_t tests) noexcept {
  if (tests > 0 && list_tests_ == 0) list_tests_ = 2 * tests;
  pause_ -= pause_ > 0 ? 1 : 0;
  const double slack = slack_of(need);
  if (!(need.enough + slack < kLargestReach)) return false;
  const double ticks = speed_ > 0 ? 2 * slack / speed_ : HUGE_VAL;
  if (next().state != State::kEmpty) {
    // It is dropped if the body does not come to it.
    const double until = next().state == State::kReady ? 2 : slices_;
    if (holds(next(), ahead(until), need) || holds(next(), poses_[0], need)) return false;
    next().state = State::kEmpty;
  }
  if (pause_ > 0 || ticks < kFewestTicks || ticks_ < 3) return false;
  const double most = std::floor(std::clamp(kFilledIn * ticks, kFewestSlices, kMostSlices));
  const double left = ticks_left(need, most + 2);
  if (left >= most + 2) return false;
  slices_ = std::clamp(left - 1, kFewestSlices, most);
  begin(need, slack, slices_ + (drift_ > 0 ? std::min(0.8 * slack / drift_, kWantedTicks) : 0));
  slice_ = std::max(kLeastSlice,
                    static_cast<std::uint64_t>(1.25 * static_cast<double>(list_tests_) / slices_));
  return true;
}

// Returns in how many ticks, a whole number up to `most`, the kept list still holds all near pairs
// if the body goes on as before.
double NearCache::ticks_left(const Need& need, double most) const noexcept {
  const auto lasts = [&](double ticks) {
    return holds(lists_[kept_], ahead(ticks), need, ticks * (speed_ - drift_));
  };
  if (lists_[kept_].state != State::kKept) return 0;
  if (lasts(most)) return most;
  double least = 0;
  while (most - least > 1) {
    const double middle = std::floor(0.5 * (least + most));
    (lasts(middle) ? least : most) = middle;
  }
  return least;
}

void NearCache::advance(std::uint64_t most, const Budget& budget, FoundMemory& memory) noexcept {
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
  const auto work = [&] { return walk_.tests() + kPairTests * list.pairs; };
  const std::uint64_t begin = work();
  while (!walk_.is_whole() && work() - begin < most && !budget.is_past()) {
    if (!walk_.advance(visit)) return;
  }
  if (!walk_.is_whole()) return;
  list.state = State::kReady;
  list_tests_ = work();
  set_width();
}

void NearCache::set_width() noexcept {
  const std::uint64_t pairs = next().pairs;
  if (pairs < kFewPairs) width_ = std::min(width_ * 1.5, kWidest);
  if (pairs > kManyPairs) width_ = std::max(width_ / 1.5, kNarrowest);
}

// Adds the pairs that were found, each with a lower bound of its distance. Returns whether there
// was room.
bool NearCache::take(FoundTriangles& found) noexcept {
  const std::size_t count = std::exchange(found.open.count, 0);
  for (std::size_t k = 0; k < count; ++k) {
    if (add(found.open[k], std::sqrt(double{found.squares[k]}))) continue;
    next().state = State::kEmpty;
    pause_ = kPause;
    width_ = 1;
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
  list_tests_ = pause_ = 0;
}

}  // namespace ist
