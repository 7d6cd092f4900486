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
// A list is filled in so many ticks, if the last list lasts as long.
constexpr double kFewestSlices = 2, kMostSlices = 32;
// The fewest tests of a slice, 8 µs.
constexpr std::uint64_t kLeastSlice = 2'000;
// A list of fewer pairs could be wider, and one of more should be narrower.
constexpr std::uint64_t kFewPairs = 300, kManyPairs = 1'200;
// The least slack of a wide list, in margins: a body that slips has some ticks until it is used up.
constexpr double kLeastMargins = 3;
// The most slack of a list that is filled at once, and of one that is filled in slices: in margins,
// or in ticks of the speed.
constexpr double kMarginsAtOnce = 1.5, kTicksAtOnce = 3, kMostMargins = 3, kMostTicks = 6;
// A body that goes farther in a tick, in margins, gets no list: it would cost more than it saves.
constexpr double kFastest = 1.2;
// The part of a list's life in which the next one is filled.
constexpr double kFilling = 1 / 1.3;
// The part of its slack by which the centre of a list that is filled in slices lies ahead of the
// pose at which it is ready.
constexpr double kFarAhead = 0.7;
constexpr double kNarrowest = 0.3, kWidest = 16;
// The part of its slack by which the centre of a list that is filled at once lies ahead.
constexpr double kAhead = 0.5;
// A body is slow if it moves by less than so many slacks while a list is filled. Its list then has
// at least this part of the slack left.
constexpr double kSlow = 0.25, kCentred = 0.5;
// Beyond this a float does not hold a reach.
constexpr double kLargestReach = 0x1p100;
// Blocks between two looks at the clock.
constexpr std::size_t kUnwatchedBlocks = 256;
// Ticks without a list after one that had no room.
constexpr std::uint64_t kPause = 64;
// The tests that take as long as a pair that a list takes.
constexpr std::uint64_t kPairTests = 20;

void copy_lane(const TriangleOctet& from, std::size_t lane, TriangleOctet& to,
               std::size_t at) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      to.fixed[k][i][at] = from.fixed[k][i][lane];
      to.moving[k][i][at] = from.moving[k][i][lane];
    }
  }
}

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
  List& list = kept();
  // The distance of a pair is less than at the centre by no more than this.
  const double nearer = motion_ + 4 * error_;
  const double far = decision.enough() + 4 * error_;
  // The pairs that no bound leaves out.
  TriangleOctet corners{};
  TriangleIds ids[TriangleOctet::kSize];
  struct Place {
    Block* block;
    std::size_t lane;
  };
  Place places[TriangleOctet::kSize];
  std::size_t count = 0;
  std::uint32_t apart = 0;
  const auto measure = [&] {
    if (decision.context().budget.is_past()) return false;
    decision.take(corners, {ids, count}, apart, [&](std::size_t at, const auto& closest) {
      set_plane(*places[at].block, places[at].lane, closest());
    });
    measured += std::exchange(count, 0);
    apart = 0;
    return true;
  };
  for (std::size_t k = 0; k < list.used; ++k) {
    Block& block = list.blocks[k];
    if (k % kUnwatchedBlocks == 0 && decision.context().budget.is_past()) return false;
    if (block.least - nearer > decision.enough()) continue;
    const std::uint32_t left_out = parted(block, decision.move(), far);
    for (std::size_t lane = 0; lane < block.count; ++lane) {
      if ((left_out >> lane & 1U) != 0) continue;
      if (block.distance[lane] > nearer) apart |= std::uint32_t{1} << count;
      copy_lane(block.corners, lane, corners, count);
      ids[count] = block.ids[lane];
      places[count] = {&block, lane};
      if (++count == TriangleOctet::kSize && !measure()) return false;
    }
  }
  return count == 0 || measure();
}

std::uint32_t NearCache::parted(const Block& block, const PlainMove& move, double least) noexcept {
  const auto& r = move.rotation;
  const auto& t = move.translation;
  double room[TriangleOctet::kSize];
  for (std::size_t lane = 0; lane < TriangleOctet::kSize; ++lane) {
    const double x = block.normal[0][lane], y = block.normal[1][lane], z = block.normal[2][lane];
    // The normal in moving coordinates.
    const double u = (r[0][0] * x + r[1][0] * y) + r[2][0] * z;
    const double v = (r[0][1] * x + r[1][1] * y) + r[2][1] * z;
    const double w = (r[0][2] * x + r[1][2] * y) + r[2][2] * z;
    double bottom = HUGE_VAL;
    for (const auto& corner : block.corners.moving) {
      const double height = (u * corner[0][lane] + v * corner[1][lane]) + w * corner[2][lane];
      bottom = height < bottom ? height : bottom;
    }
    room[lane] = (bottom + ((x * t[0] + y * t[1]) + z * t[2])) - block.top[lane];
  }
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < TriangleOctet::kSize; ++lane) {
    bits |= std::uint32_t{room[lane] > least} << lane;
  }
  return bits;
}

void NearCache::set_plane(Block& block, std::size_t lane, const NearPair& closest) noexcept {
  const Eigen::Vector3d way = difference(closest.moving_point, closest.fixed_point);
  const double length = length_in_order(way);
  if (!(length > 0)) return;
  const Eigen::Vector3d normal = scaled(1 / length, way);
  double top = -HUGE_VAL;
  for (const auto& corner : block.corners.fixed) {
    const Eigen::Vector3d at(corner[0][lane], corner[1][lane], corner[2][lane]);
    top = std::max(top, dot_in_order(normal, at));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    block.normal[i][lane] = normal[static_cast<Eigen::Index>(i)];
  }
  block.top[lane] = top;
}

// Returns a slack of at most so many margins, or ticks of the speed.
double NearCache::slack_of(const Need& need, double margins, double ticks) const noexcept {
  const double wanted = width_ * std::max(kWantedTicks / 2 * speed_, kLeastMargins * need.enough);
  return std::min(wanted, std::max(margins * need.enough, ticks * speed_));
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
  const double slack = slack_of(need, kMarginsAtOnce, kTicksAtOnce);
  const bool lasts = (1 + kAhead) * slack >= kFewestAtOnce * speed_;
  if (speed_ > kFastest * need.enough || pause_ > 0 || !lasts ||
      !(need.enough + slack < kLargestReach))
    return false;
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
  const double slack = slack_of(need, kMostMargins, kMostTicks);
  if (!(need.enough + slack < kLargestReach)) return false;
  const double ticks = speed_ > 0 ? 2 * slack / speed_ : HUGE_VAL;
  const bool holds_now = kept().state == State::kKept;
  const double spare = holds_now ? kept().reach - need.enough - way(kept().centre, poses_[0]) : 0;
  const double left = !holds_now ? kFewestSlices : speed_ > 0 ? spare / speed_ - 1 : HUGE_VAL;
  const double slices = std::clamp(std::min(kFilling * ticks, left), kFewestSlices, kMostSlices);
  if (next().state != State::kEmpty) {
    // It is dropped if the body does not come to it.
    const double until = next().state == State::kReady ? 2 : slices;
    if (holds(next(), ahead(until), need) || holds(next(), poses_[0], need)) return false;
    next().state = State::kEmpty;
  }
  // A body that is slow gets a list round it, since it may become fast at once.
  const bool is_aside = kMostSlices * speed_ < kSlow * slack && spare < kCentred * slack;
  const bool lasts =
      !is_aside && holds_now && holds(kept(), ahead(slices + 2), need, slices * (speed_ - drift_));
  if (lasts || speed_ > kFastest * need.enough || pause_ > 0 || ticks < kFewestTicks ||
      ticks_ < 3) {
    return false;
  }
  begin(need, slack,
        slices + (drift_ > 0 ? std::min(kFarAhead * slack / drift_, kWantedTicks) : 0));
  slice_ =
      std::max(kLeastSlice, static_cast<std::uint64_t>(static_cast<double>(list_tests_) / slices));
  return true;
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
    Block& begun = list.blocks[open - 1];
    begun.count = 0;
    begun.least = distance;
    std::fill_n(&begun.normal[0][0], 3 * TriangleOctet::kSize, 0.0);
    std::fill_n(begun.top, TriangleOctet::kSize, 0.0);
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
